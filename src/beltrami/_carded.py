"""What notebooks show of an object. Who draws it, the package root registers."""

from __future__ import annotations

import importlib
from typing import Any

_DRAWER: list[str] = []


def register_drawer(module: str) -> None:
    """Name the module whose ``html`` and ``png`` draw; it is imported when something is shown."""
    _DRAWER[:] = [module]


def _drawer() -> Any:
    return importlib.import_module(_DRAWER[0])


class Carded:
    """An object that a notebook shows as a card: what it is, in a few lines, and a small picture.

    The rooms know nothing of pictures, so that a mesh may be shown and does not import display.
    """

    def _repr_html_(self) -> str:
        """Return the card; the picture is in it, no file and no network is needed."""
        return str(_drawer().html(self))

    def _repr_png_(self) -> bytes | None:
        """Return the picture alone, or None where there is nothing to be seen."""
        picture: bytes | None = _drawer().png(self)
        return picture
