"""The pair of the intrinsic Delaunay triangles, and what the errata (S6) say that it buys."""

import numpy as np
import pytest

import dense_oracles as oracle
from beltrami.errors import NegativeWeightError, UnknownNameError, UnreferencedVertexError
from beltrami.mesh.mesh import Mesh
from beltrami.operators.intrinsic import IntrinsicTriangulation, intrinsic_delaunay
from beltrami.operators.intrinsic_parts import face_pairs
from beltrami.operators.laplacian import laplacian
from beltrami.operators.pair import MASSES
from meshes_of_the_errata import MESHES, flipped, triangle

INTRINSIC = "intrinsic_delaunay"


def _stretched(name, factor):
    mesh = MESHES[name]()
    return mesh.with_vertices(mesh.vertices * np.r_[factor, np.ones(mesh.dimension - 1)])


SURFACES = [(name, 1) for name in MESHES] + [("closed", 100), ("closed", 1e4), ("bad", 20)]


def _dense(triangles, mass):
    """Sum the pairs of the triangles, each drawn in the plane of its own."""
    n = triangles.n_vertices
    L, B = np.zeros((n, n)), np.zeros((n, n))
    for face, sides in zip(triangles.faces, triangles.lengths, strict=True):
        a, b, c = sides
        x = (b * b + c * c - a * a) / (2 * c)
        drawn = Mesh([[0, 0], [c, 0], [x, np.sqrt(b * b - x * x)]], [[0, 1, 2]])
        W = oracle.weights(drawn, "cotangent")
        place = np.zeros((3, n))
        place[np.arange(3), face] = 1
        L += place.T @ oracle.stiffness(W) @ place
        B += place.T @ oracle.masses(drawn, mass, W) @ place
    if mass in ("degree", "unit"):
        B = np.diag(np.diag(L)) if mass == "degree" else np.eye(n)
    return L, B


@pytest.mark.parametrize("mass", MASSES)
@pytest.mark.parametrize(("name", "factor"), SURFACES)
def test_the_pair_against_triangles_drawn_one_by_one(name, factor, mass):
    mesh = _stretched(name, factor)
    pair = laplacian(mesh, INTRINSIC, mass)
    L, B = _dense(pair.domain, mass)
    assert np.allclose(pair.stiffness.toarray(), L, rtol=1e-6, atol=1e-7 * np.abs(L).max())
    assert np.allclose(pair.mass.toarray(), B, rtol=1e-6, atol=1e-7 * B.max())
    assert (pair.edges[:, 0] < pair.edges[:, 1]).all()
    keys = pair.edges @ [mesh.n_vertices, 1]
    assert (np.diff(keys) > 0).all()  # one for each pair of vertices, in order
    if mass in ("voronoi", "barycentric", "consistent"):
        assert pair.mass.sum() == pytest.approx(mesh.area, rel=1e-12)
    true = oracle.spectrum(pair.stiffness.toarray(), pair.mass.toarray())[-1]
    assert true <= pair.spectral_bound() * (1 + 1e-9)
    assert laplacian(mesh, INTRINSIC, "unit").spectral_bound(mass) == pair.spectral_bound()


def test_several_edges_between_two_vertices_are_summed():
    triangles = laplacian(_stretched("closed", 1e4), INTRINSIC).domain
    start, end = (np.roll(triangles.faces, -k, axis=1).ravel() for k in (1, 2))
    loops, pairs = start == end, np.stack([np.minimum(start, end), np.maximum(start, end)])
    assert loops.sum() > 100  # what the test above has summed
    distinct = {tuple(p) for p in pairs[:, ~loops].T.tolist()}
    assert len(distinct) < len(np.unique(triangles.side_edges.ravel()[~loops]))


def test_a_face_that_names_a_vertex_twice_needs_even_shares():
    """With the side from i to i kept, the faces' degrees add to more than D: no bound."""
    triangles = intrinsic_delaunay(_stretched("closed", 1e4))
    pair = laplacian(triangles, mass="degree")
    _, corners = face_pairs(triangles, "degree")
    assert (corners > 0).all()
    three = np.array([len(set(f)) > 1 for f in triangles.faces.tolist()])
    summed = np.bincount(triangles.faces[three].ravel(), corners.ravel(), pair.n)
    assert np.allclose(summed, pair.degrees)
    kept = triangles.half_cotangents
    printed = np.bincount(
        triangles.faces.ravel(), (kept.sum(axis=1, keepdims=True) - kept).ravel(), pair.n
    )
    assert (printed > 1.01 * pair.degrees).any()
    assert pair.spectral_bound() <= 3


def test_a_face_of_one_vertex_brings_nothing_to_the_bound():
    """Faces (0, 0, 0) and (0, 0, 1), equilateral, as they are: only two sides join 0 to 1."""
    dots, double = np.full((2, 3), 0.5), np.full(2, np.sqrt(0.75))
    faces = np.array([[0, 0, 0], [0, 0, 1]])
    none = np.full((2, 3), -1, np.int32)
    triangles = IntrinsicTriangulation(faces, none, none, 0, 2, dots, double)
    cot = 1 / np.sqrt(3)
    for mass, corners in (("degree", [cot / 2, cot / 2, cot]), ("unit", [0.2, 0.2, 1])):
        sides, masses = face_pairs(triangles, mass)
        assert np.allclose(sides, [[cot / 2, cot / 2, 0]])
        assert np.allclose(masses, [corners])


def test_in_the_plane_it_is_the_cotangent_pair_of_the_delaunay_mesh():
    for mass in MASSES:
        one, two = (
            laplacian(MESHES["bad"](), INTRINSIC, mass),
            laplacian(MESHES["open"](), None, mass),
        )
        assert np.array_equal(one.edges, two.edges)
        assert np.allclose(one.stiffness.toarray(), two.stiffness.toarray(), atol=1e-11)
        assert np.allclose(one.mass.toarray(), two.mass.toarray(), atol=1e-12)
        assert one.spectral_bound() == pytest.approx(two.spectral_bound(), rel=1e-9)
    raw = laplacian(MESHES["bad"]())
    assert abs(raw.stiffness - two.stiffness).max() > 1


# ------------------------------------------------------------------------------ S6


@pytest.mark.parametrize(("name", "factor"), [("closed", 1), ("obt", 1), ("closed", 1e4)])
def test_no_weight_of_a_closed_mesh_is_negative(name, factor):
    pair = laplacian(_stretched(name, factor), INTRINSIC, "degree")
    assert pair.edge_weight.min() >= 0
    assert pair.properties.non_negative_weights
    assert pair.averaging.min() >= 0
    values = np.linalg.eigvalsh(pair.normalized.toarray())
    assert values[-1] <= 2  # theorem 9 again
    if name == "obt":
        raw = laplacian(MESHES["obt"](), "cotangent", "degree")
        assert (raw.edge_weight < 0).sum() > 100
        assert np.linalg.eigvalsh(raw.normalized.toarray())[-1] > values[-1] + 0.1


@pytest.mark.parametrize("name", ["bad", "open", "cur"])
def test_on_the_boundary_obtuse_angles_stay(name):
    mesh = MESHES[name]()
    pair = laplacian(mesh, INTRINSIC, "degree")
    boundary = {tuple(edge) for edge in mesh.topology.boundary_edges.tolist()}
    negative = pair.properties.negative_edges.tolist()
    assert len(negative) == 11
    assert all(tuple(edge) in boundary for edge in negative)
    with pytest.raises(NegativeWeightError) as caught:
        _ = pair.averaging
    assert caught.value.edges.tolist() == negative


def test_linear_functions_are_harmonic_inside_a_planar_mesh():
    for mesh in (MESHES["bad"](), flipped(3, aspect=0.15)):
        pair = laplacian(mesh, INTRINSIC)
        inside = np.setdiff1d(np.arange(mesh.n_vertices), mesh.topology.boundary_edges)
        assert np.abs((pair.stiffness @ mesh.vertices)[inside]).max() < 1e-11
        assert pair.dirichlet_energy(mesh.vertices[:, 0]) == pytest.approx(mesh.area)
        assert pair.properties.linear_precision


def test_flips_only_lower_the_energy():
    """Theorem of Rippa: among all triangulations the Delaunay one has the least energy."""
    for name in ("obt", "bad", "cur"):
        mesh = MESHES[name]()
        raw, new = laplacian(mesh, "cotangent"), laplacian(mesh, INTRINSIC)
        for f in oracle.rough_functions(mesh).T:
            assert new.dirichlet_energy(f) < raw.dirichlet_energy(f)
        smallest = np.linalg.eigvalsh((raw.stiffness - new.stiffness).toarray())[0]
        assert smallest > -1e-9


def test_neumann_eigenvalues_of_the_square():
    exact = np.pi**2 * np.array([0, 1, 1, 2, 4, 4, 5, 5])
    pair = laplacian(MESHES["bad"](), INTRINSIC, "barycentric")
    values = oracle.spectrum(pair.stiffness.toarray(), pair.mass.toarray())[:8]
    assert np.abs(values[1:] / exact[1:] - 1).max() < 0.1
    clamped = np.where(laplacian(MESHES["bad"]()).weights.toarray() < 0, 0, 1)
    L = oracle.stiffness(laplacian(MESHES["bad"]()).weights.toarray() * clamped)
    worst = oracle.spectrum(L, pair.mass.toarray())[:8]
    assert np.abs(worst[1:] / exact[1:] - 1).max() > 0.5  # what clamping costs


def test_heat_obeys_the_maximum_principle_on_a_closed_mesh():
    mesh = MESHES["obt"]()
    for weights, holds in (("cotangent", False), (INTRINSIC, True)):
        pair = laplacian(mesh, weights, "barycentric")
        step = np.linalg.inv(pair.mass.toarray() + 1e-3 * pair.stiffness.toarray())
        assert bool(step.min() > -1e-12) is holds


# ------------------------------------------------------------------------------ the door


def test_names_and_repr():
    mesh = MESHES["obt"]()
    pair = laplacian(mesh, INTRINSIC)
    assert (pair.weight_kind, pair.mass_kind) == (INTRINSIC, "voronoi")
    assert "intrinsic_delaunay weights, (cot α + cot β)/2, voronoi mass" in repr(pair)
    assert repr(pair).endswith("positive semi-definite>")
    same = laplacian(pair.domain, mass="voronoi")
    assert np.array_equal(same.stiffness.toarray(), pair.stiffness.toarray())
    for wrong in (lambda: laplacian(mesh, "intrinsic"), lambda: laplacian(mesh, INTRINSIC, "area")):
        with pytest.raises(UnknownNameError):
            wrong()
    with pytest.raises(UnknownNameError):
        laplacian(pair.domain, "cotangent")
    with pytest.raises(UnknownNameError):
        laplacian(mesh.topology, INTRINSIC)


def test_defects_and_small_meshes():
    with pytest.raises(UnreferencedVertexError):
        laplacian(Mesh([[0, 0], [1, 0], [0, 1], [5, 5]], [[0, 1, 2]]), INTRINSIC)
    one = triangle(15, 150)
    assert np.allclose(
        laplacian(one, INTRINSIC).weights.toarray(), laplacian(one).weights.toarray()
    )
    leaves = MESHES["leaves"]()
    assert np.allclose(
        laplacian(leaves, INTRINSIC).stiffness.toarray(), laplacian(leaves).stiffness.toarray()
    )
