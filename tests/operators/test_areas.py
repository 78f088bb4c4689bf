import numpy as np
import pytest

import dense_oracles as oracle
from beltrami.errors import (
    DegenerateFaceError,
    EmptyMeshError,
    NonFiniteError,
    UnknownNameError,
)
from beltrami.mesh.mesh import Mesh
from beltrami.operators.areas import (
    AREA_KINDS,
    consistent_mass,
    diagonal_matrix,
    vertex_areas,
)
from meshes_of_the_errata import MESHES, triangle


@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("kind", AREA_KINDS)
def test_against_loops_over_angles(name, kind):
    mesh = MESHES[name]()
    areas = vertex_areas(mesh, kind)
    expected = np.diag(oracle.masses(mesh, kind, np.zeros((mesh.n_vertices,) * 2)))
    assert np.allclose(areas, expected, rtol=1e-8, atol=1e-9 * np.abs(expected).max())
    assert areas.sum() == pytest.approx(mesh.area, rel=1e-10)
    assert kind == "circumcentric" or (areas > 0).all()


def test_the_default_is_never_negative():
    mesh = triangle(15, 150)
    assert np.array_equal(vertex_areas(mesh), vertex_areas(mesh, "voronoi"))
    assert vertex_areas(mesh, "circumcentric").min() < 0  # S4 of the errata


def test_signed_areas_of_the_triangle_of_the_errata():
    mesh = triangle(15, 150)
    scaled = mesh.with_vertices(mesh.vertices * np.sqrt(0.25 / mesh.area))
    assert np.allclose(vertex_areas(scaled, "circumcentric"), [-0.3415, 0.933, -0.3415], atol=1e-4)


@pytest.mark.parametrize("kind", AREA_KINDS)
@pytest.mark.parametrize("unit", [1e-9, 1e9])
def test_areas_have_the_unit_squared(kind, unit):
    mesh = MESHES["obt"]()
    other = mesh.with_vertices(unit * mesh.vertices)
    assert np.allclose(vertex_areas(other, kind) / unit**2, vertex_areas(mesh, kind), rtol=1e-8)


@pytest.mark.parametrize("name", MESHES)
def test_consistent_mass_integrates_products_of_linear_functions(name):
    mesh = MESHES[name]()
    B = consistent_mass(mesh)
    expected = oracle.masses(mesh, "consistent", None)
    assert np.allclose(B.toarray(), expected, rtol=1e-9, atol=1e-12 * expected.max())
    f, g = oracle.rough_functions(mesh, 2).T
    middle = lambda h: (h[mesh.faces] + np.roll(h[mesh.faces], 1, axis=1)) / 2  # noqa: E731
    exact = mesh.face_areas @ (middle(f) * middle(g)).mean(axis=1)  # Simpson: exact for quadratics
    assert f @ (B @ g) == pytest.approx(exact, rel=1e-9)
    assert B.sum() == pytest.approx(mesh.area)


def test_diagonal_matrix():
    values = np.array([3.0, 0.0, -2.0])
    assert np.array_equal(diagonal_matrix(values).toarray(), np.diag(values))


def test_a_vertex_of_no_face_has_no_area():
    assert vertex_areas(Mesh([[0, 0], [5, 5], [1, 0], [0, 1]], [[0, 2, 3]])).tolist()[1] == 0


def test_errors():
    mesh = triangle(60, 60)
    with pytest.raises(UnknownNameError, match="Did you mean 'voronoi'") as caught:
        vertex_areas(mesh, "voronoy")
    assert set(caught.value.choices) == {"barycentric", "voronoi", "circumcentric"}
    with pytest.raises(EmptyMeshError):
        vertex_areas(Mesh(mesh.vertices, []))
    with pytest.raises(NonFiniteError) as bad:
        vertex_areas(mesh.with_vertices([[0, 0], [1, np.nan], [0, 1]]))
    assert bad.value.vertices.tolist() == [1]
    flat = Mesh([[0, 0], [1, 0], [0, 1], [2, 0]], [[0, 1, 2], [0, 1, 3]])
    for refused in (vertex_areas, consistent_mass):
        with pytest.raises(DegenerateFaceError) as guilty:
            refused(flat)
        assert guilty.value.faces.tolist() == [1]
