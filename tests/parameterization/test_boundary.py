"""Boundary curves: convex, in order, corners where they were asked for."""

import numpy as np
import pytest

from beltrami.errors import BoundaryCurveError, MeshError, UnknownNameError
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import disk, grid, torus
from beltrami.parameterization.boundary import place_boundary, refuse_dividing_edges
from beltrami.parameterization.parameterize import parameterize
from meshes_of_the_errata import cur, open_

TRIANGLE = np.array([[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]])


def steps_between(placed):
    return np.linalg.norm(np.roll(placed, -1, axis=0) - placed, axis=1)


@pytest.mark.chapter("P73")
def test_steps_on_the_circle_are_as_the_edges():
    mesh = cur()
    (loop,) = mesh.boundary_loops
    placed = place_boundary(mesh, loop)
    angles = np.unwrap(np.arctan2(*placed.T[::-1]))
    x = mesh.vertices[loop]
    lengths = steps_between(x)
    np.testing.assert_allclose(np.diff(angles), 2 * np.pi * lengths[:-1] / lengths.sum())
    uniform = place_boundary(mesh, loop, spacing="uniform")
    np.testing.assert_allclose(steps_between(uniform), 2 * np.sin(np.pi / len(loop)))


@pytest.mark.chapter("P73")
@pytest.mark.parametrize("curve", ["square", 3, 5, TRIANGLE])
@pytest.mark.parametrize("spacing", ["arclength", "uniform"])
def test_polygons_have_a_vertex_at_each_corner_and_the_rest_on_their_sides(curve, spacing):
    mesh = cur()
    (loop,) = mesh.boundary_loops
    placed = place_boundary(mesh, loop, curve, spacing=spacing)
    corners = {"square": [[-1, -1], [1, -1], [1, 1], [-1, 1]]}.get(str(curve), curve)
    if isinstance(curve, int):
        t = 2 * np.pi * np.arange(curve) / curve
        corners = np.stack([np.cos(t), np.sin(t)], axis=1)
    corners = np.asarray(corners, float)
    gaps = np.linalg.norm(placed[:, None] - corners, axis=2)
    assert (gaps.min(axis=0) == 0).all()
    assert steps_between(placed).sum() == pytest.approx(steps_between(corners).sum())
    assert len(np.unique(placed, axis=0)) == len(loop)
    share = steps_between(corners) / steps_between(corners).sum()
    at = np.sort(gaps.argmin(axis=0))
    assert at[0] == 0
    if spacing == "uniform":  # as many vertices on each side as the side is long
        np.testing.assert_allclose(np.diff([*at, len(loop)]) / len(loop), share, atol=1 / len(loop))


@pytest.mark.chapter("P73")
def test_corners_are_placed_where_asked():
    mesh = grid(5, 5)
    corners = [i for i in range(mesh.n_vertices) if set(np.abs(mesh.vertices[i, :2])) <= {0, 1}]
    (loop,) = mesh.boundary_loops
    ordered = [int(v) for v in loop if v in corners]
    psi = parameterize(mesh, "tutte", "cotangent", "square", corners=ordered)
    # a square onto a square, by weights that keep linear functions: the map is linear
    flat = mesh.vertices[:, :2]
    line = np.linalg.lstsq(np.column_stack([flat, np.ones(len(flat))]), psi.uv, rcond=None)
    assert float(line[1].max()) < 1e-25
    np.testing.assert_allclose(psi.distortion.symmetric_dirichlet, 1, rtol=1e-12)


def test_corners_that_do_not_fit():
    mesh = grid(3, 3)
    (loop,) = mesh.boundary_loops
    inside = int(np.setdiff1d(np.arange(mesh.n_vertices), loop)[0])
    with pytest.raises(MeshError) as caught:
        place_boundary(mesh, loop, "square", corners=[*loop[:3], inside])
    assert caught.value.vertices.tolist() == [inside]
    with pytest.raises(MeshError, match="order"):
        place_boundary(mesh, loop, "square", corners=loop[[0, 2, 1, 3]])
    with pytest.raises(MeshError, match="order"):
        place_boundary(mesh, loop, "square", corners=loop[[0, 2, 2, 3]])
    with pytest.raises(MeshError, match="3 vertices for the 4 corners"):
        place_boundary(mesh, loop, "square", corners=loop[:3])
    with pytest.raises(MeshError, match="circle"):
        place_boundary(mesh, loop, corners=loop[:3])
    with pytest.raises(MeshError, match="cannot fill"):
        place_boundary(mesh, loop, len(loop) + 1)
    with pytest.raises(UnknownNameError, match="arclength"):
        place_boundary(mesh, loop, spacing="arc length")


@pytest.mark.chapter("P73")
@pytest.mark.parametrize(
    ("polygon", "guilty"),
    [
        ([[0, 0], [2, 0], [1, 0.5], [2, 2], [0, 2]], [2]),
        ([[0, 0], [0, 1], [1, 0]], [0, 1, 2]),  # clockwise
        ([[0, 0], [1, 0], [2, 0], [1, 1]], [1]),  # straight
        ([[0, 0], [1, 0], [1, 0], [1, 1]], [1, 2]),  # twice the same
    ],
)
def test_polygons_that_are_not_convex_are_refused(polygon, guilty):
    mesh = disk(3)
    with pytest.raises(BoundaryCurveError) as caught:
        place_boundary(mesh, mesh.boundary_loops[0], polygon)
    assert caught.value.vertices.tolist() == guilty


def test_polygons_that_are_none():
    mesh = disk(3)
    (loop,) = mesh.boundary_loops
    t = 4 * np.pi * np.arange(5) / 5
    with pytest.raises(BoundaryCurveError, match="crosses"):
        place_boundary(mesh, loop, np.stack([np.cos(t), np.sin(t)], axis=1))
    with pytest.raises(BoundaryCurveError):
        place_boundary(mesh, loop, 2)
    with pytest.raises(BoundaryCurveError):
        place_boundary(mesh, loop, np.zeros((4, 3)))
    with pytest.raises(BoundaryCurveError):
        place_boundary(mesh, loop, [[0, 0], [1, 0], [np.nan, 1]])


@pytest.mark.chapter("T21")
def test_dividing_edges_are_named():
    """E89: an ear on a straight side gets no area; the circle has room for it."""
    mesh = disk(3)
    i, j = mesh.boundary_loops[0][4:6]
    tip = mesh.n_vertices
    x = np.concatenate([mesh.vertices, (mesh.vertices[[i]] + mesh.vertices[[j]]) * 0.7])
    eared = Mesh(x, np.concatenate([mesh.faces, [[j, i, tip]]]))
    loop = eared.boundary_loops[0]
    at = int(np.flatnonzero(loop == tip)[0])

    def corners(first):
        return loop[(at + first + np.array([0, 5, 10, 14])) % len(loop)]

    with pytest.raises(BoundaryCurveError) as caught:
        parameterize(eared, boundary="square", corners=corners(2))  # the ear is on the last side
    assert caught.value.edges.tolist() == [sorted([int(i), int(j)])]
    assert parameterize(eared, boundary="square", corners=corners(0)).is_bijective
    assert parameterize(eared, boundary="circle").is_bijective


def test_edges_that_divide_the_curve_elsewhere_are_no_problem():
    mesh = open_()
    (loop,) = mesh.boundary_loops
    placed = place_boundary(mesh, loop)
    refuse_dividing_edges(mesh, loop, placed)


def test_vertices_at_the_same_place_do_not_stay_there():
    x = [[0, 0], [1, 0], [1, 0], [1, 1], [0.5, 0.5]]
    mesh = Mesh(x, [[0, 1, 4], [2, 3, 4], [3, 0, 4], [1, 2, 4]])
    placed = place_boundary(mesh, np.array([0, 1, 2, 3]))
    assert steps_between(placed).min() > 0


@pytest.mark.chapter("T21", "P73")
def test_bent_sides_are_strictly_convex_and_no_edge_divides_them():
    mesh = open_()
    (loop,) = mesh.boundary_loops
    with pytest.raises(BoundaryCurveError, match="bulge"):
        parameterize(mesh, boundary=5)
    psi = parameterize(mesh, boundary=5, bulge=0.01)
    assert psi.is_bijective
    straight = place_boundary(mesh, loop, 5)
    bent = place_boundary(mesh, loop, 5, bulge=0.01)
    away = np.linalg.norm(bent - straight, axis=1)
    side = 2 * np.sin(np.pi / 5)
    assert 0.008 * side < away.max() <= 0.01 * side
    assert np.count_nonzero(away < 1e-15) == 5  # the corners stay
    assert (np.linalg.norm(bent, axis=1) >= np.linalg.norm(straight, axis=1)).all()
    for bulge in (-0.1, 0.2, np.nan):
        with pytest.raises(BoundaryCurveError):
            place_boundary(mesh, loop, 5, bulge=bulge)
    with pytest.raises(BoundaryCurveError, match="turn left"):  # corners of almost 180 degrees
        place_boundary(mesh, loop, 20, bulge=0.1)


@pytest.mark.parametrize("bulge", ["much", None, [0.01]])
def test_a_bulge_is_a_number(bulge):
    with pytest.raises(MeshError, match=r"bulge is .* where a number is needed"):
        parameterize(disk(3), boundary="square", bulge=bulge)


def test_what_a_circle_cannot_use_is_refused():
    with pytest.raises(BoundaryCurveError, match="bend"):
        parameterize(disk(3), bulge=0.01)


def test_more_sides_than_vertices_are_refused_before_they_are_made():
    with pytest.raises(MeshError, match="10000000000 corners"):
        parameterize(disk(3), boundary=10**10)


def test_errors_name_vertices_and_edges_of_what_was_given():
    """Two components: each is mapped as a mesh of its own, with numbers of its own."""
    flat, square = disk(3), grid(2, 2)
    n = flat.n_vertices
    x = np.concatenate([flat.vertices, square.vertices + 5])
    two = Mesh(x, np.concatenate([flat.faces, square.faces + n]))
    with pytest.raises(BoundaryCurveError) as caught:
        parameterize(two, boundary=3)
    inner = two.edges[two.topology.edge_face_count == 2]
    assert {tuple(edge) for edge in caught.value.edges} <= {tuple(edge) for edge in inner.tolist()}
    assert caught.value.edges.min() >= n
    loop = square.boundary_loops[0][[0, 2, 4]] + n
    with pytest.raises(MeshError, match="not on the boundary") as caught:
        parameterize(two, boundary=3, corners=loop)  # which are not in the first one
    np.testing.assert_array_equal(caught.value.vertices, loop)


def test_edges_of_a_cut_surface_have_their_names_too():
    mesh = torus(8, 6)
    with pytest.raises(BoundaryCurveError) as caught:
        parameterize(mesh, boundary=3)
    assert caught.value.edges.max() < mesh.n_vertices
    keys = mesh.edges @ [1000, 1]
    assert np.isin(caught.value.edges @ [1000, 1], keys).all()
