"""Configuration of the documentation site: ``make site`` builds it from docs/ with
Sphinx.
"""

import os

from pygments.lexers.c_cpp import CLexer
from sphinx.application import Sphinx

import uplift
from tools.command_reference import command_reference

project = "uplift"
author = "The uplift developers"
copyright = author
version = release = uplift.__version__

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
exclude_patterns = ["templates", "data"]
highlight_language = "text"
default_role = "py:obj"
smartquotes = False  # they would change --options
myst_heading_anchors = 4

# The Python reference comes from docstrings in numpydoc's format. Annotations would
# repeat them.
autodoc_typehints = "none"
autodoc_member_order = "bysource"
napoleon_google_docstring = False
napoleon_use_rtype = False

# Notebooks are stored with their output, and run again while the site is built, in an
# empty folder.
nb_execution_mode = "force"
nb_execution_in_temp = True
nb_execution_raise_on_error = True
nb_execution_timeout = 300
nb_merge_streams = True
os.environ.setdefault("JUPYTER_PLATFORM_DIRS", "1")

# Nothing is loaded from the network: system fonts, own style sheets and scripts.
html_theme = "furo"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_title = f"uplift {version}"
html_copy_source = False
html_show_sphinx = False
nb_ipywidgets_js: dict[str, dict[str, str]] = {}

OUTSIDE = {
    "../atlases/README.md": "project/atlases.md",
    "../CHANGELOG.md": "project/changelog.md",
    "../CONTRIBUTING.md": "project/contributing.md",
}
"""Files outside docs/ that pages link to, and the pages of the site that include them.
"""


def setup(app: Sphinx) -> None:
    """Register what Sphinx does not know."""
    app.add_lexer("osl", CLexer)
    app.connect("source-read", complete_source)


def complete_source(app: Sphinx, name: str, source: list[str]) -> None:
    """Redirect links to files outside docs/, and append the help of all commands to
    their page.
    """
    for path, page in OUTSIDE.items():
        source[0] = source[0].replace(f"]({path})", f"]({page})")
    if name == "reference/commands":
        source[0] += command_reference()
