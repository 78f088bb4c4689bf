"""Theorem 9: the normalised spectrum lies in [0, 2] for w >= 0, in [0, 3) for cotangents (E62)."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import csr_array

import dense_oracles as oracle
from beltrami.mesh.mesh import Mesh
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import MESHES, flipped, triangle

pytestmark = pytest.mark.chapter("T9")


def _normalised(pair):
    return np.linalg.eigvalsh(pair.normalized.toarray())


def _cycle(n):
    A = np.eye(n, k=1) + np.eye(n, k=-1)
    A[0, -1] = A[-1, 0] = 1
    return A


def _face_bound(mesh):
    cosines = np.cos(oracle.angles(mesh)).prod(axis=1)
    return ((3 + np.sqrt(1 - 8 * cosines)) / 2).max()


@pytest.mark.parametrize("n", [3, 4, 7])
def test_complete_graphs(n):
    pair = laplacian(csr_array(1.0 - np.eye(n)))
    assert np.allclose(_normalised(pair)[1:], n / (n - 1))


def test_two_is_reached_by_bipartite_components_only():
    assert _normalised(laplacian(csr_array(_cycle(8))))[-1] == pytest.approx(2)
    assert _normalised(laplacian(csr_array(_cycle(9))))[-1] < 1.97
    both = np.zeros((7, 7))
    both[:3, :3], both[3:, 3:] = _cycle(3), _cycle(4)
    values = _normalised(laplacian(csr_array(both)))  # not two-colourable, and yet 2 (E63)
    assert values[-1] == pytest.approx(2)
    assert values[1] == pytest.approx(0, abs=1e-12)  # nor connected


def test_a_mesh_that_is_not_bipartite_reaches_two_where_cotangents_vanish():
    mesh = MESHES["pl"]()
    assert not mesh.topology.is_bipartite
    pair = laplacian(mesh, "cotangent", "degree")
    assert (np.abs(pair.edge_weight) < 1e-15).sum() == 42
    assert _normalised(pair)[-1] == pytest.approx(2)
    assert _normalised(laplacian(mesh, "combinatorial"))[-1] < 1.6


@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("kind", ["combinatorial", "distance"])
def test_positive_weights_of_a_mesh_stay_below_two(name, kind):
    pair = laplacian(MESHES[name](), kind)
    values = _normalised(pair)
    assert values[0] == pytest.approx(0, abs=1e-12)
    assert values[1] > 1e-4
    assert values[-1] - 1e-12 <= pair.spectral_bound() < 2


@pytest.mark.parametrize("name", ["obt", "bad"])
def test_negative_cotangents_leave_the_printed_interval(name):
    largest = _normalised(laplacian(MESHES[name]()))[-1]
    assert 2.1 < largest <= _face_bound(MESHES[name]()) < 3


@pytest.mark.parametrize("name", MESHES)
def test_the_bound_of_the_library_is_that_of_the_faces(name):
    mesh = MESHES[name]()
    bound = laplacian(mesh, mass="degree").spectral_bound()
    assert bound == pytest.approx(_face_bound(mesh), rel=1e-9)
    obtuse = (oracle.angles(mesh) > np.pi / 2 + 1e-9).any()
    assert (bound > 2 + 1e-9) == obtuse


@pytest.mark.parametrize(
    ("angles", "value"), [((60, 60), 1.5), ((45, 90), 2.0), ((15, 150), 2.8660), ((1, 178), 2.9994)]
)
def test_equality_for_a_single_face(angles, value):
    mesh = triangle(*angles)
    assert _normalised(laplacian(mesh))[-1] == pytest.approx(value, abs=5e-5)
    assert laplacian(mesh, mass="degree").spectral_bound() == pytest.approx(value, abs=5e-5)


def test_the_flat_tetrahedron_of_the_errata():
    x = [[0, 0, 0], [4, 0, 0], [2, 0.3, 0], [2, -0.3, 0.05]]
    mesh = Mesh(x, [[0, 1, 2], [0, 3, 1], [1, 3, 2], [0, 2, 3]])
    pair = laplacian(mesh)
    text = [-6.4703, 6.8182, 6.7254, 6.8182, 6.7254, 6.4937]  # with the constant of the text
    assert np.allclose(2 * pair.edge_weight, text, atol=1e-4)
    assert np.allclose(2 * pair.degrees, [7.0734, 7.0734, 20.13, 19.945], atol=1e-3)
    assert np.allclose(_normalised(pair), [0, 0.0853, 1.3241, 2.5907], atol=1e-4)
    assert _normalised(laplacian(mesh, "combinatorial"))[-1] == pytest.approx(4 / 3)


@settings(deadline=None, max_examples=40)
@given(st.integers(0, 2**40), st.floats(0.02, 1))
def test_always_below_three_and_the_degrees_positive(seed, aspect):
    pair = laplacian(flipped(seed, n=25, aspect=aspect), mass="degree")
    assert (pair.degrees > 0).all()  # S1: whatever the signs
    assert _normalised(pair)[-1] <= pair.spectral_bound() * (1 + 1e-9)
    assert pair.spectral_bound() < 3
