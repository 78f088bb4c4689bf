"""Flips: the four numbers of two triangles, and the tables, against positions in the plane."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltrami.mesh.mesh import Mesh
from beltrami.operators import flips
from beltrami.operators.face_parts import face_numbers
from meshes_of_the_errata import flipped


def _numbers(p):
    """Dot products at the corners and twice the area, of one triangle of points in the plane."""
    u, v, w = p[1] - p[0], p[2] - p[1], p[0] - p[2]
    return [-u @ w, -u @ v, -v @ w], abs(u[0] * w[1] - u[1] * w[0])


def _two_faces(a, b, p, q, c, d):
    """The faces (A, P, Q) and (B, Q, P), beginning c and d corners later."""
    dots, double = np.empty((2, 3)), np.empty(2)
    for f, (points, turn) in enumerate((((a, p, q), c), ((b, q, p), d))):
        at, double[f] = _numbers(points)
        dots[f] = np.roll(at, turn)
    return dots, double


@given(st.integers(0, 2**40))
def test_the_numbers_of_a_flip_are_those_of_the_other_diagonal(seed):
    rng = np.random.default_rng(seed)
    p, q = rng.normal(size=(2, 2))
    middle = p + (q - p) * rng.uniform(0.2, 0.8)
    across = np.array([p[1] - q[1], q[0] - p[0]])
    along = rng.uniform(-0.1, 0.1, 2)
    a = middle + rng.uniform(0.2, 2) * across + along[0] * (q - p)
    b = middle - rng.uniform(0.2, 2) * across + along[1] * (q - p)
    c, d = rng.integers(3, size=2)
    dots, double = _two_faces(a, b, p, q, c, d)
    assert flips.flip_numbers(dots, double, int(c), 3 + int(d))
    for f, points, turn in ((0, (a, p, b), c), (1, (b, q, a), d)):
        at, area = _numbers(points)
        assert np.allclose(dots[f], np.roll(at, turn), rtol=1e-9, atol=1e-11)
        assert double[f] == pytest.approx(area, rel=1e-9)


def test_a_flip_out_of_the_quadrilateral_is_refused_and_changes_nothing():
    a, b, p, q = np.array([[0.5, 1], [3, -0.1], [0, 0], [1, 0.0]])  # reflex at q
    dots, double = _two_faces(a, b, p, q, 0, 0)
    before = dots.copy(), double.copy()
    assert not flips.flip_numbers(dots, double, 0, 3)
    assert np.array_equal(dots, before[0])
    assert np.array_equal(double, before[1])


def test_an_edge_that_rounding_left_without_length_is_not_flipped():
    dots, double = np.array([[1.0, 0, 0], [1.0, 0, 0]]), np.ones(2)
    before = dots.copy()
    assert not flips.flip_numbers(dots, double, 0, 3)
    assert np.array_equal(dots, before)


def test_an_edge_that_can_not_be_flipped_in_the_end_is_told():
    square = Mesh([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1, 2], [0, 2, 3]])
    faces, twins, sides, dots, double = _state(square)
    dots[:] = [[0, 1, 0], [0, 0, 1]]  # the side that they share has no length, and yet faces
    dots[0, 1], dots[1, 2] = -1.0, -1.0  # angles of more than π together
    dots[0, [0, 2]], dots[1, [0, 1]] = 0.0, 0.0
    assert flips.flip_to_delaunay(faces, twins, sides, dots, double, 5, 100) == -2


@pytest.mark.parametrize(("height", "delaunay"), [(1.01, True), (1.0, True), (0.99, False)])
def test_delaunay_is_the_empty_circle(height, delaunay):
    p, q, a, b = np.array([[-1, 0], [1, 0], [0, 1], [0, -height]])  # on the circle at height 1
    dots, double = _two_faces(a, b, p, q, 0, 0)
    assert flips.is_delaunay(dots, double, 0, 3) is delaunay


def test_rounding_is_measured_beside_the_terms():
    dots = np.array([[1e6, 0, 0], [-1e6 - 1e-9, 0, 0]])  # terms of 1e6 are off by 1e-10
    assert flips.is_delaunay(dots, np.ones(2), 0, 3)
    dots[1, 0] = -1e6 - 1e-6
    assert not flips.is_delaunay(dots, np.ones(2), 0, 3)


def _state(mesh):
    topology = mesh.topology
    dots, double, _ = face_numbers(mesh)
    tables = topology.faces.copy(), topology.twins.copy(), topology.face_edges.copy()
    return *tables, dots, double


@pytest.mark.parametrize("seed", range(6))
def test_in_the_plane_the_tables_stay_those_of_a_mesh_with_these_positions(seed):
    mesh = flipped(seed)
    faces, twins, sides, dots, double = _state(mesh)
    p = mesh.topology.n_edges
    count = flips.flip_to_delaunay(faces, twins, sides, dots, double, p, 10**6)
    assert count > 0
    after = Mesh(mesh.vertices, faces)
    assert np.array_equal(after.topology.twins, twins)
    assert after.is_oriented
    ends = np.sort(np.stack([np.roll(faces, -1, 1), np.roll(faces, -2, 1)], axis=2), axis=2)
    of_edge = {}
    for number, pair in zip(sides.ravel(), ends.reshape(-1, 2).tolist(), strict=True):
        assert of_edge.setdefault(int(number), pair) == pair
    assert sorted(of_edge) == list(range(p))
    again = _state(after)
    assert np.allclose(again[3], dots, atol=1e-12)
    assert np.allclose(again[4], double, atol=1e-13)


def test_it_gives_up_after_so_many_flips():
    mesh = flipped(0)
    p = mesh.topology.n_edges
    needed = flips.flip_to_delaunay(*_state(mesh), p, 10**6)
    assert flips.flip_to_delaunay(*_state(mesh), p, needed) == needed
    assert flips.flip_to_delaunay(*_state(mesh), p, needed - 1) == -1


def test_two_sides_that_move_and_are_glued_to_each_other():
    """The sphere of two faces (A, P, Q), (B, Q, P) with QA glued to PB, so A and P are one."""
    faces = np.array([[0, 1, 2], [2, 2, 1]])
    twins = np.array([[3, 4, 5], [0, 1, 2]], dtype=np.int32).ravel()
    sides = np.array([[0, 1, 2], [0, 1, 2]], dtype=np.int32)
    half_edge = np.array([0, 1, 2])
    flips.flip_tables(faces, twins, sides, half_edge, 0, 3)
    assert (twins[twins] == np.arange(6)).all()
    assert (twins[0], twins[1], twins[2]) == (3, 4, 5)
    assert sides.tolist() == [[1, 0, 2], [1, 0, 2]]
    assert half_edge[1] in (0, 3)
    assert half_edge[0] in (1, 4)
