"""Spikes: found where they are, and nowhere else."""

import os
from pathlib import Path

import numpy as np
import pytest

from beltrami.diffusion.blind import blind_choice
from beltrami.diffusion.planes import PlanesAround, planes_of
from beltrami.diffusion.spikes import _limit, find_spikes
from beltrami.io.registry import read_mesh
from beltrami.mesh import shapes
from beltrami.mesh.mesh import Mesh
from made_once import creature

FOLDER = os.environ.get("BELTRAMI_MESHES")


def spiked(truth, share, white=0.0, seed=0, *, pairs=False, one_sided=False):
    """Put some vertices off by a normal variable of one mean edge, upon white noise."""
    random = np.random.default_rng([seed, 5])  # heights first: the same for each share
    n, edge = truth.n_vertices, truth.edge_lengths.mean()
    height, hit = random.normal(0, 1, n), random.random(n) < share / (2 if pairs else 1)
    if one_sided:
        height = np.abs(height)
    if pairs:
        A = truth.topology.adjacency
        for i in np.flatnonzero(hit):
            other = A.indices[A.indptr[i]]
            hit[other], height[other] = True, height[i]
    noise = edge * (hit * height + white * random.normal(0, 1, n))
    mesh = truth.with_vertices(truth.vertices + noise[:, None] * truth.vertex_normals)
    return mesh, hit & (np.abs(height) > 0.7), hit


def octahedron():
    """Return one of 4098 vertices."""
    mesh = shapes.octahedron()
    for _ in range(5):
        i, j = mesh.edges.T
        n = mesh.n_vertices
        number = np.zeros((n, n), int)
        number[i, j] = number[j, i] = n + np.arange(len(i))
        a, b, c = mesh.faces.T
        ab, bc, ca = number[a, b], number[b, c], number[c, a]
        faces = np.concatenate(
            [np.stack(f, axis=1) for f in ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca))]
        )
        mesh = Mesh(np.concatenate([mesh.vertices, mesh.vertices[mesh.edges].mean(axis=1)]), faces)
    return mesh


SHARP = {
    "cube": shapes.cube(20),
    "octahedron": octahedron(),
    "can": shapes.cylinder(60, 30, caps=True),
}


def rms(mesh, truth):
    away = ((mesh.vertices - truth.vertices) ** 2).sum(axis=1)
    return np.sqrt(away.mean()) / truth.edge_lengths.mean()


class TestPlanes:
    def test_against_the_definition(self):
        mesh, _, _ = spiked(shapes.blob(500), 0.1, 0.1)
        around, planes = PlanesAround.of(mesh.topology), planes_of(mesh)
        off = around.off(planes, mesh, mesh.vertices)
        held = around.shares(planes, mesh.vertices, 0.3 * np.abs(off))
        t, x, faces = mesh.topology, mesh.vertices, mesh.faces

        def distances(i):
            around = {f for j in t.ring(i) for f in t.face_ring(j)} - set(t.face_ring(i))
            f = sorted(around)
            away = x[i] - x[faces[f]].mean(axis=1)
            return np.einsum("ij,ij->i", mesh.face_normals[f], away)

        def middle(values):
            third = len(values) // 3
            return np.sort(values)[third : len(values) - third].mean()

        usual = np.array([middle(distances(i)) for i in range(mesh.n_vertices)])
        for i in range(0, mesh.n_vertices, 11):
            expected = usual[i] - np.median(usual[t.ring(i)])
            assert off[i] == pytest.approx(expected, abs=1e-12)
            near = np.abs(distances(i)) < 0.3 * abs(expected)
            assert held[i] == pytest.approx(near.mean())

    def test_vertices_of_many_neighbours_are_not_looked_at(self):
        """Else the rings around a hub would take memory as its square."""
        n = 3000
        angle = 2 * np.pi * np.arange(n) / n
        rim = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
        i = np.arange(n)
        fan = Mesh(
            np.concatenate([rim, [[0, 0, 1], [0, 0, -1.0]]]),
            np.concatenate(
                [
                    np.stack([i, (i + 1) % n, i * 0 + n], 1),
                    np.stack([(i + 1) % n, i, i * 0 + n + 1], 1),
                ]
            ),
        )
        around = PlanesAround.of(fan.topology)
        assert (np.diff(around.indptr)[-2:] == 0).all()
        assert len(around.faces) < 10 * n
        assert find_spikes(fan) is None


@pytest.mark.parametrize(("share", "quiet"), [(0.1, 0.2), (0.02, 0.1), (0.3, 0.05)])
def test_the_limit_is_where_both_kinds_are_as_likely(share, quiet):
    random = np.random.default_rng(1)
    n = 30_000
    r = random.normal(0, np.where(random.random(n) < share, 1.0, quiet))
    at = _limit(r)
    densities = [
        part / scale * np.exp(-0.5 * (at / scale) ** 2)
        for part, scale in ((1 - share, quiet), (share, 1.0))
    ]
    assert densities[0] == pytest.approx(densities[1], rel=0.6)  # of the order of exp(r²)
    assert _limit(random.normal(0, quiet, n)) > 4 * quiet
    assert _limit(np.zeros(50)) == np.inf


@pytest.mark.parametrize("white", [0.0, 0.1, 0.2])
@pytest.mark.parametrize("share", [0.02, 0.1, 0.2])
def test_they_are_found_and_put_back(share, white):
    mesh, large, hit = spiked(creature(2500), share, white)
    found = find_spikes(mesh)
    assert found.found[large].mean() > (0.9 if white < 0.2 else 0.8)
    assert (found.found & ~hit).mean() < 0.03
    others = ~found.found
    assert np.array_equal(found.mesh.vertices[others], mesh.vertices[others])
    assert rms(found.mesh, creature(2500)) < np.hypot(1.15 * white, 0.3 * np.sqrt(share))
    assert found.error < 1.6 * max(white, 0.06) * mesh.edge_lengths.mean()


@pytest.mark.parametrize("kind", ["pairs", "one_sided"])
def test_pairs_and_spikes_to_one_side(kind):
    mesh, large, _ = spiked(creature(2500), 0.1, 0.05, **{kind: True})
    found = find_spikes(mesh)
    assert found.found[large].mean() > 0.85
    assert rms(found.mesh, creature(2500)) < 0.35 * rms(mesh, creature(2500))


@pytest.mark.parametrize("name", SHARP)
def test_creases_are_none_but_spikes_at_them_are(name):
    truth = SHARP[name]
    for level in (0.0, 0.1):
        white, _, _ = spiked(truth, 0.0, level)
        assert find_spikes(white) is None
    mesh, large, _ = spiked(truth, 0.05)
    found = find_spikes(mesh)
    assert found.found[large].mean() > 0.95
    assert rms(found.mesh, truth) < 0.2 * rms(mesh, truth)


@pytest.mark.parametrize("name", ["cube", "octahedron"])
def test_where_there_are_some_vertices_of_creases_are_none_of_them(name):
    """Once the spikes are down, a vertex of a crease that is off alone is where filling puts it."""
    mesh, _, hit = spiked(SHARP[name], 0.05, 0.02)
    assert not (find_spikes(mesh).found & ~hit).any()


@pytest.mark.parametrize("level", [0.0, 0.05, 0.1, 0.2, 0.3, 0.5])
@pytest.mark.parametrize("name", ["blob", "torus"])
def test_none_in_white_noise(name, level):
    truth = creature(2500) if name == "blob" else shapes.torus(60, 30)
    for seed in range(2):
        assert find_spikes(spiked(truth, 0.0, level, seed)[0]) is None


def test_bumps_of_several_vertices_are_features():
    random = np.random.default_rng(0)
    sphere = shapes.icosphere(4)
    A = sphere.topology.adjacency
    height = np.zeros(sphere.n_vertices)
    for i in random.choice(sphere.n_vertices, 25, replace=False):
        height[i] = 2
        height[A.indices[A.indptr[i] : A.indptr[i + 1]]] = 1.5
    edge = sphere.edge_lengths.mean()
    bumpy = sphere.with_vertices(sphere.vertices * (1 + edge * height)[:, None])
    assert find_spikes(bumpy) is None


@pytest.mark.parametrize("unit", [1e-9, 1e9])
def test_the_unit_does_not_matter(unit):
    mesh, _, _ = spiked(creature(2500), 0.1)
    here = find_spikes(mesh)
    there = find_spikes(mesh.with_vertices(mesh.vertices * unit))
    assert (here.found != there.found).mean() < 0.002
    assert there.error == pytest.approx(unit * here.error, rel=0.05)


def test_borders_strays_and_several_faces_on_an_edge():
    plane = shapes.grid(50, 50, dimension=3)
    x, y, _ = plane.vertices.T
    truth = plane.with_vertices(np.stack([x, y, 0.2 * np.sin(4 * x) * y], axis=1))
    mesh, large, _ = spiked(truth, 0.1)
    n = truth.n_vertices
    leaf = Mesh(
        np.concatenate([mesh.vertices, [[0, 0, 1.0]], [[5.0, 5, 5]]]),
        np.concatenate(
            [mesh.faces, [[*mesh.edges[np.flatnonzero(~large[mesh.edges].any(axis=1))[0]], n]]]
        ),
    )
    for one in (mesh, leaf):
        found = find_spikes(one)
        assert found.found[:n][large].mean() > 0.95
        rim = np.unique(truth.topology.boundary_edges)
        edge = truth.edge_lengths.mean()
        off = np.linalg.norm(found.mesh.vertices[:n] - truth.vertices, axis=1)[rim] / edge
        assert np.median(off) < 0.01


@pytest.mark.parametrize("rings", [0, 1, 2])
def test_few_vertices(rings):
    one = shapes.icosphere(rings)
    assert find_spikes(one) is None
    assert find_spikes(one.with_vertices(np.zeros((one.n_vertices, 3)))) is None
    assert find_spikes(Mesh(np.eye(3), [[0, 1, 2]])) is None


@pytest.mark.meshes
@pytest.mark.parametrize(
    "name", ["Fandisk0.3/Original.obj", "spot_triangulated.obj", "fertility.off"]
)
def test_shapes_have_none_of_their_own(name):
    if not FOLDER:
        pytest.skip("BELTRAMI_MESHES names no folder of meshes")
    mesh = read_mesh(Path(FOLDER) / name)
    assert find_spikes(mesh) is None
    found = find_spikes(spiked(mesh, 0.1)[0])
    assert rms(found.mesh, mesh) < 0.06


def test_the_error_that_is_expected_counts_what_filling_leaves():
    mesh = spiked(creature(2500), 0.1, 0.05)[0]
    found, spikes = blind_choice(mesh, None, 40_000), find_spikes(mesh)
    share = spikes.found.mean()
    of_filling = spikes.error**2 - found.choice.sigma**2
    assert of_filling > 1.2 * found.choice.risk
    assert found.risk == pytest.approx((1 - share) * found.choice.risk + share * of_filling)
