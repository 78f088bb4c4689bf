"""The live page: `bt.page` writes it when the site is built, and the site embeds it."""

from pathlib import Path

import beltrami as bt
from freshness import is_fresh


def write(app):
    """Write the page into the static files, and how large it is."""
    place, note = Path(app.srcdir, "static", "viewer.html"), Path(app.srcdir, "viewer-note.md")
    mesh = bt.shapes.blob(5000)
    if not is_fresh(place):
        bt.page(mesh, place, title="A creature", up="z")
    note.write_text(
        f"The page below is one of {mesh.n_vertices} vertices and {place.stat().st_size / 1e6:.1f} "
        "MB; [open it alone](static:viewer.html), or save it and send it to somebody.\n",
        encoding="utf-8",
    )


def setup(app):
    """Register the page."""
    app.connect("builder-inited", write)
    return {"parallel_read_safe": True}
