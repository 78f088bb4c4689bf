"""Domain: what else than a mesh, a topology or a matrix of weights can make its own pair."""

from __future__ import annotations

from typing import Protocol, runtime_checkable

from beltrami.operators.pair import Laplacian


@runtime_checkable
class Domain(Protocol):
    """Anything that makes its own pair (L, B); ``laplacian`` calls this one method.

    So the operators need not know grids or point clouds, and the rooms above them may add more.
    """

    def make_laplacian(self, weights: str | None, mass: str | None) -> Laplacian:
        """Return the pair for these names; None is the default of the domain."""
        ...
