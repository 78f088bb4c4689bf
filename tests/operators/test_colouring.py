import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.sparse import csr_array

import strategies
from beltrami.errors import DimensionError, MeshError
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import icosphere, tetrahedron, torus
from beltrami.operators.colouring import colouring
from beltrami.operators.weights import edge_weights
from meshes_of_the_errata import MESHES

pytestmark = pytest.mark.chapter("D18")


def _cycle(n):
    A = np.eye(n, k=1)
    A[0, -1] = 1
    return csr_array(A + A.T)


def _proper(colours, edges):
    i, j = edges.T
    return (colours[i] != colours[j]).all() and colours.min() == 0


@pytest.mark.parametrize("n", [4, 6, 16, 3, 5, 17])
def test_cycles(n):
    colours = colouring(_cycle(n))
    assert _proper(colours, np.stack(_cycle(n).nonzero(), axis=1))
    assert colours.max() + 1 == (2 if n % 2 == 0 else 3)


@pytest.mark.parametrize("name", MESHES)
def test_meshes_need_three_at_least_and_these_six_at_most(name):
    mesh = MESHES[name]()
    colours = colouring(mesh)
    assert _proper(colours, mesh.edges)
    assert 3 <= colours.max() + 1 <= (7 if name == "tor" else 6)  # E63; planar, or on a torus
    assert np.array_equal(colours, colouring(mesh.topology))
    assert np.array_equal(colours, colouring(edge_weights(mesh, "combinatorial")))


@given(strategies.any_meshes())
def test_any_mesh(mesh):
    colours = colouring(mesh)
    assert colours.shape == (mesh.n_vertices,)
    if len(mesh.edges):
        assert _proper(colours, mesh.edges)
        degrees = np.bincount(mesh.edges.ravel())
        assert colours.max() <= degrees.max()


@given(st.integers(0, 2**40))
def test_two_colours_wherever_they_suffice(seed):
    rng = np.random.default_rng(seed)
    side = rng.integers(2, size=12)
    A = (rng.uniform(size=(12, 12)) < 0.3) & (side[:, None] != side)
    A = np.triu(A | A.T, 1)
    colours = colouring(csr_array((A | A.T).astype(float)))
    assert colours.max() + 1 == (2 if A.any() else 1)
    assert not A.any() or _proper(colours, np.argwhere(A))


def test_the_tetrahedron_and_larger_complete_graphs():
    assert sorted(colouring(tetrahedron())) == [0, 1, 2, 3]
    for n in (5, 9):
        assert sorted(colouring(csr_array(1 - np.eye(n)))) == list(range(n))


def test_smallest_last_and_not_any_order():
    """On a crown without some edges first-come colouring needs n/2 colours; this order needs 3."""
    n = 8
    A = np.zeros((2 * n + 2, 2 * n + 2))
    for k in range(n):
        for m in range(n):
            if k != m:
                A[2 * k, 2 * m + 1] = A[2 * m + 1, 2 * k] = 1
    A[-3:, -3:] = 1 - np.eye(3)  # a triangle: two colours do not suffice
    colours = colouring(csr_array(A))
    assert _proper(colours, np.argwhere(A))
    first_come = np.full(len(A), -1)
    for v in range(len(A)):
        seen = set(first_come[A[v] > 0])
        first_come[v] = next(c for c in range(len(A)) if c not in seen)
    assert first_come.max() + 1 == n
    assert colours.max() + 1 == 3


@pytest.mark.parametrize("mesh", [icosphere(4), torus(60, 30)], ids=["sphere", "torus"])
def test_larger_ones(mesh):
    colours = colouring(mesh)
    assert _proper(colours, mesh.edges)
    assert colours.max() + 1 <= 6


def test_zeros_and_the_diagonal_are_no_edges():
    A = csr_array(([1.0, 0, 1, 5], ([0, 1, 1, 2], [1, 2, 0, 2])), shape=(3, 3))
    assert colouring(A).tolist() == [0, 1, 0]
    assert colouring(csr_array((3, 3))).tolist() == [0, 0, 0]
    assert colouring(Mesh(np.zeros((4, 3)), np.zeros((0, 3), int))).tolist() == [0] * 4


def test_what_is_no_graph():
    with pytest.raises(MeshError, match="symmetric"):
        colouring(csr_array([[0, 1.0], [0, 0]]))
    with pytest.raises(MeshError, match="square"):
        colouring(csr_array((2, 3)))
    for other in (np.eye(3), "graph", None):
        with pytest.raises(DimensionError, match="no graph"):
            colouring(other)
