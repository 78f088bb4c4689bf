"""The live page: `bt.page` writes it when the site is built, and the site embeds it."""

from pathlib import Path

import beltrami as bt

N_VERTICES = 5000


def write(app):
    """Write the page into the static files, and what to say where it cannot be written."""
    folder = Path(app.srcdir, "static")
    place, note = folder / "viewer.html", Path(app.srcdir, "viewer-note.md")
    if not hasattr(bt, "page"):
        place.unlink(missing_ok=True)
        note.write_text("This version has no live page.\n", encoding="utf-8")
        return
    if not place.exists():
        bt.page(bt.shapes.blob(N_VERTICES), place, title="A creature", up="z")
    note.write_text(
        f"It is one file of {place.stat().st_size / 1e6:.1f} MB, which needs no server: "
        "[open it alone](static:viewer.html), or save it.\n",
        encoding="utf-8",
    )


def setup(app):
    """Register the page."""
    app.connect("builder-inited", write)
    return {"parallel_read_safe": True}
