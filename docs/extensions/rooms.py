"""The API: a page for each room, with all public names; docstrings made fit for Sphinx."""

import importlib
import re
from pathlib import Path

import beltrami

TITLES = {
    "mesh": "Meshes",
    "shapes": "Shapes",
    "io": "Files",
    "datasets": "Data sets",
    "operators": "Operators",
    "solvers": "Solvers",
    "spectrum": "Spectrum",
    "kernels": "Kernels of filters",
    "diffusion": "Diffusion",
    "geodesics": "Geodesics",
    "parameterization": "Maps to the plane",
    "compression": "Compression",
    "grids": "Grids",
    "surfaces": "Parametric surfaces",
    "learning": "Learning",
    "display": "Pictures",
    "batch": "Batches",
    "errors": "Errors",
}  # a room that is not here comes last, under its own name
_CODE = re.compile(r"(``.*?``|:\w+:`[^`]*`)", re.DOTALL)
_ITEMS = "Chapter items:"


def rooms() -> dict[str, str]:
    """Return the rooms that have public names, and the titles of their pages."""
    there = {place.split(".")[0] for place in beltrami._HOME.values()} | set(beltrami._MODULES)
    order = [*TITLES, *sorted(there - set(TITLES))]
    return {room: TITLES.get(room, room.capitalize()) for room in order if room in there}


def names_of(room: str) -> list[str]:
    """Return the public names of a room, as directives want them: module and name."""
    home = {f"beltrami.{n}" for n, place in beltrami._HOME.items() if place.split(".")[0] == room}
    if room in beltrami._MODULES:
        module = getattr(beltrami, room)
        public = getattr(module, "__all__", None) or [
            name
            for name, value in vars(module).items()
            if getattr(value, "__module__", "") == module.__name__ and not name.startswith("_")
        ]
        home |= {f"{module.__name__}.{name}" for name in public}
    return sorted(home, key=str.lower)


def resolve(name: str):
    """Return the object of a dotted name."""
    module, _, last = name.rpartition(".")
    return getattr(importlib.import_module(module), last)


def _page(room: str, title: str) -> str:
    names = names_of(room)
    module = (
        getattr(beltrami, room)
        if room in beltrami._MODULES
        else importlib.import_module(f"beltrami.{room}")
    )
    lines = [title, "=" * len(title), "", escape(module.__doc__ or "").strip(), ""]
    for name in names:
        thing = resolve(name)
        kind = "autoclass" if isinstance(thing, type) else "autofunction"
        if not callable(thing):
            kind = "autodata"
        lines += [f".. {kind}:: {name}"]
        if kind == "autoclass":
            lines += ["   :members:"]
            lines += ["   :inherited-members:"] * (not issubclass(thing, Exception))
        lines += [""]
    return "\n".join(lines)


def _index() -> str:
    lines = [
        "API",
        "===",
        "",
        "Every public name, by room. `ARCHITECTURE.md` says which room may",
        "use which; names are reached from the package itself: ``bt.laplacian``.",
        "",
    ]
    lines += [".. toctree::", "   :maxdepth: 2", ""]
    lines += [f"   {room}" for room in rooms()] + [""]
    return "\n".join(lines)


def escape(text: str) -> str:
    """Escape what prose means and reStructuredText reads otherwise: bars, stars, underscores."""
    parts = _CODE.split(text)
    parts[::2] = [re.sub(r"(?<!\\)([|*])", r"\\\1", prose) for prose in parts[::2]]
    return re.sub(r"(\w)_(?=[\s,.;:)\]|]|$)", r"\1\\_", "".join(parts))


def process(_app, _what, _name, _thing, _options, lines):
    """Escape the paragraphs of a docstring that are no examples."""
    paragraphs = "\n".join(lines).split("\n\n")
    escaped = [text if ">>>" in text else escape(text) for text in paragraphs]
    text = "\n\n".join(escaped).replace(_ITEMS, f":doc:`{_ITEMS[:-1]} <../chapter-map>`:")
    lines[:] = text.split("\n")


def write(app):
    """Write the pages, if they changed."""
    folder = Path(app.srcdir, "api")
    folder.mkdir(exist_ok=True)
    pages = {room: _page(room, title) for room, title in rooms().items()} | {"index": _index()}
    for name, text in pages.items():
        place = folder / f"{name}.rst"
        if not place.exists() or place.read_text(encoding="utf-8") != text:
            place.write_text(text, encoding="utf-8")


def setup(app):
    """Register: pages before they are read, docstrings before napoleon sees them."""
    app.connect("builder-inited", write)
    app.connect("autodoc-process-docstring", process, priority=100)
    return {"parallel_read_safe": True}
