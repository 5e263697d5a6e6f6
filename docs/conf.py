"""How Sphinx makes the site from this folder: `make docs`."""

import vorotool

project = "vorotool"
version = release = vorotool.__version__
copyright = "the authors of vorotool"
html_title = f"vorotool {release}"

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.autosummary", "numpydoc", "sphinx_copybutton"]
exclude_patterns = ["man", "scripts"]
source_suffix = {".md": "myst-nb", ".ipynb": "myst-nb"}
nb_execution_mode = "off"  # `make notebooks` runs them, and the tests do
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
    """Lead links out of this folder to the pages that include what they lead to."""
    app.connect("source-read", lead_to_pages)


def lead_to_pages(_app, _page, source):
    """Change the links of one page."""
    for path, page in ELSEWHERE.items():
        source[0] = source[0].replace(f"]({path})", f"]({page})")
