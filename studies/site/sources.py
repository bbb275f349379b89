"""Beside the documents: the tree of chapters, and pages of what documents link to that is no document."""

import html
import os
import shutil
from pathlib import Path, PurePosixPath

from docutils import nodes
from sphinx.addnodes import download_reference

languages = {".toml": "toml", ".sh": "bash", ".cpp": "cpp", ".py": "python", "": "text"}
of_folders = {".toml", ".sh"}  # shown in full on the page of their folder; other files are named there
of_downloads = {".csv"}  # lie beside that page


def with_chapters(app, name, source):
    """A table of contents at the end of the front page, in the side bar only."""
    if name != app.config.root_doc:
        return
    trees = [
        "```{toctree}\n:hidden:\n:caption: " + caption + "\n\n" + "\n".join(documents) + "\n```\n"
        for caption, documents in app.config.chapters.items()
    ]
    source[0] += "\n" + "\n".join(trees)


def path_in_repository(app, document, target):
    """The linked path from the root, or None where it leads out of the repository or nowhere."""
    folder = PurePosixPath(document).parent
    path = PurePosixPath(os.path.normpath(folder / target))
    return None if path.parts[:1] == ("..",) or not (Path(app.srcdir) / path).exists() else path


def page_of(path):
    """Of a folder, the page of its files; of a file, the page of its own."""
    return f"files/{path}"


def own_pages(app):
    if not hasattr(app.env, "pages_of_files"):
        app.env.pages_of_files = {}
    return app.env.pages_of_files


def to_page(app, env, node, contnode):
    """A link to a folder: to its README where it has one, else to a page of its files."""
    path = path_in_repository(app, node.get("refdoc", env.docname), node["reftarget"])
    if path is None or not (Path(app.srcdir) / path).is_dir():
        return None
    readme = str(path / "README")
    page = readme if readme in env.found_docs else page_of(path)
    if page != readme:
        own_pages(app).setdefault(node["refdoc"], set()).add(str(path))
    address = app.builder.get_relative_uri(node["refdoc"], page)
    return nodes.reference("", "", contnode, refuri=address, internal=True)


def to_pages_of_files(app, doctree, document):
    """A link to a study or a source file: to a page that shows it, in place of a download."""
    for node in list(doctree.findall(download_reference)):
        path = path_in_repository(app, document, node["reftarget"])
        if path is None or path.suffix not in languages:
            continue
        own_pages(app).setdefault(document, set()).add(str(path))
        address = app.builder.get_relative_uri(document, page_of(path))
        node.replace_self(nodes.reference("", "", *node.children, refuri=address, internal=True))
    add_studies_beside(app, doctree, document)


def add_studies_beside(app, doctree, document):
    """At the end of a folder's README a link to the page of its studies, if it has any."""
    folder = PurePosixPath(document).parent
    if not document.endswith("/README") or not any((Path(app.srcdir) / folder).glob("*.toml")):
        return
    own_pages(app).setdefault(document, set()).add(str(folder))
    address = app.builder.get_relative_uri(document, page_of(folder))
    link = nodes.reference("", "The studies of this folder, in full", refuri=address, internal=True)
    doctree.append(nodes.paragraph("", "", link))


def text_of(app, path):
    block = app.builder.highlighter.highlight_block(path.read_text(), languages[path.suffix])
    return f'<section id="{path.name}"><h2>{html.escape(path.name)}</h2>\n{block}</section>'


def listed(app, path):
    """A file in the list of its folder's page: shown there, or to be downloaded beside it."""
    name = html.escape(path.name)
    if path.suffix in of_folders:
        return f'<li><a href="#{name}">{name}</a></li>'
    if path.suffix not in of_downloads:
        return f"<li>{name}</li>"
    folder = Path(app.outdir) / page_of(path.parent.relative_to(app.srcdir))
    folder.mkdir(parents=True, exist_ok=True)
    shutil.copyfile(path, folder / path.name)
    return f'<li><a href="{html.escape(folder.name)}/{name}">{name}</a></li>'


def body_of(app, path):
    if path.is_file():
        return text_of(app, path)
    files = sorted(each for each in path.iterdir() if each.is_file())
    texts = [text_of(app, each) for each in files if each.suffix in of_folders]
    return "\n".join(["<ul>", *(listed(app, each) for each in files), "</ul>", *texts])


def pages(app):
    for name in sorted(set().union(*own_pages(app).values())):
        body = f"<h1>{html.escape(name)}</h1>\n" + body_of(app, Path(app.srcdir) / name)
        yield page_of(PurePosixPath(name)), {"title": name, "body": body}, "page.html"


def index(app, exception):
    """The front page under the name that a server looks for."""
    if exception is None and app.builder.name == "html":
        front = Path(app.outdir) / f"{app.config.root_doc}.html"
        shutil.copyfile(front, front.with_name("index.html"))


def forget(app, env, document):
    own_pages(app).pop(document, None)


def setup(app):
    app.add_config_value("chapters", {}, "env")
    app.connect("source-read", with_chapters)
    app.connect("missing-reference", to_page)
    app.connect("doctree-resolved", to_pages_of_files)
    app.connect("env-purge-doc", forget)
    app.connect("html-collect-pages", pages)
    app.connect("build-finished", index)
    return {"parallel_read_safe": False, "parallel_write_safe": False}
