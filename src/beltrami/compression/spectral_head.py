"""What precedes the coefficients in a file."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from beltrami.compression import grid as grids
from beltrami.compression.geometry import MOST_COORDINATES, read_bound, read_dimension
from beltrami.compression.grid import PositionGrid
from beltrami.compression.numbers import EFFORTS
from beltrami.compression.smoothing import WEIGHTS
from beltrami.compression.varint import Reader, to_varints

MOST_IN_A_BLOCK = {"best": 500, "fast": 250}
_DIGEST = 8


@dataclass(frozen=True)
class SpectralHead:
    """How the coefficients were rounded.

    Parameters
    ----------
    grid
        Its step is that of the coefficients; its origin is taken from the positions first.
    effort
        ``"best"`` or ``"fast"``: how many vertices a block has, at most.
    choice
        Of the smoothing of what the coefficients add up to.
    bound
        How far a vertex is from where it was, at most.
    terms
        How many coefficients the longest block has.
    corrections, correction_step
        How many vertices are corrected, by multiples of what.
    digest
        Of the basis.
    """

    grid: PositionGrid
    effort: str
    choice: int
    bound: float
    terms: int
    corrections: int
    correction_step: float
    digest: bytes

    @property
    def most(self) -> int:
        """How many vertices a block has at most."""
        return MOST_IN_A_BLOCK[self.effort]

    def to_bytes(self) -> bytes:
        """Write it."""
        d = len(self.grid.origin)
        data = to_varints([d, EFFORTS.index(self.effort), int(self.grid.is_short), self.choice])
        data += grids.to_bytes(self.grid) + np.array([self.bound], "<f8").tobytes()
        data += to_varints([self.terms, self.corrections])
        if self.corrections:
            data += np.array([self.correction_step], "<f8").tobytes()
        return data + self.digest


def read_spectral_head(reader: Reader, n: int, most: int = MOST_COORDINATES) -> SpectralHead:
    """Read what precedes the coefficients of n vertices, of at most so many coordinates."""
    d = read_dimension(reader, most)
    effort = EFFORTS[reader.varint(len(EFFORTS) - 1, "effort")]
    is_short = bool(reader.varint(1, "precision"))
    choice = reader.varint(len(WEIGHTS), "smoothing")
    grid = grids.from_bytes(reader.take((4 if is_short else 8) * (d + 1)), is_short)
    bound = read_bound(reader)
    terms = reader.varint(MOST_IN_A_BLOCK[effort], "coefficients of a block")
    corrections = reader.varint(n, "corrections")
    step = float(np.frombuffer(reader.take(8), "<f8")[0]) if corrections else 0.0
    numbers = np.array([*grid.origin, grid.step, step])
    if not (np.isfinite(numbers).all() and grid.step > 0):
        raise reader.fault("the coefficients have no positive step, or no finite origin")
    digest = reader.take(_DIGEST)
    return SpectralHead(grid, effort, choice, bound, terms, corrections, step, digest)
