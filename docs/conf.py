"""How Sphinx makes the site from this folder: `make docs`."""

import sys
from pathlib import Path

import vorotool

sys.path.insert(0, str(Path(__file__).parent / "scripts"))
from cli_reference import reference

project = "vorotool"
version = release = vorotool.__version__
copyright = "the authors of vorotool"
html_title = f"vorotool {release}"

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.autosummary", "numpydoc", "sphinx_copybutton"]
exclude_patterns = ["man", "scripts"]
source_suffix = {".md": "myst-nb", ".ipynb": "myst-nb"}
nb_execution_mode = "force"  # they are kept without outputs
nb_execution_in_temp = nb_execution_raise_on_error = nb_merge_streams = True
nb_execution_timeout = 300  # seconds a notebook
myst_heading_anchors = 3
smartquotes = False  # -- begins an option
copybutton_prompt_text = "$ "
copybutton_only_copy_prompt_lines = True

# The reference of the library: the docstrings that numpydoc checks in the tests.
autosummary_generate = False
autodoc_default_options = {"members": True, "undoc-members": False}
autodoc_member_order = "bysource"
autodoc_typehints = "none"  # the docstrings tell types
numpydoc_show_class_members = False

# What the pages look like. Nothing is loaded from elsewhere: furo uses the fonts of the system.
html_theme = "furo"
html_static_path = ["static"]
html_css_files = ["site.css"]
html_copy_source = html_show_sourcelink = False
html_theme_options = {"navigation_with_keys": True}
pygments_style, pygments_dark_style = "friendly", "monokai"

# Links to files that are pages of the site under other names, as a reader of the repository follows them.
ELSEWHERE = {"../CONTRIBUTING.md": "contributing.md", "../data/README.md": "data.md"}


def setup(app):
    """Complete the sources of pages as they are read."""
    app.connect("source-read", complete)


def complete(_app, page, source):
    """Make the reference of the commands, and lead links out of this folder to the pages that include their targets."""
    if page == "cli":
        source[0] = reference()
    for path, included in ELSEWHERE.items():
        source[0] = source[0].replace(f"]({path})", f"]({included})")
