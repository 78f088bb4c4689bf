"""The site: `make docs` builds it into site/, with warnings as errors."""

import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE / "extensions"))

import beltrami  # noqa: E402

project = "beltrami"
author = "The beltrami developers"
project_copyright = author
release = version = beltrami.__version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.napoleon",
    "sphinx.ext.linkcode",
    "mathematics",
    "references",
    "rooms",
    "commands",
    "gallery",
    "card",
    "viewer",
    "source_pages",
]
exclude_patterns = ["extensions", "images", "viewer-note.md", "card.md", "gallery/**"]

myst_enable_extensions = ["dollarmath", "colon_fence", "attrs_block"]
myst_heading_anchors = 4
myst_url_schemes = {
    "http": None,
    "https": None,
    "code": "code/{{path}}.html",
    "static": "_static/{{path}}",
}
smartquotes = False
pygments_style = "friendly"

autodoc_member_order = "bysource"
autodoc_typehints = "none"  # shapes and units are in the text
autodoc_preserve_defaults = True
napoleon_google_docstring = False
napoleon_use_ivar = True
napoleon_attr_annotations = False
toc_object_entries_show_parents = "hide"
napoleon_use_rtype = False

templates_path = ["templates"]
_WITH_CONTENTS = (  # no contents beside wide tables
    "start", "gallery", "commands", "conventions", "errata", "format", "howto/*", "api/*",
)  # fmt: skip
html_theme = "pydata_sphinx_theme"
html_title = "beltrami"
html_static_path = ["static"]
html_css_files = ["beltrami.css"]
html_show_sourcelink = False
html_copy_source = False
html_math_renderer = "mathml"  # by the browser: no script, no network
html_sidebars = {page: [] for page in ("index", "start", "viewer", "gallery")}
html_theme_options = {
    "logo": {"text": "beltrami"},
    "show_prev_next": False,
    "navigation_with_keys": False,
    "show_toc_level": 2,
    "navbar_align": "left",
    "secondary_sidebar_items": {page: ["page-toc"] for page in _WITH_CONTENTS},
    "footer_start": ["copyright"],
    "footer_end": [],
    "pygments_light_style": "friendly",
    "pygments_dark_style": "github-dark",
}


def linkcode_resolve(domain, info):
    """Return where the source of an object is shown; pages of the API are all in one folder."""
    from source_pages import line_of

    found = line_of(info["module"], info["fullname"]) if domain == "py" else None
    return None if found is None else "../code/{}.html#L-{}".format(*found)
