"""Factorise a symmetric indefinite matrix, P D A D P' = L S L', and count its signs."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_array

from beltrami.errors import SingularMatrixError
from beltrami.solvers.blas import blas
from beltrami.solvers.cholesky import Cholesky
from beltrami.solvers.elimination import Elimination
from beltrami.solvers.signed_fronts import factorize_signed_fronts
from beltrami.solvers.symmetry import largest_entries

_SMALLEST = 1e-13  # pivot, of the matrix scaled to rows of size 1


def factorize_ldl(matrix: csc_array, shape: Elimination) -> Cholesky:
    """Factorise a symmetric matrix of any signs without exchanging rows.

    Rows are not exchanged, so the factors can be worthless where a pivot is small by chance; who
    calls must try them.

    Raises
    ------
    SingularMatrixError
        If a pivot is nearly zero; ``error.rows`` names its row. The matrix is singular, or needs
        exchanges.
    """
    scale = np.exp2(-np.round(np.log2(largest_entries(matrix)) / 2))
    n = len(scale)
    values, signs = np.zeros(shape.panels[-1]), np.empty(n)
    column = factorize_signed_fronts(
        matrix.indptr.astype(np.int64), matrix.indices.astype(np.int32), matrix.data, scale,
        shape.order, shape.place, shape.starts, shape.children, shape.siblings,
        shape.row_starts, shape.rows, shape.panels,
        blas(np.float64), values, np.empty(shape.stack),
        np.empty(len(shape.starts), np.int64), np.empty(n, np.int64),
        np.empty(shape.tallest, np.uint64),
        signs, np.empty(32 * (shape.widest + shape.tallest)), _SMALLEST,
    )  # fmt: skip
    if column >= 0:
        raise without_pivot(int(shape.order[column]))
    return Cholesky(shape, values, scale, signs)


def without_pivot(row: int) -> SingularMatrixError:
    """Return the error of a matrix that this factorisation cannot do."""
    return SingularMatrixError(
        f"nothing is left for the pivot of row {row}: the matrix is singular to working "
        'precision, or needs exchanges of rows. Try backend="superlu"',
        rows=[row],
    )
