"""The gallery: every script in `examples/` is run, and shown with its pictures and its numbers."""

import ast
import os
import re
import subprocess
import sys
from pathlib import Path

from sphinx.util import logging
from sphinx.util.display import status_iterator

from freshness import is_fresh

ROOT = Path(__file__).parents[2]
_PICTURES = (".png", ".webp", ".gif")
_HEAD = """# Gallery

Each of these pictures is made by the script below it when this site is built, by our own renderer
and, for curves, by matplotlib. What the script prints stands there too; the tests assert these
numbers. Run one as its first lines say.
"""


def scripts() -> list[Path]:
    """Return the examples that say how they are run."""
    return [p for p in sorted((ROOT / "examples").glob("*.py")) if _usage(p)]


def _usage(script: Path) -> str | None:
    """Return what the script wants: a folder, or the name of a picture."""
    text = ast.get_docstring(ast.parse(script.read_text(encoding="utf-8"))) or ""
    found = re.search(rf"^python examples/{script.name} (\S+)", text, re.MULTILINE)
    return found[1] if found else None


def run(script: Path, folder: Path) -> None:
    """Run an example into a folder of its own, unless its pictures are newer than the code."""
    said = folder / "said.txt"
    if is_fresh(said):
        return
    folder.mkdir(parents=True, exist_ok=True)
    wanted = _usage(script)
    target = folder if wanted == "FOLDER" else folder / Path(wanted).name
    environment = os.environ | {"PYTHONPATH": str(ROOT / "src")}
    done = subprocess.run(
        [sys.executable, script, target], capture_output=True, text=True, env=environment
    )
    if done.returncode:
        raise RuntimeError(f"{script.name} failed:\n{done.stderr}")
    said.write_text(done.stdout, encoding="utf-8")


def section(script: Path, folder: Path) -> str:
    """Return the part of the page for one example."""
    text = ast.get_docstring(ast.parse(script.read_text(encoding="utf-8")))
    title, _, rest = text.partition("\n\n")
    title = title.rstrip(".").replace("\n", " ")
    prose = re.sub(r"^(python examples/.*)$", r"    \1", rest, flags=re.MULTILINE)
    pictures = sorted(p for p in folder.iterdir() if p.suffix in _PICTURES)
    shown = "\n".join(f"![{title}](gallery/{folder.name}/{p.name})\n" for p in pictures)
    said = (folder / "said.txt").read_text(encoding="utf-8").strip()
    says = f"It prints:\n\n```text\n{said}\n```\n" if said else ""
    code = f"[The script](../examples/{script.name})."
    return f"## {title}\n\n{prose}\n\n{shown}\n{says}\n{code}\n"


def write(app):
    """Run the examples, and write the page."""
    place = Path(app.srcdir, "gallery")
    listed = scripts()
    for script in status_iterator(listed, "running examples... ", length=len(listed)):
        run(script, place / script.stem)
    text = "\n".join([_HEAD, *(section(script, place / script.stem) for script in listed)])
    Path(app.srcdir, "gallery.md").write_text(text, encoding="utf-8")
    logging.getLogger(__name__).info("%d examples", len(listed))


def setup(app):
    """Register the gallery."""
    app.connect("builder-inited", write)
    return {"parallel_read_safe": True}
