import numpy as np

from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import disk, icosphere
from beltrami.mesh.shapes.relaxation import flip_edges, relax, split_quads


def test_quads_are_cut_along_the_shorter_diagonal():
    points = np.array([[0, 0, 0], [1, 0, 0], [3, 1, 0], [0, 1, 0]], dtype=float)
    assert split_quads(points, np.array([[0, 1, 2, 3]])).tolist() == [[1, 2, 3], [1, 3, 0]]
    assert split_quads(points, np.array([[1, 2, 3, 0]])).tolist() == [[1, 2, 3], [1, 3, 0]]


def _planar(seed):
    """A disk whose vertices are moved about within the plane: valid, far from Delaunay."""
    rng = np.random.default_rng(seed)
    mesh = disk(10, dimension=3)
    shear = np.array([[1, 0.9, 0], [0, 1, 0], [0, 0, 1]])
    points = mesh.vertices @ shear.T
    rim = np.bincount(mesh.boundary_loops[0], minlength=len(points)) > 0
    points[~rim, :2] += rng.uniform(-0.01, 0.01, (np.count_nonzero(~rim), 2))
    return points, mesh.faces, rim


def _excess(points, faces):
    """Sum of the angles opposite each interior edge, less pi."""
    sums = {}
    for face in faces.tolist():
        for k in range(3):
            a, b, c = face[k], face[(k + 1) % 3], face[(k + 2) % 3]
            u, v = points[b] - points[a], points[c] - points[a]
            angle = np.arccos((u @ v) / np.linalg.norm(u) / np.linalg.norm(v))
            sums.setdefault((min(b, c), max(b, c)), []).append(angle)
    return {edge: sum(angles) - np.pi for edge, angles in sums.items() if len(angles) == 2}


def test_flips_make_a_plane_mesh_delaunay(survey):
    points, faces, _ = _planar(436_029_117)
    assert max(_excess(points, faces).values()) > 0.3
    flipped = flip_edges(points, faces, np.zeros(len(points), dtype=bool))
    assert max(_excess(points, flipped).values()) < 1e-8
    facts, before = survey(Mesh(points, flipped)), survey(Mesh(points, faces))
    assert (facts.euler, facts.boundary_edges, facts.is_manifold) == (
        1,
        before.boundary_edges,
        True,
    )
    assert np.isclose(facts.area, before.area)
    a, b, c = points[flipped].transpose(1, 0, 2)
    assert (np.cross(b - a, c - a)[:, 2] > 0).all()


def test_no_edge_joins_two_fixed_vertices():
    points, faces, _ = _planar(8_330_125)
    fixed = np.random.default_rng(47_118_209).random(len(points)) < 0.4
    old = {e for e in _excess(points, faces) if fixed[list(e)].all()}
    new = {e for e in _excess(points, flip_edges(points, faces, fixed)) if fixed[list(e)].all()}
    assert new <= old


def test_no_second_copy_of_an_edge_and_no_fold():
    apex = np.array([[0, 0, 0.1], [1, 0, 0], [-0.5, 0.9, 0], [-0.5, -0.9, 0]])
    faces = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])  # a flat tetrahedron
    assert np.array_equal(flip_edges(apex, faces, np.zeros(4, dtype=bool)), faces)


def test_relaxation_evens_out_a_sphere_within_its_tangent_planes():
    mesh = icosphere(3)
    rng = np.random.default_rng(650_114_021)
    points = mesh.vertices + rng.uniform(-0.03, 0.03, mesh.vertices.shape)
    points /= np.linalg.norm(points, axis=1, keepdims=True)
    free = np.zeros(len(points), dtype=bool)

    def spread(x):
        lengths = np.linalg.norm(x[mesh.edges[:, 0]] - x[mesh.edges[:, 1]], axis=1)
        return lengths.std() / lengths.mean()

    moved = points
    for _ in range(10):
        moved = relax(moved, mesh.faces, free)
    assert spread(moved) < 0.6 * spread(points)
    assert np.abs(np.linalg.norm(moved, axis=1) - 1).max() < 0.02


def test_bound_vertices_stay_on_their_curve():
    points, faces, rim = _planar(2_901_447)
    points = points[:, [0, 2, 1]]  # the plane y = 0, all of it
    flat = relax(points, faces, rim)
    assert (flat[rim, 1] == 0).all()
    interior = ~rim
    mesh = Mesh(points, faces)
    i, j = np.concatenate([mesh.edges, mesh.edges[:, ::-1]]).T
    v = int(np.flatnonzero(interior)[5])
    expected = (points[v] + points[j[i == v]].mean(axis=0)) / 2
    assert np.allclose(flat[v], expected)
