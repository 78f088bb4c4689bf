import numpy as np
import pytest

from beltrami.mesh.mesh import Mesh
from beltrami.operators import face_parts
from beltrami.operators.accumulate import accumulate
from beltrami.operators.areas import AREA_KINDS, vertex_areas
from meshes_of_the_errata import MESHES


@pytest.fixture(params=MESHES)
def mesh(request):
    return MESHES[request.param]()


def test_the_kernel_measures_what_a_few_lines_of_numpy_do(mesh):
    x = mesh.vertices[mesh.faces]
    u, v, w = x[:, 1] - x[:, 0], x[:, 2] - x[:, 1], x[:, 0] - x[:, 2]
    dots = -np.stack([(u * w).sum(1), (u * v).sum(1), (v * w).sum(1)], axis=1)
    numbers = face_parts.face_numbers(mesh)
    np.testing.assert_allclose(numbers.dots, dots, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(numbers.areas, mesh.face_areas, rtol=1e-12)
    cotangents = 1 / np.tan(mesh.corner_angles)
    np.testing.assert_allclose(2 * numbers.half_cotangents, cotangents, rtol=1e-9, atol=1e-9)


def test_the_parts_of_the_faces_add_to_weights_and_areas(mesh):
    numbers = face_parts.face_numbers(mesh)
    sides, faces, n = numbers.half_cotangents, mesh.faces, mesh.n_vertices

    def summed(parts):
        return np.bincount(faces.ravel(), parts.ravel(), n)

    weights = np.bincount(mesh.topology.face_edges.ravel(), sides.ravel())
    np.testing.assert_allclose(weights, accumulate(mesh, True, -1)[0], rtol=1e-12, atol=1e-12)
    for kind in AREA_KINDS:
        parts = face_parts.split_masses(kind, sides, faces, n, numbers)
        np.testing.assert_allclose(summed(parts), vertex_areas(mesh, kind), rtol=1e-12)
    degrees = np.bincount(mesh.edges.ravel(), np.repeat(weights, 2), n)
    parts = face_parts.split_masses("degree", sides, faces, n)
    np.testing.assert_allclose(summed(parts), degrees, rtol=1e-9)
    ones = face_parts.split_masses("unit", sides, faces, n)
    np.testing.assert_allclose(summed(ones), 1, rtol=1e-12)


def test_the_consistent_mass_has_the_eigenvalues_of_its_matrix():
    mesh = Mesh([[0, 0], [3, 0], [1, 2]], [[0, 1, 2]])
    numbers = face_parts.face_numbers(mesh)
    sides = numbers.half_cotangents
    (b,) = face_parts.split_masses("consistent", sides, mesh.faces, 3, numbers)
    (u, v, w) = sides[0]
    L = np.array([[v + w, -w, -v], [-w, w + u, -u], [-v, -u, u + v]])
    full = mesh.area / 12 * (np.ones((3, 3)) + np.eye(3))
    top = [np.linalg.eigvals(np.linalg.solve(B, L)).real.max() for B in (full, np.diag(b))]
    assert top[0] == pytest.approx(top[1], rel=1e-12)


@pytest.mark.parametrize("unit", [1e-60, 1e-9, 1e9, 1e60])
def test_any_unit_of_length(unit):
    mesh = MESHES["open"]()
    there = mesh.with_vertices(mesh.vertices * unit)
    numbers = face_parts.face_numbers(there)
    usual = face_parts.face_numbers(mesh)
    np.testing.assert_allclose(numbers.half_cotangents, usual.half_cotangents, rtol=1e-6, atol=1e-6)
    np.testing.assert_allclose(numbers.areas, usual.areas * unit**2, rtol=1e-9)
