"""PARDISO (O. Schenk, K. Gärtner) of Intel's MKL, through pypardiso; extra ``fast``."""

from __future__ import annotations

import weakref
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.sparse import coo_array, csc_array, csr_array, triu

from beltrami._arrays import Floats
from beltrami._optional import require
from beltrami.errors import SingularMatrixError
from beltrami.solvers.symmetry import rows_against_definite, rows_against_symmetric

_DEFINITE, _SYMMETRIC, _GENERAL = 2, -2, 11  # kinds of matrices, as PARDISO numbers them
_MEMORY, _FACTORS, _FILL, _CHANGED, _POSITIVE, _NEGATIVE = 15, 16, 17, 13, 21, 22  # of iparm


@dataclass(frozen=True, eq=False)
class Pardiso:
    """A factor; ``solver`` is pypardiso's object, ``matrix`` what it was given."""

    solver: Any
    matrix: csr_array

    def __post_init__(self) -> None:
        weakref.finalize(self, _free, self.solver).atexit = False

    @property
    def fill(self) -> int:
        """Number of entries of the factors."""
        return int(self.solver.iparm[_FILL])

    @property
    def memory(self) -> int:
        """Bytes of the order and of the factors."""
        return 1024 * int(self.solver.iparm[_MEMORY] + self.solver.iparm[_FACTORS])

    @property
    def inertia(self) -> tuple[int, int] | None:
        """Numbers of positive and negative eigenvalues, where A is symmetric."""
        if self.solver.mtype == _GENERAL:
            return None
        if self.solver.mtype == _DEFINITE:
            return int(self.matrix.shape[0]), 0
        return int(self.solver.iparm[_POSITIVE]), int(self.solver.iparm[_NEGATIVE])

    @property
    def changed(self) -> int:
        """Number of pivots that were nearly zero, and were replaced by larger ones."""
        return int(self.solver.iparm[_CHANGED])

    def solve(self, b: Floats) -> Floats:
        """Return x with A x = b, for (n,) or (n, c)."""
        if not b.size:
            return np.zeros(b.shape)
        with _one_thread(self.solver):
            return np.ascontiguousarray(self.solver.solve(self.matrix, b))

    def logdet(self) -> None:
        """Not told."""


def factorize_pardiso(matrix: csc_array) -> Pardiso:
    """Factorise any invertible matrix, by what its symmetry allows; who calls must try the factor.

    Of a singular matrix it would change the pivots and go on. So where it changes one, the next
    kind of factorisation is tried, and after LU, which has scaling and matching, none is left.
    It runs on one thread, so that results do not depend on how many there are.

    Raises
    ------
    MissingExtraError
        If pypardiso, or the MKL, is not installed.
    SingularMatrixError
        If PARDISO finds no pivots, or a column is zero.
    """
    library = require("pypardiso", "fast", 'backend="pardiso"')
    empty = np.flatnonzero(np.diff(matrix.indptr) == 0)
    if len(empty):
        raise SingularMatrixError(f"the matrix is singular: column {empty[0]} is zero", empty)
    kinds = [_GENERAL]
    if not len(rows_against_symmetric(matrix)):
        kinds.insert(0, _SYMMETRIC)
    if not len(rows_against_definite(matrix)):
        kinds.insert(0, _DEFINITE)
    problem = ""
    for kind in kinds:
        try:
            found = _factorized(library, matrix, kind)
        except library.pardiso_wrapper.PyPardisoError as cause:
            problem = str(cause)
            continue
        if not found.changed:
            return found
        problem = f"PARDISO had to change {found.changed} pivots that were nearly zero"
    raise SingularMatrixError(f"the matrix is singular to working precision: {problem}")


def _factorized(library: Any, matrix: csc_array, kind: int) -> Pardiso:
    solver = library.PyPardisoSolver(mtype=kind)
    given = csr_array(matrix) if kind == _GENERAL else _upper(matrix)
    try:
        with _one_thread(solver):
            solver.factorize(given)
    except library.pardiso_wrapper.PyPardisoError:
        _free(solver)
        raise
    return Pardiso(solver, given)


def _upper(matrix: csc_array) -> csr_array:
    """Return the upper triangle, by rows; PARDISO wants every entry of the diagonal, zeros too."""
    n = matrix.shape[0]
    above, every = coo_array(triu(matrix)), np.arange(n)
    values = np.concatenate([above.data, np.zeros(n)])
    rows, columns = (np.concatenate([where, every]) for where in above.coords)
    return csr_array(coo_array((values, (rows, columns)), shape=(n, n)))


@contextmanager
def _one_thread(solver: Any) -> Iterator[None]:
    """Let the MKL use one thread in this one, and as many as before after it."""
    threads = solver.libmkl.MKL_Set_Num_Threads_Local
    before = threads(1)
    try:
        yield
    finally:
        threads(before)


def _free(solver: Any) -> None:
    """Give the memory back, which pypardiso does not do by itself."""
    solver.free_memory(everything=True)
