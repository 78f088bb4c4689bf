"""What a singular matrix maps to zero, and the systems that it can still solve."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csc_array, csr_array
from scipy.sparse.csgraph import connected_components

from beltrami._arrays import Floats, as_floats, rectangular, require_finite
from beltrami.errors import BeltramiError, DimensionError, SingularMatrixError, check_name

_ROUNDING = 1e-14  # a sum of a row, beside the sum of its absolute values, that counts as zero
_IN_KERNEL = 1e-8  # how much of a vector that is said to be in the kernel may be left


def null_space(matrix: csc_array, kernel: ArrayLike | str | None) -> csr_array | None:
    """Return an orthonormal basis (n, k) of the kernel, or None if it is trivial.

    ``"constants"``: the constants on each component of the graph of the matrix, if its rows add to
    zero to rounding. None: nothing. Vectors (n,) or (n, k): their span.

    Raises
    ------
    DimensionError, NonFiniteError, UnknownNameError
        If these are not vectors of n finite numbers, or not this name.
    BeltramiError
        If a vector is not in the kernel, or depends on the others.
    """
    if kernel is None:
        return None
    if isinstance(kernel, str):
        check_name("kernel", kernel, ("constants",))
        return _constants(matrix) if _rows_add_to_zero(matrix) else None
    return _span(matrix, rectangular(kernel))


def without(basis: csr_array | None, columns: Floats) -> Floats:
    """Return vectors (c, n) without their parts in the kernel."""
    if basis is None:
        return columns
    return np.ascontiguousarray(columns - (basis @ (columns @ basis).T).T)


def require_solvable(basis: csr_array | None, columns: Floats, tolerance: float) -> None:
    """Check that right-hand sides (c, n) are orthogonal to the kernel, so that there is a solution.

    Raises
    ------
    SingularMatrixError
        If one is not, to the tolerance; ``error.rows`` has a row of the component at fault.
    """
    if basis is None or not columns.size:
        return
    largest = np.abs(columns).max(axis=1, keepdims=True)
    scaled = columns / np.where(largest > 0, largest, 1)  # whose squares do not underflow
    parts = np.abs(scaled @ basis) / np.maximum(np.linalg.norm(scaled, axis=1, keepdims=True), 1)
    column, vector = np.unravel_index(parts.argmax(), parts.shape)
    if parts[column, vector] > tolerance:
        raise SingularMatrixError(
            f"the matrix is singular and there is no solution: {parts[column, vector]:.1e} of "
            f"column {column} of the right-hand side is in the kernel. Subtract that part (the "
            "mean, where the kernel is the constants), or add a mass to the matrix",
            rows=csc_array(basis).indices[csc_array(basis).indptr[vector]],
        )


def _rows_add_to_zero(matrix: csc_array) -> bool:
    """Check A 1 = 0 beside abs(A) 1."""
    ones = np.ones(matrix.shape[0])
    allowed = _ROUNDING + np.finfo(np.float64).eps * np.diff(matrix.indptr)
    return bool((np.abs(matrix.T @ ones) <= allowed * (abs(matrix).T @ ones)).all())


def _constants(matrix: csc_array) -> csr_array:
    """Return the constant on each component, of norm 1."""
    count, labels = connected_components(matrix, directed=False)
    n = len(labels)
    values = 1 / np.sqrt(np.bincount(labels))[labels]
    return csr_array((values, labels, np.arange(n + 1)), shape=(n, count))


def _span(matrix: csc_array, vectors: Any) -> csr_array | None:
    """Return an orthonormal basis of given vectors, after a check that A maps them to zero."""
    n = matrix.shape[0]
    given = as_floats(vectors)
    given = given[:, None] if given.ndim == 1 else given
    if given.ndim != 2 or len(given) != n:
        raise DimensionError(f"the kernel has the shape {given.shape} where ({n}, k) is needed")
    require_finite(given, "the kernel")
    if not given.shape[1]:
        return None
    scale = np.abs(given).max(axis=0)
    allowed = _IN_KERNEL * abs(matrix).sum(axis=0).max() * scale
    wrong = np.flatnonzero(~(np.abs(matrix @ given).max(axis=0) <= allowed))
    if len(wrong):
        raise BeltramiError(f"vector {wrong[0]} of the kernel is not mapped to zero")
    basis, sizes, _ = np.linalg.svd(given / np.where(scale > 0, scale, 1), full_matrices=False)
    if not sizes.min() > 1e-10 * sizes.max():
        raise BeltramiError("the vectors of the kernel depend on each other")
    return csr_array(basis)
