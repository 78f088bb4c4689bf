"""What was made of the code need not be made again while the code is older."""

from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2]
_KINDS = (".py", ".js", ".mjs", ".css", ".html", ".glsl")


@cache
def _newest() -> float:
    files = (p for folder in ("src", "examples") for p in (ROOT / folder).rglob("*"))
    return max(p.stat().st_mtime for p in files if p.suffix in _KINDS)


def is_fresh(place: Path) -> bool:
    """Whether a file is there, and newer than the library and the examples."""
    return place.exists() and place.stat().st_mtime > _newest()
