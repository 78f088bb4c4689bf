"""What a notebook shows of a mesh and of its spectrum, for the page that tells of it."""

from pathlib import Path

import beltrami as bt


def write(app):
    """Write the cards, as the objects make them."""
    mesh = bt.shapes.blob(5000)
    basis = bt.fourier_basis(bt.laplacian(mesh), 100)
    cards = "\n".join(thing._repr_html_() for thing in (mesh, basis))
    Path(app.srcdir, "card.md").write_text(f"```{{raw}} html\n{cards}\n```\n", encoding="utf-8")


def setup(app):
    """Register the cards."""
    app.connect("builder-inited", write)
    return {"parallel_read_safe": True}
