"""The site of the documents: made without a warning, and every link in it leads somewhere, without a network.

site.py FOLDER SPHINX-COMMAND...
"""

import subprocess
import sys
import tempfile
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    def __init__(self, path):
        super().__init__()
        self.ids, self.links, self.loads, self.math = set(), [], [], 0
        self.feed(path.read_text())

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        if given.get("id"):
            self.ids.add(given["id"])
        if tag == "a" and given.get("href"):
            self.links.append(given["href"])
        if tag in ("script", "img") and given.get("src"):
            self.loads.append(given["src"])
        if tag == "link" and given.get("rel") in ("stylesheet", "icon") and given.get("href"):
            self.loads.append(given["href"])
        self.math += tag == "math"


def parts_of(link):
    address = urlsplit(link)
    return address.scheme, unquote(address.path), unquote(address.fragment)


with tempfile.TemporaryDirectory() as folder:
    made = subprocess.run([*sys.argv[1:], folder], capture_output=True, text=True, timeout=240)
    assert made.returncode == 0, made.stdout + made.stderr
    site = Path(folder).resolve()
    pages = {path.resolve(): Page(path) for path in site.rglob("*.html")}
    assert len(pages) > 25, len(pages)

    broken, followed = [], 0
    for path, page in pages.items():
        for link in page.links:
            scheme, target, fragment = parts_of(link)
            if scheme:  # of another host: cannot be tried here
                continue
            followed += 1
            goal = (path.parent / target).resolve() if target else path
            lost = not goal.is_file() or (fragment and goal in pages and fragment not in pages[goal].ids)
            if lost and link != "#":
                broken.append((str(path.relative_to(site)), link))
        for link in page.loads:
            scheme, target, _ = parts_of(link)
            if scheme != "data" and (scheme or not (path.parent / target).is_file()):
                broken.append((str(path.relative_to(site)), link))
    assert not broken, broken
    assert followed > 1000, followed

    front = (site / "index.html").read_text()
    for chapter in ("studies/README.html", "solvers/README.html", "studies/glossary.html"):
        assert chapter in front, chapter
    assert pages[site / "solvers/README.html"].math > 3  # its formulas are drawn
    assert "<h2>den_hartog.toml</h2>" in (site / "files/studies/classics.html").read_text()  # a study can be read there
