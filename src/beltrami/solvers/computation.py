"""Computation: how eigenpairs were found, how long that took, and what is proven."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Computation:
    """What a search for eigenpairs did.

    Attributes
    ----------
    method
        ``"dense"`` (LAPACK; for n <= 2500 also where Lanczos does not arrive), ``"lanczos"``,
        ``"slices"`` (Lanczos in each), ``"kernel"`` (nothing to compute), or ``"given"``.
    precision
        ``"float32"`` or ``"float64"`` inside; what comes out is float64, polished.
    shift
        σ of the last factor of L - σB; 0 if there was none.
    basis
        Largest number of basis vectors.
    solves
        Right-hand sides solved with a factor.
    history
        The largest residual before each pass of polishing, and after the last.
    counted_within
        All eigenvalues nearer than this to where we looked are here, by count of inertia; 0 if
        nothing was counted, and where the kernel alone is much larger than what was wanted.
    seconds
        Wall-clock seconds of each stage: (name, seconds).
    """

    method: str = "given"
    precision: str = "float64"
    shift: float = 0.0
    basis: int = 0
    solves: int = 0
    history: tuple[float, ...] = ()
    counted_within: float = 0.0
    seconds: tuple[tuple[str, float], ...] = ()
