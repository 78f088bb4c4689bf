import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.sparse import csr_array

import beltrami as bt
import strategies
from beltrami.errors import BeltramiError, DimensionError, NonFiniteError, UnknownNameError

PATH = csr_array(np.eye(7, k=1) + np.eye(7, k=-1))


def _path(f, kind):
    return bt.nodal_domains(bt.laplacian(PATH), f, kind)


@pytest.mark.parametrize(
    ("f", "strong", "weak"),
    [
        ([1, 1, 1, 1, 1, 1, 1], 1, 1),
        ([1, 1, -1, -1, 1, 1, 1], 3, 3),
        ([1, 0, 1, 0, -1, 0, -1], 4, 2),  # zeros join what they separate
        ([1, 0, -1, 0, 1, 0, -1], 4, 4),
        ([0, 0, 0, 1, 0, 0, 0], 1, 1),  # parts of zeros alone are none
        ([0, 0, 0, 0, 0, 0, 0], 0, 0),
        ([-1, 0, 0, 0, 0, 0, -1], 2, 1),
    ],
)
def test_of_a_path(f, strong, weak):
    assert _path(f, "strong").count == strong
    assert _path(f, "weak").count == weak


def test_labels():
    strong = _path([1, 0, -1, 0, -1, 1, 1], "strong")
    assert strong.positive.tolist() == [0, -1, -1, -1, -1, 1, 1]
    assert strong.negative.tolist() == [-1, -1, 2, -1, 3, -1, -1]
    weak = _path([1, 0, -1, 0, -1, 1, 1], "weak")
    assert weak.positive.tolist() == [0, 0, -1, -1, -1, 1, 1]  # vertex 3 is zero among negatives
    assert weak.negative.tolist() == [-1, 2, 2, 2, 2, -1, -1]
    assert repr(weak) == "<NodalDomains: 3 weak ones of 7 vertices>"


def test_what_counts_as_zero_is_relative():
    f = np.array([1, 1e-8, -1e-12, 1, -1, 0, 0])
    for scale in (1e-200, 1, 1e200):
        assert _path(scale * f, "strong").count == 3
        pair = bt.laplacian(PATH)
        assert bt.nodal_domains(pair, scale * f, zero=0).count == 4
        assert bt.nodal_domains(pair, scale * f, zero=0).positive[2] == -1
        assert bt.nodal_domains(pair, scale * f, zero=1e-7).positive[1] == -1
    assert bt.nodal_domains(bt.laplacian(PATH), [0] * 6 + [5e-324]).count == 1


def test_edges_without_a_weight_do_not_join():
    """Opposite right angles cotangents vanish: the diagonals of the squares are no edges."""
    mesh = bt.shapes.grid(2, 2)
    f = np.zeros(9)
    f[[0, 4]] = 1  # along a diagonal
    f[f == 0] = -1
    assert bt.nodal_domains(mesh, f).count == 2 == bt.nodal_domains(mesh.topology, f).count
    weights = bt.laplacian(mesh, lambda m: (np.ptp(m.edges, axis=1) != 4).astype(float))
    assert bt.nodal_domains(weights, f).count == 3


@given(strategies.closed_meshes(), strategies.generators(), st.sampled_from(["strong", "weak"]))
def test_against_a_search_by_depth(mesh, rng, kind):
    f = rng.integers(-1, 2, mesh.n_vertices).astype(float)
    found = bt.nodal_domains(mesh, f, kind)
    near = [set() for _ in f]
    for i, j in mesh.edges.tolist():
        near[i].add(j)
        near[j].add(i)
    count = 0
    for sign, labels in ((1, found.positive), (-1, found.negative)):
        inside = f * sign > 0 if kind == "strong" else f * sign >= 0
        left = set(np.flatnonzero(inside).tolist())
        while left:
            part, todo = set(), [left.pop()]
            while todo:
                i = todo.pop()
                part.add(i)
                todo += near[i] & left
                left -= near[i]
            one = {labels[i] for i in part}
            assert len(one) == 1
            has = any(f[i] for i in part)
            count += has
            assert (one != {-1}) == has
            assert (labels == one.pop()).sum() == len(part) or not has
        assert (labels[~inside] == -1).all()
    assert found.count == count


def test_bad_input():
    mesh = bt.shapes.icosphere(1)
    f = mesh.vertices[:, 0]
    with pytest.raises(UnknownNameError, match="strong"):
        bt.nodal_domains(mesh, f, "stron")
    with pytest.raises(DimensionError, match="one function"):
        bt.nodal_domains(mesh, mesh.vertices)
    with pytest.raises(DimensionError):
        bt.nodal_domains(mesh, f[1:])
    with pytest.raises(DimensionError, match="laplacian"):
        bt.nodal_domains(PATH, np.ones(7))
    with pytest.raises(NonFiniteError):
        bt.nodal_domains(mesh, np.full(42, np.inf))
    for zero in (-1, 1, np.nan, "0", None):
        with pytest.raises(BeltramiError, match="part of the largest"):
            bt.nodal_domains(mesh, f, zero=zero)
    assert bt.nodal_domains(bt.Mesh(np.zeros((0, 3)), np.zeros((0, 3), int)), []).count == 0
