"""What iterative solvers share: the door, products for several columns at once, the true residual.

A method is a generator for one column: it yields (p, q) and finds A p in q when it goes on. So
several columns share each pass over the matrix, though each has scalars of its own.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Protocol, TypeAlias

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csc_array, csr_array

from beltrami._arrays import Floats, whole
from beltrami._progress import Progress
from beltrami.errors import BeltramiError, ConvergenceError, DimensionError, NonFiniteError
from beltrami.solvers.matrix import as_right_hand_side
from beltrami.solvers.null_space import null_space, require_solvable, without
from beltrami.solvers.preconditioners import InPlace, Preconditioner, make_preconditioner
from beltrami.solvers.vectors import AT_ONCE, dot, multiply

MOST = 20_000  # iterations, unless the caller says otherwise

Products: TypeAlias = Iterator[tuple[Floats, Floats]]


@dataclass(frozen=True, eq=False, repr=False)
class IterativeSolution:
    """The solution of a linear system, and how it was found.

    Attributes
    ----------
    solution
        (n,) or (n, c), as the right-hand side.
    iterations
        Number of products with the matrix that the slowest column took, those that only check
        left out.
    residuals
        (iterations + 1,) or (iterations + 1, c): :math:`|b - Ax| / |b|` after each iteration; the
        last is computed anew from the solution. A column that is done keeps its last value.
    method, preconditioner
        Their names.
    """

    solution: Floats
    iterations: int
    residuals: Floats
    method: str
    preconditioner: str

    def __repr__(self) -> str:
        last = float(self.residuals[-1].max(initial=0.0))
        return (
            f"<IterativeSolution: {self.method}, preconditioner {self.preconditioner}, "
            f"{self.iterations} iterations, residual {last:.1e}>"
        )


@dataclass(eq=False)
class Trace:
    """The residuals of one column, of which b has the norm 1, and when to stop."""

    tolerance: float
    most: int
    sizes: list[float] = field(default_factory=list)

    def arrived(self, size: float) -> bool:
        """Note a residual; tell whether it is small enough."""
        self.sizes.append(size)
        if not math.isfinite(size):
            raise NonFiniteError("the iteration overflowed: scale the matrix")
        if size > self.tolerance and len(self.sizes) > self.most:
            raise self.failure(
                f"after {self.most} iterations", "Allow more, take a better preconditioner"
            )
        return size <= self.tolerance

    def failure(self, when: str, remedy: str) -> ConvergenceError:
        """Return the error of a column that does not arrive."""
        return ConvergenceError(
            f"the relative residual is {self.sizes[-1]:.1e} {when} (the least was "
            f"{min(self.sizes):.1e}), and not {self.tolerance:.1e}. {remedy}, or "
            "factorize the matrix",
            residuals=self.sizes,
        )


class Method(Protocol):
    """One run of a method, from the residual r of x; it changes both in place."""

    def __call__(
        self, matrix: csc_array, r: Floats, x: Floats, trace: Trace, precondition: InPlace
    ) -> Products:
        """Iterate until the recursive residual is small."""
        ...


def iterate(
    name: str,
    method: Method,
    matrix: csc_array,
    b: ArrayLike,
    preconditioner: str | Preconditioner,
    tolerance: float,
    most: int | None,
    start: ArrayLike | None,
    kernel: ArrayLike | str | None,
    progress: Progress | None,
) -> IterativeSolution:
    """Check what is given, run a method on each column, and put the answer together."""
    n = matrix.shape[0]
    right = _finite(as_right_hand_side(b, n), "right-hand side")
    if not 0 < tolerance < 1:
        raise BeltramiError(f"the tolerance must be between 0 and 1, not {tolerance}")
    if most is not None:
        whole("most_iterations", most, 1)
    rows = np.ascontiguousarray(right.reshape(n, -1).T)
    basis = null_space(matrix, kernel)
    require_solvable(basis, rows, tolerance)
    first = np.zeros_like(right) if start is None else _as_start(start, right)
    found = without(basis, np.array(first.reshape(n, -1).T, order="C"))
    label, precondition = make_preconditioner(preconditioner, matrix, basis)
    traces = [Trace(tolerance, most or min(10 * n + 20, MOST)) for _ in rows]
    columns = [
        _column(method, matrix, without(basis, row[None])[0], x, trace, precondition, basis)
        for row, x, trace in zip(rows, found, traces, strict=True)
    ]
    _run_together(matrix, columns, progress)
    residuals = _padded([trace.sizes for trace in traces])
    return IterativeSolution(
        np.ascontiguousarray(found.T).reshape(right.shape),
        len(residuals) - 1,
        residuals.reshape((len(residuals), *right.shape[1:])),
        name,
        label,
    )


def _column(
    method: Method,
    matrix: csc_array,
    b: Floats,
    x: Floats,
    trace: Trace,
    precondition: InPlace,
    basis: csr_array | None,
) -> Products:
    """Run a method from the true residual, again where rounding has misled the recursive one."""
    largest = float(np.abs(b).max())
    if not largest:
        x[:] = 0
        trace.arrived(0.0)
        return
    b = b / largest  # so that squares do not overflow
    length = math.sqrt(dot(b, b))
    b, norm = b / length, largest * length
    x /= norm
    q, before = np.empty_like(x), math.inf
    while True:
        x[:] = without(basis, x[None])[0]
        yield x, q
        r = without(basis, (b - q)[None])[0]
        size = math.sqrt(dot(r, r))  # not by BLAS: its sums depend on the number of threads
        del trace.sizes[-1:]  # the recursive one
        if trace.arrived(size):
            break
        if not size < before / 2:
            raise trace.failure("and rounding keeps it there", "Take a larger tolerance")
        before = size
        yield from method(matrix, r, x, trace, precondition)
    x *= norm


def _run_together(matrix: csc_array, columns: list[Products], progress: Progress | None) -> None:
    """Run all columns to their ends, four at a time."""
    waiting, left = iter(columns), len(columns)
    live: list[tuple[Products, tuple[Floats, Floats]]] = []
    while True:
        while len(live) < AT_ONCE and (column := next(waiting, None)) is not None:
            live.extend((column, pair) for pair in _next(column))
        if not live:
            return
        multiply(matrix, [p for _, (p, _) in live], [q for _, (_, q) in live])
        running = len(live)
        live = [(column, pair) for column, _ in live for pair in _next(column)]
        if len(live) < running:
            left -= running - len(live)
            if progress is not None:
                progress(len(columns) - left, len(columns))


def _next(column: Products) -> list[tuple[Floats, Floats]]:
    """Return the next pair of a column, or none."""
    pair = next(column, None)
    return [] if pair is None else [pair]


def _padded(histories: list[list[float]]) -> Floats:
    """Return histories as columns (k, c), each continued by its last value."""
    length = max((len(history) for history in histories), default=1)
    rows = [history + history[-1:] * (length - len(history)) for history in histories]
    return np.array(rows, dtype=np.float64).reshape(len(histories), length).T


def _finite(values: Floats, what: str) -> Floats:
    if not np.isfinite(values).all():
        raise NonFiniteError(f"the {what} has values that are NaN or infinite")
    return values


def _as_start(start: ArrayLike, right: Floats) -> Floats:
    """Check that a start has the shape of the right-hand side."""
    first = _finite(as_right_hand_side(start, len(right), "start"), "start")
    if first.shape != right.shape:
        raise DimensionError(f"the start has the shape {first.shape} where {right.shape} is needed")
    return first
