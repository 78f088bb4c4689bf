"""Domain: what makes its own pair; and the door of all that takes a pair."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

from beltrami.errors import DimensionError
from beltrami.operators.pair import Laplacian


@runtime_checkable
class Domain(Protocol):
    """Anything that makes its own pair (L, B); ``laplacian`` calls this one method.

    So the operators need not know grids or point clouds, and the rooms above them may add more.
    """

    def make_laplacian(self, weights: str | None, mass: str | None) -> Laplacian:
        """Return the pair for these names; None is the default of the domain."""
        ...


def require_laplacian(pair: object, what: str) -> Laplacian:
    """Return the pair if it is a Laplacian.

    Raises
    ------
    DimensionError
        If it is anything else, a mesh too; the line says for ``what`` it is needed.
    """
    if not isinstance(pair, Laplacian):
        raise DimensionError(
            f"a Laplacian is needed for {what}, not an object of type {type(pair).__name__}",
            remedy="Make one with laplacian(mesh).",
        )
    return pair
