"""The documents of all rooms as one site: the very Markdown files of the repository, in place.

    cmake --build --preset release --target site        # build/release/site/index.html

Sphinx reads the repository's root. What a link leads to beside documents (a study, a folder of studies, a script) gets a
page of its own here, so that the site alone is enough. It needs no network and no server.
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

project = "Frahm"
copyright = "the authors of Frahm"
root_doc = "README"
extensions = ["myst_parser", "formulas", "sources"]
myst_enable_extensions = ["dollarmath"]
myst_heading_anchors = 3  # headings are linked as GitHub links them
source_suffix = {".md": "markdown"}
exclude_patterns = ["build*", ".git", ".ci", "**/node_modules", "**/__pycache__"]

smartquotes = False  # a prime is a derivative

html_theme = "furo"
html_title = "Frahm"
html_math_renderer = "mathml"
html_copy_source = False
html_show_sphinx = False
pygments_style = "tango"
pygments_dark_style = "monokai"

# The chapters, in the order of a reader who comes to use it. The README lists them in its tables; Sphinx wants a tree.
chapters = {
    "Use": [
        "studies/walkthrough", "studies/README", "studies/motion/README", "studies/stops/README", "studies/tuning/README",
        "studies/identification/README", "studies/uncertainty/README", "studies/program/README", "studies/python/README",
        "studies/slurm/README", "engine/README", "studies/glossary",
    ],
    "Results": ["results/README", "results/FORMAT", "results/report/README"],
    "Theory and trust": ["solvers/README", "tests/README", "tests/benchmarks/orbits", "tests/benchmarks/histories"],
    "The project": ["CONTRIBUTING", "CHANGELOG"],
}
