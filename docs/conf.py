"""How `make docs` makes the pages: the Markdown that stands here, with what made.py makes of the sources."""

import sys
from pathlib import Path

from sphinx.application import Sphinx

sys.path.insert(0, str(Path(__file__).parent))
import made

from loopsheet import __version__

project, author, release = "loopsheet", "loopsheet authors", __version__
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
exclude_patterns = ["_*"]
default_role = "literal"  # of docstrings: `name` is code there, too
myst_heading_anchors = 3
napoleon_google_docstring = False
napoleon_use_param = False  # "low, high" stay together
autodoc_typehints = "none"  # the docstrings say them, with shapes and units
autodoc_member_order = "bysource"
highlight_language = "text"
smartquotes_action = "D"  # dashes; what is quoted is often code
pygments_style = "friendly"

html_theme = "furo"
html_title = "loopsheet"
html_copy_source = False
html_static_path, html_css_files = ["_static"], ["pages.css"]
html_show_copyright = False


def setup(app: Sphinx) -> None:
    """Fill each page before it is read."""
    app.connect("source-read", lambda app, name, source: source.__setitem__(0, made.filled(source[0])))
