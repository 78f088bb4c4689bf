"""Iterated averaging: (1 - δ) F + δ D⁻¹ W F, over and over (l. 186, equation 3.6)."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array

from beltrami._arrays import Booleans, Floats, as_function
from beltrami._jit import kernel
from beltrami._kinds import checked
from beltrami._progress import Progress, stages
from beltrami.diffusion.held import held_vertices
from beltrami.errors import BeltramiError, StepTooLongError
from beltrami.operators.domain import require_laplacian
from beltrami.operators.pair import Laplacian
from beltrami.solvers.locality import LocalRows, local_rows

_ROUNDS_A_CALL = 20  # between two looks at the progress, and at ctrl-C


@checked
def smooth(
    laplacian: Laplacian,
    f: ArrayLike,
    steps: int,
    step: float = 1.0,
    *,
    hold: ArrayLike = (),
    progress: Progress | None = None,
) -> Floats:
    r"""Average with the neighbours: :math:`((1-\delta) \mathrm{Id} + \delta \tilde W)^k f`.

    With δ = 1 this is :math:`\tilde W^k f` (l. 186); in general the explicit heat equation for
    the degree mass (equation 3.6, E51), whatever the mass of ``laplacian``.

    Chapter items: T14, Q3.6, R4, P19, P49.

    Parameters
    ----------
    laplacian
        Its weights must not be negative; its mass is not used.
    f
        (n,) or (n, c): each column is smoothed.
    steps
        Number of rounds k.
    step
        δ, without a unit. It is stable up to 2/λ, where λ <= 2 bounds the normalised spectrum
        (E52): always up to 1, and a little more on meshes.
    hold
        Vertices (indices or a mask) whose values stay as they are.
    progress
        Called with (rounds done, rounds in all).

    Returns
    -------
    (n,) or (n, c), as f. If nothing is held, Σ d_i f_i is kept in each column.

    Raises
    ------
    NegativeWeightError
        If a weight is negative: averages may then leave the range of the values; ``error.edges``.
    StepTooLongError
        If ``step`` is beyond the proven bound; ``error.longest`` is the longest allowed.
    DimensionError, NonFiniteError, MeshError, BeltramiError
        If f or the numbers are not valid, or all vertices are held.

    Notes
    -----
    Inside, the vertices are renumbered so that neighbours are near in memory; the result is in
    the order of f, with the same bits. Cost: O(k c p) after O(p) to renumber.

    Examples
    --------
    >>> from beltrami.mesh.topology import Topology
    >>> from beltrami.operators.laplacian import laplacian
    >>> triangle = laplacian(Topology([[0, 1, 2]]))
    >>> smooth(triangle, [4.0, 0.0, 0.0], steps=2).tolist()
    [2.0, 1.0, 1.0]
    """
    require_laplacian(laplacian, "averaging")
    values = as_function(f, laplacian.n)
    laplacian.require_non_negative("averaging")
    held = held_vertices(hold, laplacian.n)
    if not 0 <= steps < np.inf or steps != int(steps):
        raise BeltramiError(f"steps must be a whole number >= 0, not {steps}")
    if not step >= 0:
        raise BeltramiError(f"step must be >= 0, not {step}")
    if step > 1:
        longest = 2 / laplacian.spectral_bound(mass="degree")
        if step > longest * (1 + 1e-12):
            raise StepTooLongError(step, longest, "averaging", "Take a shorter one")
    rows = averaging_rows(laplacian, held, columns=values.size // laplacian.n)
    return average(rows, values, np.full(int(steps), float(step)), progress)


def averaging_rows(laplacian: Laplacian, held: Booleans, columns: int = 3) -> LocalRows:
    """Return the rows of W̃ = D⁻¹ W in an order kind to the caches; held ones are empty.

    For three columns and equal weights the shares are left out: there is less to load.
    """
    weights = laplacian.weights
    alone = held | (laplacian.degrees == 0)  # a vertex without neighbours keeps its value
    alike = laplacian.weight_kind == "combinatorial" and columns == 3
    shares = np.zeros(0) if alike else shares_of(weights)
    return local_rows(weights.indptr, weights.indices, shares, alone)


def average(rows: LocalRows, f: Floats, steps: Floats, progress: Progress | None = None) -> Floats:
    r"""Apply :math:`\prod_i ((1 - \delta_i) Id + \delta_i \tilde W)` to each column of f.

    A row that is empty leaves its value alone. Nothing is checked: ``smooth`` does that.
    """
    columns = f.reshape(len(f), -1)
    ordered = np.take(columns, rows.order, axis=0, mode="clip")  # clip: no test of the indices
    averaged = _averaged(rows, ordered, steps, progress)
    return np.take(averaged, rows.number, axis=0, mode="clip").reshape(f.shape)


def shares_of(weights: csr_array) -> Floats:
    """Return w_ij / Σ_j w_ij, entry by entry; 0 / 0 where a vertex has no weight is not used."""
    total = np.asarray(weights.sum(axis=1))
    with np.errstate(invalid="ignore"):
        return np.asarray(weights.data / np.repeat(total, np.diff(weights.indptr)))


def _averaged(rows: LocalRows, values: Floats, steps: Floats, progress: Progress | None) -> Floats:
    """Run the rounds, some at a time; three columns go side by side, others one by one."""
    triples = values.shape[1] == 3
    state = values if triples else np.ascontiguousarray(values.T)
    spare = np.empty_like(state)
    pattern = (rows.indptr, rows.indices)
    done = 0
    for rounds in stages(len(steps), progress, _ROUNDS_A_CALL):
        some = steps[done : done + rounds]
        done += rounds
        if not len(rows.data) and triples:
            swapped = _average_triples_alike(*pattern, state, spare, some)
        elif triples:
            swapped = _average_triples(*pattern, rows.data, state, spare, some)
        else:
            swapped = _average_columns(*pattern, rows.data, state, spare, some)
        if swapped:
            state, spare = spare, state
    return state if triples else np.ascontiguousarray(state.T)


@kernel
def _average_triples_alike(indptr: Any, indices: Any, x: Any, y: Any, steps: Any) -> bool:
    """Average three columns with equal weights; say whether the result is in y."""
    n = np.uint64(x.shape[0])
    one = np.uint64(1)
    for step in steps:
        previous, keep, share = np.uint64(0), 1.0, 0.0
        i = q = np.uint64(0)
        while i < n:
            end = np.uint64(indptr[i + one])
            if end - q != previous:  # seldom: rows of one degree come together
                previous = end - q
                keep, share = (1 - step, step / previous) if previous else (1.0, 0.0)
            a = b = c = 0.0
            while q < end:
                j = np.uint64(indices[q])
                a += x[j, 0]
                b += x[j, 1]
                c += x[j, 2]
                q += one
            y[i, 0] = keep * x[i, 0] + share * a
            y[i, 1] = keep * x[i, 1] + share * b
            y[i, 2] = keep * x[i, 2] + share * c
            i += one
        x, y = y, x
    return steps.size % 2 == 1


@kernel
def _average_triples(indptr: Any, indices: Any, shares: Any, x: Any, y: Any, steps: Any) -> bool:
    """Average three columns with the given shares; say whether the result is in y."""
    n = np.uint64(x.shape[0])
    one = np.uint64(1)
    for step in steps:
        i = q = np.uint64(0)
        while i < n:
            end = np.uint64(indptr[i + one])
            keep = 1.0 if q == end else 1 - step
            a = b = c = 0.0
            while q < end:
                j = np.uint64(indices[q])
                a += shares[q] * x[j, 0]
                b += shares[q] * x[j, 1]
                c += shares[q] * x[j, 2]
                q += one
            y[i, 0] = keep * x[i, 0] + step * a
            y[i, 1] = keep * x[i, 1] + step * b
            y[i, 2] = keep * x[i, 2] + step * c
            i += one
        x, y = y, x
    return steps.size % 2 == 1


@kernel
def _average_columns(indptr: Any, indices: Any, shares: Any, x: Any, y: Any, steps: Any) -> bool:
    """Average columns that lie one after the other (c, n); say whether the result is in y."""
    n = np.uint64(x.shape[1])
    one = np.uint64(1)
    for step in steps:
        for column in range(x.shape[0]):
            old, new = x[column], y[column]
            i = q = np.uint64(0)
            while i < n:
                end = np.uint64(indptr[i + one])
                keep = 1.0 if q == end else 1 - step
                total = 0.0
                while q < end:
                    total += shares[q] * old[np.uint64(indices[q])]
                    q += one
                new[i] = keep * old[i] + step * total
                i += one
        x, y = y, x
    return steps.size % 2 == 1
