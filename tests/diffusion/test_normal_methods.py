"""Filters of the normals of faces, against a few lines of numpy, and what they are for."""

import itertools

import numpy as np
import pytest
import scipy.optimize

from beltrami.diffusion.candidates import Bench, OfVariation, filtered
from beltrami.diffusion.face_rings import face_rings
from beltrami.diffusion.normal_filters import filtered_normals
from beltrami.diffusion.normal_guides import guide_normals
from beltrami.diffusion.normal_variation import evened_normals, normals_of_small_variation
from beltrami.diffusion.smooth_mesh import smooth_mesh
from beltrami.diffusion.vertex_update import fit_to_normals
from beltrami.errors import BeltramiError, DimensionError, MeshError, NonFiniteError
from beltrami.mesh import shapes
from beltrami.mesh.mesh import Mesh
from meshes_of_the_errata import MESHES

METHODS = ("bilateral_normals", "guided_normals", "tv_normals")
names = pytest.mark.parametrize("name", ["closed", "obt", "cur"])


def noisy_cube(seed=0, n=8, sigma=0.02):
    cube = shapes.cube(n)
    noise = np.random.default_rng(seed).normal(0, sigma, cube.vertices.shape)
    return cube, cube.with_vertices(cube.vertices + noise)


def angle(mesh, truth):
    cosine = np.einsum("ij,ij->i", mesh.face_normals, truth.face_normals)
    return np.degrees(np.arccos(np.clip(cosine, -1, 1))).mean()


def neighbours(mesh):
    sets = [set(face) for face in mesh.faces.tolist()]
    return [[j for j, b in enumerate(sets) if a & b] for a in sets]


def unit(x):
    return x / np.linalg.norm(x, axis=-1, keepdims=True)


@names
def test_rings(name):
    mesh = MESHES[name]()
    rings = face_rings(mesh.topology)
    for i, expected in enumerate(neighbours(mesh)):
        ring = rings.indices[rings.indptr[i] : rings.indptr[i + 1]].tolist()
        assert ring[0] == i
        assert sorted(ring) == expected


def guides(mesh, normals):
    """The definition, face by face."""
    rings = neighbours(mesh)
    sides = {}
    for i, face in enumerate(mesh.faces.tolist()):
        for a, b in itertools.combinations(sorted(face), 2):
            sides.setdefault((a, b), []).append(i)
    means, uneven = [], []
    for i, ring in enumerate(rings):
        mean = unit((mesh.face_areas[ring, None] * normals[ring]).sum(axis=0))
        touching = [
            pair
            for edge, pair in sides.items()
            if len(pair) == 2 and set(edge) & set(mesh.faces[i].tolist())
        ]
        jumps = [np.linalg.norm(normals[f] - normals[g]) for f, g in touching]
        spread = np.linalg.norm(normals[ring] - mean, axis=1).max()
        means.append(mean)
        uneven.append(spread * max(jumps) / (sum(jumps) + 1e-9))
    return np.array([means[min(ring, key=lambda j: uneven[j])] for ring in rings])


@names
def test_guides(name):
    mesh = MESHES[name]()
    normals = unit(
        mesh.face_normals + 0.2 * np.random.default_rng(1).normal(size=(mesh.n_faces, 3))
    )
    found = guide_normals(mesh.topology, face_rings(mesh.topology), normals, mesh.face_areas)
    assert np.allclose(found, guides(mesh, normals), atol=1e-12)


@names
@pytest.mark.parametrize("guided", [False, True])
def test_two_rounds_of_the_filter(name, guided):
    mesh = MESHES[name]()
    centres = mesh.vertices[mesh.faces].mean(axis=1)
    twins = mesh.topology.twins
    pairs = [(t // 3, i // 3) for i, t in enumerate(twins.ravel()) if t >= 0]
    sigma = np.mean([np.linalg.norm(centres[f] - centres[g]) for f, g in pairs])
    sigma *= 2 if guided else 1
    n = mesh.face_normals
    for _ in range(2):
        g = guides(mesh, n) if guided else n
        rows = []
        for i, ring in enumerate(neighbours(mesh)):
            near = np.exp(-((centres[ring] - centres[i]) ** 2).sum(axis=1) / (2 * sigma**2))
            alike = np.exp(-((g[ring] - g[i]) ** 2).sum(axis=1) / (2 * 0.3**2))
            rows.append((mesh.face_areas[ring] * near * alike) @ n[ring])
        n = unit(np.array(rows))
    rounds = filtered_normals(mesh, face_rings(mesh.topology), 0.3, guided=guided)
    next(rounds)
    assert np.allclose(next(rounds), n, atol=1e-12)


@names
def test_the_vertex_update(name):
    mesh = MESHES[name]()
    wanted = unit(mesh.face_normals + 0.1)
    held = np.zeros(mesh.n_vertices, bool)
    held[:5] = True
    x = mesh.vertices.copy()
    for _ in range(3):
        centres = x[mesh.faces].mean(axis=1)
        y = x.copy()
        for i in range(5, len(x)):
            around = (mesh.faces == i).any(axis=1)
            n = wanted[around]
            y[i] += (n * ((centres[around] - x[i]) * n).sum(axis=1)[:, None]).mean(axis=0)
        x = y
    found = fit_to_normals(mesh.topology, mesh.vertices, wanted, held, rounds=3)
    assert np.allclose(found, x, atol=1e-12)


def test_normals_of_a_mesh_move_nothing():
    for name in ("closed", "cur"):
        mesh = MESHES[name]()
        held = np.zeros(mesh.n_vertices, bool)
        same = fit_to_normals(mesh.topology, mesh.vertices, mesh.face_normals, held)
        assert np.allclose(same, mesh.vertices, atol=1e-13)


@pytest.mark.parametrize("fidelity", [1.0, 3.0])
def test_total_variation_is_the_minimum(fidelity):
    """The minimiser of the energy with |x| made smooth, by another method, is the same."""
    mesh = shapes.cube(2)
    rng = np.random.default_rng(5)
    mesh = mesh.with_vertices(mesh.vertices + rng.normal(0, 0.05, mesh.vertices.shape))
    twins = mesh.topology.twins.ravel()
    pairs = np.array([(i // 3, t // 3) for i, t in enumerate(twins) if t > i])
    corners = [(i // 3, i % 3) for i, t in enumerate(twins) if t > i]
    ends = [[mesh.faces[f, (c + 1) % 3], mesh.faces[f, (c + 2) % 3]] for f, c in corners]
    lengths = np.linalg.norm(np.subtract(*mesh.vertices[np.array(ends)].transpose(1, 0, 2)), axis=1)
    lengths /= lengths.mean()
    areas = mesh.face_areas / mesh.face_areas.mean()
    start = mesh.face_normals

    def energy(n):
        jumps = np.linalg.norm(n[pairs[:, 0]] - n[pairs[:, 1]], axis=1)
        return lengths @ jumps + fidelity / 2 * areas @ ((n - start) ** 2).sum(axis=1)

    found = normals_of_small_variation(mesh, fidelity, rounds=20_000)

    def smoothed(x):  # for another method
        n = x.reshape(-1, 3)
        d = n[pairs[:, 0]] - n[pairs[:, 1]]
        jumps = np.sqrt((d**2).sum(axis=1) + 1e-10)
        slope = fidelity * areas[:, None] * (n - start)
        pull = lengths[:, None] * d / jumps[:, None]
        np.add.at(slope, pairs[:, 0], pull)
        np.subtract.at(slope, pairs[:, 1], pull)
        value = lengths @ jumps + fidelity / 2 * areas @ ((n - start) ** 2).sum(axis=1)
        return value, slope.ravel()

    best = scipy.optimize.minimize(
        smoothed, start.ravel(), jac=True, method="L-BFGS-B", options={"maxiter": 20_000}
    ).x.reshape(-1, 3)
    assert energy(best) < 0.98 * energy(start)
    assert np.allclose(found, unit(best), atol=0.01)


def test_faces_whose_normals_even_out_to_nothing_keep_theirs():
    """Round a thin tube the normals point all ways; a filter that gives up would move nothing."""
    tube = shapes.cylinder(5, 60, caps=True)
    tube = tube.with_vertices(tube.vertices * [1, 1, 60])
    noise = np.random.default_rng(0).normal(0, 0.2 * tube.edge_lengths.mean(), tube.n_vertices)
    mesh = tube.with_vertices(tube.vertices + noise[:, None] * tube.vertex_normals)
    with pytest.raises(BeltramiError, match="evened out to nothing"):
        normals_of_small_variation(mesh, 0.7, 100)
    normals, lost = evened_normals(mesh, 0.7, 100)
    assert 0 < lost.sum() < mesh.n_faces
    assert np.array_equal(normals[lost], mesh.face_normals[lost])
    assert np.allclose(np.linalg.norm(normals, axis=1), 1)
    moved = filtered(mesh, Bench.of(mesh), [OfVariation(0.7)])[0] - mesh.vertices
    assert np.sqrt((moved**2).sum(axis=1).mean()) > 0.1 * np.abs(noise).mean()


@pytest.mark.parametrize("method", METHODS)
def test_creases_stay(method):
    truth, noisy = noisy_cube()
    contrast = {"contrast": 0.45} if method == "bilateral_normals" else {}
    found = smooth_mesh(noisy, method, **contrast)
    plain = smooth_mesh(noisy, "taubin")
    assert angle(noisy, truth) > 15
    assert angle(found, truth) < 0.5 * angle(plain, truth)


@pytest.mark.parametrize("method", METHODS)
def test_unit_place_turn_and_numbering_do_not_matter(method):
    _, mesh = noisy_cube(3, 4)
    expected = smooth_mesh(mesh, method, steps=7).vertices
    rng = np.random.default_rng(2)
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    for unit_ in (1e-9, 1.0, 1e9):
        moved = mesh.with_vertices(unit_ * (mesh.vertices @ turn + 2))
        found = smooth_mesh(moved, method, steps=7).vertices / unit_
        assert np.allclose(found, expected @ turn + 2, atol=1e-8)
    order = rng.permutation(mesh.n_vertices)
    faces = np.argsort(order)[mesh.faces][rng.permutation(mesh.n_faces)]
    other = Mesh(mesh.vertices[order], np.roll(faces, 1, axis=1))
    assert np.allclose(smooth_mesh(other, method, steps=7).vertices, expected[order], atol=1e-8)


@pytest.mark.parametrize("method", METHODS)
def test_dirty_meshes(method):
    _, mesh = noisy_cube(1, 4)
    with pytest.raises(DimensionError, match="mesh in space"):
        smooth_mesh(shapes.grid(3, 3).with_vertices(shapes.grid(3, 3).vertices[:, :2]), method)
    faces = mesh.faces.copy()
    faces[7] = faces[7, ::-1]
    with pytest.raises(MeshError, match=r"orient=True") as caught:
        smooth_mesh(Mesh(mesh.vertices, faces), method)
    assert len(caught.value.edges) == 3
    x = mesh.vertices.copy()
    x[5] = np.nan
    with pytest.raises(NonFiniteError):
        smooth_mesh(mesh.with_vertices(x), method)
    # a flat face has no normal, and no say
    x = mesh.vertices.copy()
    a, b, c = mesh.faces[10]
    x[c] = (x[a] + x[b]) / 2
    assert np.isfinite(smooth_mesh(mesh.with_vertices(x), method).vertices).all()
    # three leaves on one edge, and a vertex of no face
    leaves = Mesh(
        [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, -1, -1], [9, 9, 9]],
        [[0, 1, 2], [1, 0, 3], [0, 1, 4]],
    )
    moved = smooth_mesh(leaves, method).vertices
    assert np.isfinite(moved).all()
    assert np.array_equal(moved[5], [9, 9, 9])


@pytest.mark.parametrize("method", METHODS)
def test_held_vertices_and_the_boundary_stay(method):
    mesh = MESHES["cur"]()
    boundary = np.unique(mesh.topology.boundary_edges)
    moved = smooth_mesh(mesh, method, hold_boundary=True, hold=[120]).vertices
    assert np.array_equal(moved[boundary], mesh.vertices[boundary])
    assert np.array_equal(moved[120], mesh.vertices[120])
    assert not np.allclose(moved, mesh.vertices)


@pytest.mark.parametrize(
    ("method", "options", "text"),
    [
        ("bilateral_normals", {"contrast": 0.0}, "contrast must be"),
        ("guided_normals", {"contrast": np.nan}, "contrast must be"),
        ("tv_normals", {"fidelity": -1.0}, "fidelity must be"),
        ("tv_normals", {"fidelity": 1e-3}, "take a larger one"),
        ("tv_normals", {"contrast": 0.3}, "has no contrast"),
        ("bilateral_normals", {"steps": -1}, "whole number"),
    ],
)
def test_what_is_refused(method, options, text):
    with pytest.raises(BeltramiError, match=text):
        smooth_mesh(shapes.icosphere(1), method, **options)
