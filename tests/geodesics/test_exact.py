"""Exact distances: closed formulas, what must not matter, and paths through many points."""

import numpy as np
import pytest
from hypothesis import given, settings
from scipy.sparse import csr_array
from scipy.sparse.csgraph import dijkstra

import strategies
from beltrami.errors import NotManifoldError
from beltrami.geodesics import exact
from beltrami.geodesics.distance import geodesic_distance
from beltrami.mesh import shapes
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes.subdivide import subdivide
from meshes_of_the_errata import MESHES
from surfaces_to_walk_on import maze, shuffled, slit

MANIFOLDS = [name for name in MESHES if name != "leaves"]


def distance(mesh, sources):
    return geodesic_distance(mesh, sources, method="exact")


@pytest.mark.parametrize("name", ["open", "bad", "pl"])
@pytest.mark.parametrize("source", [0, 23, 55])
def test_in_a_convex_piece_of_the_plane_it_is_the_straight_line(name, source):
    mesh = MESHES[name]()
    straight = np.linalg.norm(mesh.vertices - mesh.vertices[source], axis=1)
    assert np.allclose(distance(mesh, source), straight, atol=1e-14)


def test_around_the_end_of_a_slit():
    mesh = slit()
    x = mesh.vertices
    behind = mesh.faces[x[mesh.faces].mean(axis=1)[:, 1] < 0]
    upper = np.setdiff1d(np.arange(mesh.n_vertices), behind)
    source = int(np.flatnonzero((x == [0.7, 0.3]).all(axis=1))[0])
    d = distance(mesh, source)
    straight = np.linalg.norm(x - x[source], axis=1)
    lower = x[:, 1] < 0
    lower[np.setdiff1d(behind, np.flatnonzero(x[:, 1] != 0))] = True
    lower[(x[:, 1] == 0) & (x[:, 0] <= 0)] = False
    crossing = x[source, 0] + (x[:, 0] - x[source, 0]) * 0.3 / (0.3 - np.minimum(x[:, 1], 0))
    blocked = lower & (crossing > 0)
    around = np.linalg.norm(x, axis=1) + np.linalg.norm(x[source])
    assert blocked.sum() > 50
    assert np.allclose(d, np.where(blocked, around, straight), atol=1e-13)
    assert len(upper) > 200


def test_on_the_cube_paths_are_straight_when_it_is_unfolded():
    box = shapes.cube(4)
    x = box.vertices - box.vertices.min(axis=0)
    at = lambda *p: int(np.flatnonzero((np.abs(x - p) < 1e-12).all(axis=1))[0])  # noqa: E731
    d = distance(box, at(0, 0, 0))
    assert d[at(1, 1, 1)] == pytest.approx(np.sqrt(5), abs=1e-14)
    assert d[at(1, 1, 0.5)] == pytest.approx(np.hypot(1.5, 1), abs=1e-14)
    d = distance(box, at(0.5, 0.5, 0))
    assert d[at(0.5, 0.5, 1)] == pytest.approx(2, abs=1e-14)
    assert d[at(0.75, 0, 0.5)] == pytest.approx(np.hypot(0.25, 1), abs=1e-14)
    assert d[at(0.75, 0.25, 1)] == pytest.approx(min(np.hypot(0.25, 1.75), np.hypot(0.5, 2)))


@pytest.mark.parametrize("sides", [5, 16])
def test_a_tube_is_unrolled(sides):
    k = 7
    turn = 2 * np.pi * np.arange(sides) / sides
    rim = np.column_stack([np.cos(turn), np.sin(turn)])
    x = np.concatenate([np.column_stack([rim, np.full(sides, 0.4 * z)]) for z in range(k)])
    s, z = np.meshgrid(np.arange(sides), np.arange(k - 1))
    a, b = (z * sides + s).ravel(), (z * sides + (s + 1) % sides).ravel()
    faces = np.concatenate([np.stack([a, b, b + sides], 1), np.stack([a, b + sides, a + sides], 1)])
    step = np.arange(sides)
    across = np.minimum(step, sides - step) * 2 * np.sin(np.pi / sides)
    expected = np.hypot(across[None], 0.4 * np.arange(k)[:, None]).ravel()
    assert np.allclose(distance(Mesh(x, faces), 0), expected, atol=1e-14)


def test_around_a_cone_of_little_angle_paths_do_not_reach_the_tip():
    """Four faces of angle 0.3 around a tip: the way to the opposite side is a chord."""
    angle, x = 0.3, np.zeros((5, 3))
    radius = np.sin(angle / 2) / np.sin(np.pi / 4)
    turn = np.pi / 2 * np.arange(4)
    x[1:] = np.column_stack([radius * np.cos(turn), radius * np.sin(turn), np.ones(4)])
    x[1:, 2] = np.sqrt(1 - radius**2)
    cone = Mesh(x, [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]])
    d = distance(cone, 1)
    assert d == pytest.approx([1, 0, 2 * np.sin(0.15), 2 * np.sin(0.3), 2 * np.sin(0.15)])


@pytest.mark.parametrize("name", MANIFOLDS)
def test_what_must_not_matter(name):
    mesh = MESHES[name]()
    d = distance(mesh, 5)
    size = d.max()
    for seed in (1, 2):
        assert np.allclose(distance(shuffled(mesh, seed), 5), d, atol=1e-13 * size)
    finer = subdivide(mesh, 1)  # the same surface, cut at the midpoints
    assert np.array_equal(finer.vertices[: mesh.n_vertices], mesh.vertices)
    assert np.allclose(distance(finer, 5)[: mesh.n_vertices], d, atol=1e-13 * size)
    for unit in (1e-120, 1e-9, 1e9):
        other = mesh.with_vertices(unit * mesh.vertices)
        assert np.allclose(distance(other, 5) / unit, d, rtol=1e-11)
    rotation = np.linalg.qr(np.random.default_rng(837465).normal(size=(5, 5)))[0]
    embedded = mesh.with_vertices(mesh.vertices @ rotation[: mesh.dimension])
    assert np.allclose(distance(embedded, 5), d, atol=1e-12 * size)


@pytest.mark.parametrize("name", MANIFOLDS)
def test_it_is_a_metric_between_the_straight_line_and_the_edges(name):
    mesh = MESHES[name]()
    places = np.arange(0, mesh.n_vertices, mesh.n_vertices // 7)
    all_of = np.array([distance(mesh, p) for p in places])
    square = all_of[:, places]
    assert np.allclose(square, square.T, atol=1e-13 * square.max())
    for a, row in enumerate(square):
        assert (all_of <= (row[:, None] + all_of[a]) * (1 + 1e-12)).all()
    assert np.allclose(distance(mesh, places), all_of.min(axis=0), atol=1e-13 * square.max())
    for p, row in zip(places, all_of, strict=True):
        edges = geodesic_distance(mesh, p, method="edges")
        straight = np.linalg.norm(mesh.vertices - mesh.vertices[p], axis=1)
        assert (row <= edges).all()
        assert (row >= straight * (1 - 1e-13)).all()
        assert (row < edges - 1e-3 * edges.max()).any()


def _through_points_on_edges(mesh, source, k):
    """Shortest paths through k points more on each edge, straight inside each face."""
    x, ends = mesh.vertices, mesh.edges
    t = (np.arange(k) + 1) / (k + 1)
    between = x[ends[:, 0], None] * (1 - t)[None, :, None] + x[ends[:, 1], None] * t[None, :, None]
    points = np.concatenate([x, between.reshape(-1, x.shape[1])])
    rows, columns = [], []
    for face, edges in zip(mesh.faces, mesh.topology.face_edges, strict=True):
        own = np.concatenate([face, *(mesh.n_vertices + e * k + np.arange(k) for e in edges)])
        i, j = np.meshgrid(own, own)
        rows.append(i[i < j])
        columns.append(j[i < j])
    pairs = np.unique(np.stack([np.concatenate(rows), np.concatenate(columns)]), axis=1)
    lengths = np.linalg.norm(points[pairs[0]] - points[pairs[1]], axis=1)
    graph = csr_array((lengths, pairs), shape=(len(points), len(points)))
    return dijkstra(graph, directed=False, indices=source)[: mesh.n_vertices]


@settings(max_examples=25)
@given(strategies.arrays(*strategies.CLEAN))
def test_paths_through_many_points_are_hardly_longer_and_never_shorter(pair):
    mesh = Mesh(*pair)
    used = np.unique(mesh.faces)
    mesh = Mesh(mesh.vertices[used], np.searchsorted(used, mesh.faces))
    d, above = distance(mesh, 0), _through_points_on_edges(mesh, 0, 12)
    assert (d <= above * (1 + 1e-12)).all()
    assert (above <= d * 1.03 + 0.02 * d.max()).all()


@pytest.mark.parametrize("height", [0, 0.1])
def test_in_a_maze_paths_turn_at_corners_and_at_saddles(height, monkeypatch):
    mesh = maze(height)
    source = int(mesh.vertices[:, :2].sum(axis=1).argmin())
    d, above = distance(mesh, source), _through_points_on_edges(mesh, source, 6)
    assert (d <= above * (1 + 1e-12)).all()
    assert (above <= d * 1.04).all()
    monkeypatch.setattr(exact, "_turning", lambda mesh: np.zeros(mesh.n_vertices, np.bool_))
    assert (distance(mesh, source) > above * 1.005).any()


def test_faces_that_meet_in_one_vertex():
    x = [[0, 0], [1, 0], [1, 1], [-1, 0], [-1, -1], [-2, -1]]
    d = distance(Mesh(x, [[0, 1, 2], [0, 3, 4], [3, 5, 4]]), 1)
    assert d == pytest.approx([1, 0, 1, 2, 1 + np.sqrt(2), 1 + np.sqrt(5)])


def test_other_components_are_out_of_reach():
    x = [[0, 0], [1, 0], [0, 1], [5, 0], [6, 0], [5, 1]]
    mesh = Mesh(x, [[0, 1, 2], [3, 4, 5]])
    assert distance(mesh, 0).tolist() == [0, 1, 1, np.inf, np.inf, np.inf]
    assert distance(mesh, [0, 4]).tolist() == [0, 1, 1, 1, 0, np.sqrt(2)]


def test_edges_of_three_faces_are_refused():
    with pytest.raises(NotManifoldError, match="split_non_manifold") as caught:
        distance(MESHES["leaves"](), 0)
    assert caught.value.edges.tolist() == [[0, 1]]
