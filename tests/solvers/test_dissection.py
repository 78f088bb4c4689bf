import numpy as np
import pytest
from hypothesis import given

from beltrami.errors import BeltramiError, DimensionError, NonFiniteError, UnknownNameError
from beltrami.solvers.dissection import dissect
from beltrami.solvers.elimination import GROUP, eliminate
from beltrami.solvers.factorize import factorize
from beltrami.solvers.ordering import as_positions, order
from definite_matrices import NAMED, arrow, as_columns, definite_matrices, grid


def _pattern(A):
    matrix = as_columns(A)
    return matrix.indptr.astype(np.int64), matrix.indices.astype(np.int32)


def _grid_positions(rows, columns):
    return np.array([[i, 1.01 * j, 0.0] for i in range(rows) for j in range(columns)])


def _check(A, dissection):
    """Each unknown once; entries join a block only to itself, its ancestors or descendants."""
    n = A.shape[0]
    assert sorted(dissection.order.tolist()) == list(range(n))
    assert dissection.starts[0] == 0
    assert dissection.starts[-1] == n
    assert (np.diff(dissection.starts) > 0).all()
    blocks = len(dissection.parents)
    own = np.arange(blocks)
    assert ((dissection.parents > own) | (dissection.parents == -1)).all()
    block = np.empty(n, np.int64)
    block[dissection.order] = np.repeat(own, np.diff(dissection.starts))
    above = [{i} for i in range(blocks)]
    for i in range(blocks - 1, -1, -1):
        if dissection.parents[i] >= 0:
            above[i] |= above[dissection.parents[i]]
    entries = A.tocoo()
    for i, j in zip(block[entries.row], block[entries.col], strict=True):
        assert j in above[i] or i in above[j]


@pytest.mark.parametrize("name", NAMED)
@pytest.mark.parametrize("leaf", [1, 5, 32])
def test_blocks_are_separated_by_their_ancestors(name, leaf):
    A = NAMED[name]()
    _check(A, dissect(*_pattern(A), None, leaf))
    positions = np.random.default_rng(137035).normal(size=(A.shape[0], 3))
    _check(A, dissect(*_pattern(A), positions, leaf))
    _check(A, dissect(*_pattern(A), np.zeros((A.shape[0], 3)), leaf))


@given(definite_matrices())
def test_blocks_of_drawn_matrices_are_separated(A):
    _check(A, dissect(*_pattern(A), None, 4))


@pytest.mark.parametrize("positions", [True, False])
def test_the_first_cut_of_a_grid_is_a_straight_line(positions):
    """The separator of a 20 x 60 grid is a column of 20, which may step aside once."""
    A = grid(20, 60)
    found = dissect(*_pattern(A), _grid_positions(20, 60) if positions else None)
    last = found.order[found.starts[-2] :]
    assert len(last) <= (20 if positions else 26)
    if positions:
        assert np.ptp(last % 60) <= 1
    sizes = found.starts[np.flatnonzero(found.parents == len(found.parents) - 1) + 1]
    assert len(sizes) >= 2


def test_a_hub_is_eliminated_last():
    found = dissect(*_pattern(arrow(150)), None)
    assert found.order[-1] == 0
    assert found.starts[-1] - found.starts[-2] == 1


@pytest.mark.parametrize("positions", [True, False])
def test_fill_grows_like_n_log_n(positions):
    fills = []
    for size in (32, 64, 128):
        A = as_columns(grid(size, size))
        found = order(A, _grid_positions(size, size) if positions else None, "auto")
        fills.append(found.entries / size**2)
    steps = np.diff(fills)
    assert (steps < 8).all()  # n^1.5 would double the fill of each unknown
    assert fills[-1] < 60


def _filled(A):
    """The oracle: eliminate one after the other, joining the later neighbours of each."""
    pattern = A.toarray() != 0
    for t in range(len(pattern)):
        later = np.flatnonzero(pattern[t + 1 :, t]) + t + 1
        pattern[np.ix_(later, later)] = True
    return np.tril(pattern)


@pytest.mark.parametrize("name", NAMED)
def test_the_panels_hold_what_elimination_fills(name):
    A = NAMED[name]()
    found = eliminate(*_pattern(A), dissect(*_pattern(A), None, 4))
    filled = _filled(A[found.order][:, found.order])
    for i in range(len(found.starts) - 1):
        first, last = found.starts[i], found.starts[i + 1]
        rows = found.rows[found.row_starts[i] : found.row_starts[i + 1]]
        assert (np.diff(rows) > 0).all()
        needed = np.flatnonzero(filled[last:, first:last].any(axis=1)) + last
        assert np.isin(needed, rows).all()
        assert (rows >= last).all()
        assert found.panels[i + 1] - found.panels[i] == (last - first) * (last - first + len(rows))
    assert (found.order[found.place] == np.arange(A.shape[0])).all()


def test_rows_are_only_those_that_dense_blocks_fill():
    """Not more: with blocks taken as dense, block elimination gives the same rows."""
    A = grid(9, 14)
    found = eliminate(*_pattern(A), dissect(*_pattern(A), None, 6))
    block = np.repeat(np.arange(len(found.starts) - 1), np.diff(found.starts))
    full = A[found.order][:, found.order].toarray() != 0
    for i in range(len(found.starts) - 1):
        mine = np.flatnonzero(block == i)
        full[np.ix_(mine, mine)] = True
        later = np.flatnonzero(full[mine].any(axis=0) & (block > i))
        full[np.ix_(later, later)] = True
        rows = found.rows[found.row_starts[i] : found.row_starts[i + 1]]
        assert rows.tolist() == later.tolist()


def test_positions_that_do_not_cut_are_not_used():
    A = as_columns(grid(60, 60))
    scrambled = np.random.default_rng(299792).normal(size=(3600, 3))
    bad, good = order(A, scrambled, "positions"), order(A, scrambled, "auto")
    assert good.entries == order(A, None, "graph").entries
    assert good.entries < bad.entries / 4
    near = _grid_positions(60, 60)
    assert (order(A, near, "auto").order == order(A, near, "positions").order).all()


def test_positions_of_every_dimension():
    rng = np.random.default_rng(31337)
    for d in (1, 2, 3, 6):
        x = as_positions(1e200 * rng.normal(size=(50, d)), 50)
        assert x.shape == (50, 3)
        assert np.isfinite(x @ x.T).all()
    flat = np.column_stack([rng.normal(size=(50, 3)), np.zeros((50, 2))])
    turned = flat @ np.linalg.qr(rng.normal(size=(5, 5)))[0]
    lengths = [np.linalg.norm(as_positions(x, 50), axis=1) for x in (flat, turned)]
    lengths = [one / one.max() for one in lengths]
    assert np.allclose(*lengths)  # three of the five axes hold everything


def test_what_is_refused():
    A = as_columns(grid(3, 3))
    for wrong in (np.zeros(9), np.zeros((9, 0)), np.zeros((8, 3))):
        with pytest.raises(DimensionError):
            factorize(A, wrong)
    with pytest.raises(NonFiniteError):
        factorize(A, np.full((9, 3), np.nan))
    with pytest.raises(BeltramiError, match="needs coordinates"):
        order(A, None, "positions")
    with pytest.raises(UnknownNameError):
        factorize(A, ordering="amd")


@pytest.mark.parametrize("name", NAMED)
def test_the_stack_holds_the_updates_that_wait(name):
    """Its height, by running the stack: a block pushes its update and removes its children's."""
    A = NAMED[name]()
    dissection = dissect(*_pattern(A), None, 4)
    found = eliminate(*_pattern(A), dissection)
    below = np.diff(found.row_starts)
    updates = below * (np.ceil(below / GROUP) * GROUP).astype(int)  # of whole groups of rows
    waiting, highest = {}, 0
    for i, update in enumerate(updates.tolist()):
        highest = max(highest, sum(waiting.values()) + update)
        waiting = {k: v for k, v in waiting.items() if dissection.parents[k] != i}
        waiting[i] = update
    assert found.stack == highest
