"""Preconditioners: cheap approximations of A⁻¹, symmetric positive definite."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, TypeAlias

import numpy as np
from scipy.sparse import csc_array, csr_array

from beltrami._arrays import Floats
from beltrami._optional import require
from beltrami.errors import (
    DimensionError,
    NonFiniteError,
    NotPositiveDefiniteError,
    check_name,
)
from beltrami.solvers.null_space import without
from beltrami.solvers.symmetry import largest_entries
from beltrami.solvers.vectors import dot

Preconditioner: TypeAlias = Callable[[Floats], Floats]  # r -> z
InPlace: TypeAlias = Callable[[Floats, Floats], None]  # (r, z): the same, written into z

PRECONDITIONERS = ("jacobi", "multigrid", "none")
_SEED = 141_421_356
_NOTHING = 1e-12  # beside the largest singular value of the coarsest level


def make_preconditioner(
    kind: str | Preconditioner, matrix: csc_array, basis: csr_array | None
) -> tuple[str, InPlace]:
    """Return the name of a preconditioner, and what writes z ≈ A⁻¹ r for a residual r.

    ``"jacobi"`` divides by the absolute diagonal; ``"multigrid"`` is a cycle of smoothed
    aggregation (P. Vanek, J. Mandel, M. Brezina 1996) by pyamg; ``"none"``; or a function.

    Raises
    ------
    UnknownNameError
        If there is no preconditioner of this name.
    MissingExtraError
        If pyamg is not installed.
    """
    if callable(kind):
        return getattr(kind, "__qualname__", type(kind).__name__), _checked(kind, basis)
    check_name("preconditioner", kind, PRECONDITIONERS)
    if kind == "multigrid":
        return kind, _multigrid(matrix, basis)
    if kind == "none":
        return kind, _copy
    diagonal = np.abs(matrix.diagonal())
    inverse = 1 / np.where(diagonal > 0, diagonal, largest_entries(matrix))

    def divide(r: Floats, z: Floats) -> None:
        np.multiply(inverse, r, out=z)

    return kind, divide


def energy(r: Floats, z: Floats) -> float:
    """Return <r, z>, which is positive for a preconditioner that is positive definite.

    Raises
    ------
    NotPositiveDefiniteError
        If it is not.
    """
    found = dot(r, z)
    if not found > 0 and r.any():
        raise NotPositiveDefiniteError(
            (),
            f"the preconditioner is not symmetric positive definite: <z, r> = {found:.1e}",
            "Take one that is",
        )
    return found


def _copy(r: Floats, z: Floats) -> None:
    z[:] = r


def _checked(function: Preconditioner, basis: csr_array | None) -> InPlace:
    """Give a function read-only residuals, look at what it returns, and keep out the kernel.

    Rounding puts a little of the kernel into r, of which an approximation of A⁻¹ can make much.
    """

    def apply(r: Floats, z: Floats) -> None:
        shown = without(basis, r[None])[0].view()
        shown.flags.writeable = False
        found = np.asarray(function(shown), dtype=np.float64)
        if found.shape != r.shape:
            raise DimensionError(
                f"the preconditioner returns the shape {found.shape}, not {r.shape}"
            )
        if not np.isfinite(found).all():
            raise NonFiniteError("the preconditioner returns values that are NaN or infinite")
        z[:] = without(basis, found[None])[0]

    return apply


def _multigrid(matrix: csc_array, basis: csr_array | None) -> InPlace:
    library = require("pyamg", "fast", 'preconditioner="multigrid"')
    smooth: Any = None
    if basis is not None:  # one vector is enough for constants on several components
        apart = basis.nnz <= basis.shape[0]
        smooth = basis @ np.ones((basis.shape[1], 1)) if apart else basis.toarray()
    with _seeded():
        levels = library.smoothed_aggregation_solver(
            csr_array(matrix), B=smooth, coarse_solver=("pinv", {"rtol": _NOTHING})
        )
    return _checked(levels.aspreconditioner(cycle="V").matvec, basis)


@contextmanager
def _seeded() -> Iterator[None]:
    """Let numpy's global generator, from which pyamg draws, start at a number of ours for once."""
    before = np.random.get_state()  # noqa: NPY002
    np.random.seed(_SEED)  # noqa: NPY002
    try:
        yield
    finally:
        np.random.set_state(before)  # noqa: NPY002
