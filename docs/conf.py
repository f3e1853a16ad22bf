"""Sphinx configuration; `sphinx-build -W docs docs/_build/html` builds the site."""

from importlib.metadata import version as installed_version
from pathlib import Path

import cellcrawl

project = "cellcrawl"
author = "The cellcrawl developers"
copyright = "2026, the cellcrawl developers"
release = version = installed_version("cellcrawl")

extensions = [
    "myst_parser",
    "numpydoc",
    "sphinx.ext.autodoc",
    "sphinx.ext.mathjax",
    "sphinx_copybutton",
    "sphinx_design",
    "sphinx-mathjax-offline",
]
myst_enable_extensions = ["colon_fence", "dollarmath", "attrs_block", "attrs_inline"]
myst_heading_anchors = 3
exclude_patterns = ["_build", "_live"]
numpydoc_show_class_members = False
autodoc_typehints = "none"
autodoc_member_order = "bysource"
copybutton_prompt_text = r">>> |\.\.\. |\$ "
copybutton_prompt_is_regexp = True

html_theme = "furo"
html_title = "cellcrawl"
html_static_path = ["_static"]
html_favicon = "_static/favicon.svg"
html_css_files = ["site.css"]
html_js_files = ["enlarge.js"]
html_search_scorer = str(Path(__file__).with_name("scorer.js"))
html_show_sourcelink = False

# The live cell lies beside the pages, which hold it in frames
_live = Path(__file__).with_name("_live")
_live.mkdir(exist_ok=True)
cellcrawl.explore(view="full").save(_live / "cell.html")
html_extra_path = ["_live"]
