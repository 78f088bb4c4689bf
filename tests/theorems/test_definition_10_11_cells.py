"""Definitions 10 and 11 and theorem 3: cells by clipping against areas by formula (E21 to E25)."""

import numpy as np
import pytest

import cell_oracle as oracle
from beltrami.mesh.mesh import Mesh
from beltrami.operators.areas import vertex_areas
from beltrami.operators.edge_areas import edge_areas
from beltrami.operators.weights import weigh_edges
from meshes_of_the_errata import MESHES, flipped, triangle

PLANAR = ("open", "bad", "pl")


@pytest.fixture(scope="module")
def square_cells():
    """Mesh, its cells clipped in the square, and which of them stay inside."""
    mesh = MESHES["open"]()
    cells = oracle.vertex_cells(mesh.vertices)
    inside = np.array([((c > 1e-12) & (c < 1 - 1e-12)).all() for c in cells])
    return mesh, np.array([oracle.area(c) for c in cells]), inside


@pytest.mark.chapter("D10", "U13", "P22", "T3")
def test_inner_cells_of_a_delaunay_mesh_are_the_circumcentric_areas(square_cells):
    mesh, exact, inside = square_cells
    assert exact.sum() == pytest.approx(1, abs=1e-12)  # they tile the square (E25)
    assert inside.sum() > 100
    signed = vertex_areas(mesh, "circumcentric")
    assert np.allclose(signed[inside], exact[inside], rtol=1e-10)
    printed = 2 * signed  # theorem 3 with its ½ (E22)
    assert np.abs(printed[inside] / exact[inside] - 1).min() > 0.9
    assert np.abs(signed[~inside] / exact[~inside] - 1).max() > 0.1  # cells cut by the border (E23)
    for kind in ("voronoi", "barycentric"):  # and the others are other cells
        assert np.abs(vertex_areas(mesh, kind)[inside] / exact[inside] - 1).max() > 0.05


@pytest.mark.chapter("D10", "T3")
def test_without_delaunay_the_formula_is_no_area_of_a_cell(square_cells):
    _, exact, inside = square_cells
    signed = vertex_areas(MESHES["bad"](), "circumcentric")
    ratio = signed[inside] / exact[inside]  # the cells of the points know no edges
    assert ratio.min() < -1
    assert ratio.max() > 3


@pytest.mark.chapter("D11", "U13", "P22")
@pytest.mark.parametrize("name", PLANAR)
def test_the_points_nearest_to_an_edge_have_the_area_of_the_incentre(name):
    mesh = MESHES[name]()
    cells = oracle.edge_cells(mesh.vertices, mesh.faces)
    exact = np.array([cells[tuple(e)] for e in mesh.edges.tolist()])
    assert exact.sum() == pytest.approx(mesh.area, rel=1e-12)
    assert np.allclose(edge_areas(mesh, "incenter"), exact, rtol=1e-9)
    off = np.abs(edge_areas(mesh, "circumcenter") / exact - 1)  # what the text calls A_e (E21)
    assert off.max() > 0.1


@pytest.mark.chapter("D11")
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_nearest_edges_of_random_points(seed):
    """The clipping itself, against true distances to all the segments of the mesh."""
    mesh = flipped(seed, n=12)
    rng = np.random.default_rng(seed)
    corners = mesh.vertices[
        mesh.faces[rng.choice(mesh.n_faces, 40_000, p=mesh.face_areas / mesh.area)]
    ]
    u, v = np.sort(rng.uniform(size=(2, len(corners))), axis=0)
    p = corners[:, 0] * u[:, None] + corners[:, 1] * (v - u)[:, None]
    p += corners[:, 2] * (1 - v)[:, None]
    a, b = mesh.vertices[mesh.edges].transpose(1, 0, 2)
    t = ((p[:, None] - a) * (b - a)).sum(axis=2) / ((b - a) ** 2).sum(axis=1)
    foot = a + np.clip(t, 0, 1)[:, :, None] * (b - a)
    nearest = np.linalg.norm(p[:, None] - foot, axis=2).argmin(axis=1)
    measured = np.bincount(nearest, minlength=len(mesh.edges)) / len(p) * mesh.area
    bound = 4 * mesh.area / np.sqrt(len(p)) / 2
    assert np.abs(measured - edge_areas(mesh, "incenter")).max() < bound
    assert np.abs(measured - edge_areas(mesh, "circumcenter")).max() > 2 * bound


@pytest.mark.chapter("D11", "T3")
def test_the_two_cells_of_the_errata():
    """E21: an obtuse triangle, where the diamond of the circumcentre is negative."""
    mesh = triangle(20, 125)
    cells = oracle.side_cells(mesh.vertices)
    incenter, circumcenter = (edge_areas(mesh, k)[[2, 1, 0]] for k in ("incenter", "circumcenter"))
    assert np.allclose(incenter, cells, rtol=1e-12)
    assert (circumcenter < 0).sum() == 1
    assert circumcenter.sum() == pytest.approx(mesh.area)
    assert 2 * circumcenter.sum() == pytest.approx(2 * mesh.area)  # theorem 3 as printed (E22)


@pytest.mark.chapter("T3", "U13")
@pytest.mark.parametrize("name", MESHES)
def test_theorem_3_on_every_mesh(name):
    mesh = MESHES[name]()
    cells = edge_areas(mesh, "circumcenter")
    assert cells.sum() == pytest.approx(mesh.area, rel=1e-11)
    assert edge_areas(mesh, "incenter").sum() == pytest.approx(mesh.area, rel=1e-11)
    assert (edge_areas(mesh, "incenter") > 0).all()
    halves = np.bincount(mesh.edges.ravel(), np.repeat(cells / 2, 2), mesh.n_vertices)
    scale = np.abs(cells).max()
    assert np.allclose(halves, vertex_areas(mesh, "circumcentric"), atol=1e-11 * scale)
    negative = weigh_edges(mesh, "cotangent") < -1e-12
    assert np.array_equal(cells < -1e-12 * scale, negative & (cells < -1e-12 * scale))
    assert (cells[negative] < 0).all()


@pytest.mark.chapter("D10", "T3")
def test_two_sheets_near_each_other():
    """Distances in space would give half of one sheet to vertices of the other (E25)."""
    sheet = MESHES["open"]()
    x, y = sheet.vertices.T
    low, high = np.stack([x, y, 0 * x], axis=1), np.stack([y, x, 0 * x + 0.01], axis=1)
    n = len(x)
    both = Mesh(np.concatenate([low, high]), np.concatenate([sheet.faces, sheet.faces + n]))
    for kind in ("circumcentric", "voronoi"):
        areas = vertex_areas(both, kind)
        assert np.allclose(areas, np.tile(vertex_areas(sheet, kind), 2), rtol=1e-9, atol=1e-12)
    points = np.random.default_rng(7).uniform(size=(4000, 3)) * [1, 1, 0]
    nearest = ((points[:, None] - both.vertices) ** 2).sum(axis=2).argmin(axis=1)
    assert (nearest >= n).mean() > 0.4
