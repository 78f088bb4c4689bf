"""Every surface becomes disks, and nothing but the chosen edges opens."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from beltrami.errors import (
    EmptyMeshError,
    NonFiniteError,
    NotOrientableError,
    UnreferencedVertexError,
)
from beltrami.mesh.cut import cut_along
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import blob, cube, cylinder, disk, grid, icosphere, tetrahedron, torus
from beltrami.mesh.tree_cotree import cut_to_disk
from strategies import arrays, hull, moebius, ring_torus


def holed(mesh, *faces):
    return Mesh(mesh.vertices, np.delete(mesh.faces, faces, axis=0))


def two(one, other):
    x = np.concatenate([one.vertices, other.vertices + 9])
    return Mesh(x, np.concatenate([one.faces, other.faces + one.n_vertices]))


def double_torus():
    """Two tori joined along the three edges of a face."""
    one = torus(9, 6)
    n, face = one.n_vertices, one.faces[0]
    number = np.arange(2 * n)
    number[face + n] = face
    mirrored = one.faces[1:, [0, 2, 1]] + n
    other = one.vertices * [1, 1, -1]
    faces = np.concatenate([one.faces[1:], number[mirrored]])
    kept = np.unique(faces)
    place = np.full(2 * n, -1)
    place[kept] = np.arange(len(kept))
    return Mesh(np.concatenate([one.vertices, other])[kept], place[faces])


SURFACES = {
    "sphere": icosphere(2),
    "tetrahedron": tetrahedron(),
    "cube": cube(),
    "torus": torus(12, 8),
    "genus 2": double_torus(),
    "torus with three holes": holed(torus(12, 8), 0, 50, 101),
    "cylinder": cylinder(),  # all ways down are equally long
    "sphere with four holes": holed(icosphere(2), 0, 90, 200, 300),
    "sphere with holes that touch": holed(icosphere(1), 0, 21),
    "torus and sphere": two(torus(8, 5), icosphere(1)),
    "disk": disk(3),
}


def check(mesh, cut):
    """What a cut into disks is, whatever made it."""
    topology = cut.mesh.topology
    np.testing.assert_array_equal(cut.vertex_map[cut.mesh.faces], mesh.faces)
    np.testing.assert_array_equal(cut.mesh.vertices, mesh.vertices[cut.vertex_map])
    np.testing.assert_array_equal(cut.vertex_map[: mesh.n_vertices], np.arange(mesh.n_vertices))
    assert topology.is_manifold
    labels = cut.mesh.components()
    loops = topology.boundary_loops
    assert len(loops) == topology.n_components
    for component in range(topology.n_components):
        part = Mesh(cut.mesh.vertices, cut.mesh.faces[labels == component])
        assert part.euler_characteristic == 1
        assert len(part.boundary_loops) == 1
        assert len(part.boundary_loops[0]) >= 3
    opened = np.sort(cut.vertex_map[cut.mesh.topology.boundary_edges], axis=1)
    was = {tuple(edge) for edge in mesh.topology.boundary_edges.tolist()}
    told = {tuple(edge) for edge in cut.edges.tolist()}
    assert {tuple(edge) for edge in opened.tolist()} == was | told
    assert not was & told


@pytest.mark.chapter("P69")
@pytest.mark.parametrize("name", SURFACES)
def test_each_component_becomes_a_disk(name):
    mesh = SURFACES[name]
    check(mesh, cut_to_disk(mesh))


@pytest.mark.chapter("P69")
def test_genus_two_is_what_it_says():
    assert SURFACES["genus 2"].genus == 2
    assert SURFACES["genus 2"].is_oriented


@given(arrays(hull, ring_torus), st.integers(0, 10**6), st.floats(0, 0.5))
@settings(max_examples=60)
def test_with_random_holes(pair, seed, share):
    """Holes may touch, and may cut the surface apart: any manifold pieces."""
    x, faces = pair
    kept = faces[np.random.default_rng(seed).random(len(faces)) >= share]
    if not len(kept):
        return
    used, local = np.unique(kept, return_inverse=True)
    mesh = Mesh(x[used], local.reshape(-1, 3))
    cut = cut_to_disk(mesh)
    if mesh.is_manifold:
        check(mesh, cut)
    assert cut.mesh.is_manifold
    assert cut.mesh.euler_characteristic == cut.mesh.topology.n_components


def test_a_disk_is_left_alone():
    mesh = grid(4, 3)
    cut = cut_to_disk(mesh)
    assert len(cut.edges) == 0
    np.testing.assert_array_equal(cut.mesh.faces, mesh.faces)


def test_the_cut_is_short():
    """A torus 3 times as long as thick: the loops are the thin one and a long one."""
    mesh = torus(36, 12)
    assert len(cut_to_disk(mesh).edges) <= 36 + 12
    mesh = cylinder(32, 10)
    assert len(cut_to_disk(mesh).edges) == 10  # straight down


def test_data_and_texture_go_along():
    mesh = torus(8, 6).with_data(f=np.arange(48.0))
    uv = np.random.default_rng(0).random((mesh.n_faces, 3, 2))
    mesh = Mesh(mesh.vertices, mesh.topology, dict(mesh.vertex_data), uv)
    cut = cut_to_disk(mesh)
    np.testing.assert_array_equal(cut.mesh.vertex_data["f"], cut.vertex_map)
    np.testing.assert_array_equal(cut.mesh.corner_uv, uv)


def test_what_is_no_manifold_is_cut_apart():
    leaves = Mesh(np.eye(5, 3), [[0, 1, 2], [0, 1, 3], [1, 0, 4]])
    cut = cut_to_disk(leaves)
    assert cut.mesh.topology.n_components == 3
    assert cut.edges.tolist() == [[0, 1]]
    bow_tie = Mesh(np.eye(5, 3), [[0, 1, 2], [0, 3, 4]])
    assert cut_to_disk(bow_tie).mesh.n_vertices == 6


def test_cutting_one_edge_inside_opens_nothing_and_two_open_a_slit():
    mesh = grid(4, 4)
    edges = mesh.edges.tolist()
    chosen = np.zeros(len(edges), bool)
    inside = np.setdiff1d(np.arange(mesh.n_vertices), mesh.boundary_loops[0])
    inner = [q for q, e in enumerate(edges) if e[0] in inside and e[1] in inside]
    chosen[inner[0]] = True
    assert cut_along(mesh, chosen).mesh.n_vertices == mesh.n_vertices
    middle = edges[inner[0]][0]
    second = next(q for q in inner[1:] if middle in edges[q])
    chosen[second] = True
    assert cut_along(mesh, chosen).mesh.n_vertices == mesh.n_vertices + 1


def test_bad_input():
    x, faces = moebius(np.random.default_rng(0), 8)
    with pytest.raises(NotOrientableError, match="one side only"):
        cut_to_disk(Mesh(x, faces))
    sphere = icosphere(1)
    turned = sphere.faces.copy()
    turned[3] = turned[3][[0, 2, 1]]
    with pytest.raises(NotOrientableError, match="orient=True"):
        cut_to_disk(Mesh(sphere.vertices, turned))
    with pytest.raises(EmptyMeshError):
        cut_to_disk(Mesh(np.zeros((0, 3)), np.zeros((0, 3), int)))
    with pytest.raises(UnreferencedVertexError) as caught:
        cut_to_disk(Mesh(np.concatenate([sphere.vertices, np.zeros((1, 3))]), sphere.faces))
    assert caught.value.vertices.tolist() == [sphere.n_vertices]
    x = sphere.vertices.copy()
    x[4] = np.nan
    with pytest.raises(NonFiniteError):
        cut_to_disk(Mesh(x, sphere.faces))


@pytest.mark.parametrize("unit", [1e-9, 1.0, 1e9])
def test_the_unit_does_not_matter(unit):
    mesh = blob(2000)
    found = cut_to_disk(mesh.with_vertices(mesh.vertices * unit))
    np.testing.assert_array_equal(found.edges, cut_to_disk(mesh).edges)
