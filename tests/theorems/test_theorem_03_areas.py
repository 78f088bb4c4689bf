"""Theorem 3: areas of cells, with its constant corrected (E22, E23, E24, E30)."""

import numpy as np
import pytest

import dense_oracles as oracle
from beltrami.operators.areas import vertex_areas
from beltrami.operators.laplacian import laplacian
from beltrami.operators.weights import weigh_edges
from meshes_of_the_errata import MESHES
from voronoi_oracle import clipped_cells


def _printed(mesh):
    """A_i = Σ_j A_ij / 2 with A_ij = |e|² (cot α + cot β) / 2, as printed."""
    cells = mesh.edge_lengths**2 * 2 * weigh_edges(mesh, "cotangent") / 2
    return np.bincount(mesh.edges.ravel(), np.repeat(cells, 2), mesh.n_vertices) / 2


@pytest.mark.chapter("D10", "T3")
@pytest.mark.parametrize("name", MESHES)
def test_the_sum_of_the_printed_areas_is_twice_the_area(name):
    mesh = MESHES[name]()
    assert _printed(mesh).sum() == pytest.approx(2 * mesh.area)
    for kind in ("barycentric", "voronoi", "circumcentric"):
        assert vertex_areas(mesh, kind).sum() == pytest.approx(mesh.area)
    assert np.allclose(vertex_areas(mesh, "circumcentric"), _printed(mesh) / 2, atol=1e-10)


@pytest.mark.chapter("D10", "T3")
def test_single_cells_of_a_planar_delaunay_mesh_against_geometry():
    mesh = MESHES["open"]()
    cells, exact = clipped_cells(mesh.vertices)
    assert len(cells) > 100
    assert np.allclose(vertex_areas(mesh, "circumcentric")[cells], exact, rtol=1e-9)
    assert np.allclose(_printed(mesh)[cells], 2 * exact, rtol=1e-9)
    mixed = np.abs(vertex_areas(mesh, "voronoi")[cells] / exact - 1)
    assert mixed.max() > 0.05  # cut at obtuse angles: positive, and no longer the exact cells


@pytest.mark.chapter("D10", "T3")
def test_of_a_mesh_that_is_not_delaunay_only_the_total_is_right():
    mesh = MESHES["bad"]()
    cells, exact = clipped_cells(mesh.vertices)
    ratio = vertex_areas(mesh, "circumcentric")[cells] / exact
    assert ratio.min() < 0
    assert ratio.max() > 2


@pytest.mark.chapter("D10")
@pytest.mark.parametrize("name", ["obt", "bad"])
def test_signed_areas_may_be_negative_and_the_default_is_not(name):
    mesh = MESHES[name]()
    assert (vertex_areas(mesh, "circumcentric") < 0).sum() > 30
    assert vertex_areas(mesh).min() > 0
    assert laplacian(mesh).masses.min() > 0


@pytest.mark.chapter("U14")
def test_what_integrates_linear_functions_exactly():
    mesh = MESHES["open"]()
    x = mesh.vertices[:, 0]
    assert vertex_areas(mesh, "barycentric") @ x == pytest.approx(0.5, abs=1e-13)
    for kind in ("circumcentric", "voronoi"):  # the signed ones do if the boundary is regular
        assert 1e-6 < abs(vertex_areas(mesh, kind) @ x - 0.5) < 1e-2
    assert _printed(mesh) @ x == pytest.approx(1.0, abs=0.01)


@pytest.mark.chapter("U14")
def test_quadrature_of_a_smooth_function():
    mesh = MESHES["open"]()
    x, y = mesh.vertices.T
    f, exact = np.exp(x) * np.cos(y), (np.e - 1) * np.sin(1)
    for kind in ("barycentric", "voronoi", "circumcentric"):
        assert vertex_areas(mesh, kind) @ f == pytest.approx(exact, rel=3e-3)
    assert _printed(mesh) @ f == pytest.approx(2 * exact, rel=3e-3)


@pytest.mark.chapter("T3", "P35")
def test_a_mesh_inscribed_in_the_sphere():
    """<L x_i, x_i> = 2 A_i with the signed areas: exact, cell by cell (E30)."""
    mesh = MESHES["closed"]()
    L = laplacian(mesh).stiffness
    product = ((L @ mesh.vertices) * mesh.vertices).sum(axis=1)
    assert np.allclose(product, 2 * vertex_areas(mesh, "circumcentric"), atol=1e-11)
    for kind in ("voronoi", "barycentric"):
        assert np.abs(product - 2 * vertex_areas(mesh, kind)).max() > 1e-4


def test_masses_against_loops_on_the_obtuse_mesh():
    mesh = MESHES["obt"]()
    expected = np.diag(oracle.masses(mesh, "voronoi", np.zeros((mesh.n_vertices,) * 2)))
    assert np.allclose(vertex_areas(mesh), expected, rtol=1e-8)


@pytest.mark.chapter("D10", "T3")
@pytest.mark.parametrize("unit", [1e-3, 1e-60, 1e60])
@pytest.mark.parametrize("name", ["obt", "bad"])
def test_areas_have_the_square_of_the_unit_and_the_energy_has_none(name, unit):
    mesh = MESHES[name]()
    other = mesh.with_vertices(unit * mesh.vertices)
    for kind in ("barycentric", "voronoi", "circumcentric"):
        areas = vertex_areas(mesh, kind)
        assert np.allclose(vertex_areas(other, kind) / unit / unit, areas, rtol=1e-9, atol=1e-14)
    f = mesh.vertices[:, 0]
    assert laplacian(other).dirichlet_energy(f) == pytest.approx(
        laplacian(mesh).dirichlet_energy(f)
    )
