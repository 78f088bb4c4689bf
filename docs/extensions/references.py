"""What Sphinx makes of docstrings, mended: the n of an (n, 3) array is no link to a class."""

from docutils import nodes
from sphinx.addnodes import pending_xref

import beltrami

_KNOWN = {name.rpartition(".")[2] for name in beltrami.__all__}


def drop(_app, tree):
    """Turn links to what is no public name into text."""
    for link in list(tree.findall(pending_xref)):
        if link.get("refdomain") != "py" or link["reftarget"].rpartition(".")[2] in _KNOWN:
            continue
        link.replace_self(nodes.inline("", "", *link.children))


def name_attributes(_app, tree):
    """Call the fields of an object attributes, which Sphinx calls variables."""
    for label in list(tree.findall(nodes.field_name)):
        if label.astext() == "Variables":
            label.children[:] = [nodes.Text("Attributes")]


def setup(app):
    """Look at each page after it is read."""
    app.connect("doctree-read", drop)
    app.connect("doctree-read", name_attributes)
    return {"parallel_read_safe": True}
