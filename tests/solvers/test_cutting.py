"""Cuts along a key, and their refinement, against the pattern as a dense matrix."""

import numpy as np
import pytest

from beltrami.solvers.cutting import PLACES, cut
from beltrami.solvers.dissection import dissect
from beltrami.solvers.refinement import refine
from definite_matrices import NAMED, arrow, as_columns, grid


def _cut(A, key, mine=5):
    matrix = as_columns(A)
    n = A.shape[0]
    pattern = matrix.indptr.astype(np.uint64), matrix.indices.astype(np.uint32)
    owner = np.full(n, mine)
    cut(
        *pattern, np.arange(n).astype(np.uint64), 0, n, owner, mine,
        np.asarray(key, float).copy(), np.empty((n, 2)), np.empty((PLACES, 3), np.int64),
    )  # fmt: skip
    return pattern, owner


def _refined(pattern, owner, mine=5):
    n = len(owner)
    owner, state = owner.copy(), np.zeros(n, np.int8)
    sizes = np.bincount(owner - mine, minlength=3)
    found = np.empty(n, np.uint64)
    found[: sizes[2]] = np.flatnonzero(owner == mine + 2)
    refine(
        *pattern, owner, mine, sizes, found, np.empty((n, 2), np.int64), state,
        np.empty(n, np.uint64), np.empty(n, np.int64),
    )  # fmt: skip
    assert sizes.tolist() == np.bincount(owner - mine, minlength=3).tolist()
    assert sorted(found[: sizes[2]].tolist()) == np.flatnonzero(owner == mine + 2).tolist()
    assert not state.any()
    return owner


def _separated(A, owner):
    dense = A.toarray() != 0
    return not dense[np.ix_(owner == 5, owner == 6)].any()


def _thinnest(A, key):
    """The oracle for distinct whole keys: try every place, and both sides of it."""
    dense, n = A.toarray() != 0, len(key)
    best = np.inf
    for place in range(n - 1):
        before = key <= place
        crossing = dense[np.ix_(before, ~before)]
        left, right = crossing.any(axis=1).sum(), crossing.any(axis=0).sum()
        a, b = before.sum(), (~before).sum()
        for s, a, b in ((left, a - left, b), (right, a, b - right)):  # noqa: B020
            if min(a, b) > 0 and min(a, b) >= 0.25 * (a + b):
                best = min(best, s * (1 + 0.5 * ((a - b) / (a + b)) ** 2))
    return best


@pytest.mark.parametrize("name", NAMED)
@pytest.mark.parametrize("keys", ["drawn", "equal", "far"])
def test_sides_are_separated_before_and_after(name, keys):
    A = NAMED[name]()
    n = A.shape[0]
    key = np.random.default_rng(602214).normal(size=n)
    key = {"drawn": key, "equal": np.zeros(n), "far": np.r_[1e300, key[1:]]}[keys]
    pattern, owner = _cut(A, key)
    assert _separated(A, owner)
    better = _refined(pattern, owner)
    assert _separated(A, better)
    assert (better == 7).sum() <= (owner == 7).sum()
    if min((owner == 5).sum(), (owner == 6).sum()) > 0:
        assert min((better == 5).sum(), (better == 6).sum()) > 0


def test_the_thinnest_place_is_taken():
    """Two squares with a narrow bridge, off the middle: the bridge is cut."""
    A = grid(7, 4).tolil()
    for i in (2, 3):  # rows 2 and 3 keep one vertex of four
        for j in range(1, 4):
            A[4 * i + j, :] = 0
            A[:, 4 * i + j] = 0
            A[4 * i + j, 4 * i + j] = 1
    A = A.tocsr()
    A.eliminate_zeros()
    _, owner = _cut(A, np.arange(28))
    assert (owner == 7).sum() == 1


def test_every_place_is_tried_where_there_are_enough():
    rng = np.random.default_rng(662607)
    for n in (5, 12, 30):
        A = as_columns(NAMED["scattered"]())[:n][:, :n]
        key = rng.permutation(n)
        _, owner = _cut(A, key)
        a, b, s = (int((owner == one).sum()) for one in (5, 6, 7))
        expected = _thinnest(A, key)
        if np.isfinite(expected):
            assert s * (1 + 0.5 * ((a - b) / (a + b)) ** 2) == pytest.approx(expected)


def test_refinement_straightens_a_crooked_cut():
    """Of a grid of 12 x 30 a zigzag through 18 vertices becomes a column of 12."""
    A = grid(12, 30)
    column = np.arange(360) % 30
    row = np.arange(360) // 30
    line = 14 + row % 2 * 2
    owner = np.where(column < line, 5, 6)
    crossing = (A.toarray() != 0)[:, owner == 6].any(axis=1) & (owner == 5)
    owner[crossing] = 7
    assert crossing.sum() > 16
    matrix = as_columns(A)
    pattern = matrix.indptr.astype(np.uint64), matrix.indices.astype(np.uint32)
    better = _refined(pattern, owner)
    assert (better == 7).sum() == 12
    assert _separated(A, better)


def test_a_hub_alone_is_the_separator():
    _, owner = _cut(arrow(150), np.r_[0.3, np.linspace(0, 1, 149)])
    assert np.flatnonzero(owner == 7).tolist() == [0]


def test_the_larger_half_comes_first():
    """Its updates need more room than the one that waits for it."""
    A = as_columns(grid(40, 40))
    found = dissect(A.indptr.astype(np.int64), A.indices.astype(np.int32), None, 16)
    size = np.diff(found.starts).astype(float)
    for i in range(len(size)):
        if found.parents[i] >= 0:
            size[found.parents[i]] += size[i]
    top = len(size) - 1
    halves = [i for i in range(top) if found.parents[i] == top]
    assert len(halves) == 2
    assert size[halves[0]] >= size[halves[1]]
