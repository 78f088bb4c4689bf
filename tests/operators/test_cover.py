"""The tufted cover: a closed, oriented surface over any mesh, and the pair made on it."""

import numpy as np
import pytest
from hypothesis import given

import dense_oracles as oracle
import strategies
from beltrami.mesh.mesh import Mesh
from beltrami.operators.cover import tufted_cover
from beltrami.operators.intrinsic import intrinsic_delaunay
from beltrami.operators.laplacian import laplacian
from beltrami.operators.pair import MASSES
from meshes_of_the_errata import MESHES, triangle


def _assert_closed_and_oriented(faces, twins, edges):
    half_edges = np.arange(faces.size)
    flat = twins.ravel()
    assert np.array_equal(flat[flat], half_edges)
    assert (flat != half_edges).all()
    start, end = (np.roll(faces, -k, axis=1).ravel() for k in (1, 2))
    assert np.array_equal(start[flat], end)  # twins run in opposite directions
    assert np.array_equal(edges.ravel()[flat], edges.ravel())
    assert (np.bincount(edges.ravel()) == 2).all()


@pytest.mark.parametrize("name", MESHES)
def test_every_edge_of_the_cover_has_two_faces_that_agree(name):
    topology = MESHES[name]().topology
    faces, twins, edges = tufted_cover(topology)
    _assert_closed_and_oriented(faces, twins, edges)
    m = topology.n_faces
    assert np.array_equal(faces[:m], topology.faces)
    assert np.array_equal(faces[m:], topology.faces[:, [0, 2, 1]])


@given(strategies.arrays(*strategies.CLEAN))
def test_also_over_surfaces_with_one_side_and_faces_turned_at_will(pair):
    mesh = Mesh(*pair)
    rng = np.random.default_rng(mesh.n_faces)
    turned = np.where(rng.random((mesh.n_faces, 1)) < 0.5, mesh.faces[:, ::-1], mesh.faces)
    _assert_closed_and_oriented(*tufted_cover(Mesh(mesh.vertices, turned).topology))


def test_on_the_boundary_a_face_is_glued_to_its_back():
    _, twins, _ = tufted_cover(triangle(60, 60).topology)
    assert twins.tolist() == [[3, 5, 4], [0, 2, 1]]


def test_along_an_edge_of_three_faces_each_goes_on_behind_the_next():
    topology = MESHES["leaves"]().topology
    _, twins, _ = tufted_cover(topology)
    shared = [3 * f + int(np.flatnonzero(topology.face_edges[f] == 0)[0]) for f in range(3)]
    assert (twins.ravel()[shared] // 3 >= 3).all()
    assert sorted((twins.ravel()[shared] // 3 - 3).tolist()) == [0, 1, 2]
    assert all(twins.ravel()[h] // 3 - 3 != h // 3 for h in shared)


@pytest.mark.parametrize("mass", MASSES)
@pytest.mark.parametrize("name", MESHES)
def test_the_pair_has_no_negative_weight_and_the_area_of_the_surface(name, mass):
    mesh = MESHES[name]()
    pair = laplacian(mesh, "tufted", mass)
    assert pair.edge_weight.min() >= 0
    assert pair.properties.non_negative_weights
    L, B = pair.stiffness.toarray(), pair.mass.toarray()
    assert oracle.spectrum(L, B)[-1] <= pair.spectral_bound() * (1 + 1e-9)
    if mass in ("voronoi", "barycentric", "consistent"):
        assert B.sum() == pytest.approx(mesh.area, rel=1e-12)
    if mass == "degree":
        assert np.linalg.eigvalsh(pair.normalized.toarray())[-1] <= 2 + 1e-12
    assert "tufted weights, (cot α + cot β)/2" in repr(pair)


def test_where_no_flip_is_needed_it_is_the_cotangent_pair():
    for mesh in (MESHES["closed"](), MESHES["tor"](), triangle(60, 60), MESHES["pl"]()):
        raw, new = laplacian(mesh), laplacian(mesh, "tufted")
        assert np.allclose(new.stiffness.toarray(), raw.stiffness.toarray(), atol=1e-11)
        assert np.allclose(new.mass.toarray(), raw.mass.toarray(), atol=1e-12)


def test_on_a_closed_surface_front_and_back_are_the_intrinsic_pair():
    plain, both = (laplacian(MESHES["obt"](), kind) for kind in ("intrinsic_delaunay", "tufted"))
    assert both.domain.sheets == 2
    assert both.domain.flips > plain.domain.flips
    assert np.allclose(both.stiffness.toarray(), plain.stiffness.toarray(), atol=1e-10)
    assert np.allclose(both.mass.toarray(), plain.mass.toarray(), atol=1e-12)
    assert np.allclose(
        intrinsic_delaunay(MESHES["obt"]()).area_parts.sum(), both.domain.area_parts.sum()
    )


def test_at_the_boundary_linear_functions_are_not_kept_and_it_says_so():
    mesh = MESHES["open"]()
    pair = laplacian(mesh, "tufted")
    inside = np.setdiff1d(np.arange(mesh.n_vertices), mesh.topology.boundary_edges)
    assert np.abs((pair.stiffness @ mesh.vertices)[inside]).max() > 1e-3
    assert not pair.properties.linear_precision
    assert laplacian(mesh, "intrinsic_delaunay").properties.linear_precision


def test_a_surface_with_one_side_has_a_pair():
    x, f = strategies.moebius(np.random.default_rng(0), 9)
    pair = laplacian(Mesh(x, f), "tufted")
    assert pair.edge_weight.min() >= 0
    assert np.abs(pair.stiffness @ np.ones(pair.n)).max() < 1e-12
