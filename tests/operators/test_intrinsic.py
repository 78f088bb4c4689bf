"""The intrinsic Delaunay triangulation: the same surface, other edges."""

import pickle
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import Delaunay

import strategies
from beltrami.errors import (
    ConvergenceError,
    DegenerateFaceError,
    EmptyMeshError,
    NonFiniteError,
    NotOrientableError,
    UnreferencedVertexError,
)
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import grid, icosphere
from beltrami.operators import intrinsic
from beltrami.operators.intrinsic import intrinsic_delaunay
from meshes_of_the_errata import MESHES, triangle


def stretched(name, factor):
    mesh = MESHES[name]()
    return mesh.with_vertices(mesh.vertices * np.r_[factor, np.ones(mesh.dimension - 1)])


SURFACES = [(name, 1) for name in MESHES] + [("closed", 100), ("bad", 30), ("closed", 1e4)]


def _total_angles(faces, dots, double, n):
    angles = np.arctan2(double[:, None], dots)
    return np.bincount(faces.ravel(), angles.ravel(), n)


@pytest.mark.parametrize(("name", "factor"), SURFACES)
def test_the_surface_stays_and_every_inner_edge_is_delaunay(name, factor):
    mesh = stretched(name, factor)
    new = intrinsic_delaunay(mesh)
    assert new.face_areas.sum() == pytest.approx(mesh.area, rel=1e-12)
    before = np.bincount(mesh.faces.ravel(), mesh.corner_angles.ravel(), mesh.n_vertices)
    after = _total_angles(new.faces, new.dots, new.double_areas, mesh.n_vertices)
    assert np.allclose(after, before, atol=1e-9)  # the curvature of each vertex
    twins, lengths, halves = (a.ravel() for a in (new.twins, new.lengths, new.half_cotangents))
    inner = np.flatnonzero(twins >= 0)
    across = twins[inner]
    assert np.array_equal(twins[across], inner)
    assert np.allclose(lengths[inner], lengths[across], rtol=1e-10)
    terms = np.abs(halves[inner]) + np.abs(halves[across])
    assert (halves[inner] + halves[across] >= -1e-13 * (1 + terms)).all()
    assert (np.bincount(new.side_edges.ravel()) == mesh.topology.edge_face_count).all()
    if new.flips == 0:
        assert np.array_equal(new.faces, mesh.faces)


def test_in_the_plane_it_is_the_delaunay_triangulation():
    new, expected = intrinsic_delaunay(MESHES["bad"]()), MESHES["open"]()
    as_sets = lambda faces: {tuple(sorted(f)) for f in faces.tolist()}  # noqa: E731
    assert new.flips > 100
    assert as_sets(new.faces) == as_sets(expected.faces)
    assert as_sets(MESHES["bad"]().faces) != as_sets(expected.faces)


def test_a_long_thin_surface_gets_edges_from_a_vertex_to_itself():
    new = intrinsic_delaunay(stretched("closed", 1e4))
    assert (new.faces == np.roll(new.faces, 1, axis=1)).sum() > 100
    assert new.flips < 3 * 894


def test_edges_on_one_circle_are_left_alone():
    for mesh in (grid(9, 7), MESHES["tor"](), MESHES["pl"]()):
        turned = mesh.with_vertices(
            mesh.vertices @ np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
            if mesh.dimension == 3
            else mesh.vertices @ [[0.6, 0.8], [-0.8, 0.6]]
        )
        assert intrinsic_delaunay(turned).flips == 0


def test_edges_of_more_than_two_faces_are_left_alone():
    x = [[0, 0, 0], [4, 0, 0], [2, 0.5, 0], [2, -0.5, 0], [2, 0, 0.5]]
    fins = Mesh(x, [[0, 1, 2], [0, 1, 3], [0, 1, 4]])  # all three obtuse at the edge 01
    new = intrinsic_delaunay(fins)
    assert new.flips == 0
    assert (new.twins == -2).sum() == 3


@given(strategies.arrays(strategies.hull, strategies.sheet, strategies.ring_torus))
def test_faces_that_disagree_are_turned_first(pair):
    mesh = Mesh(*pair)
    rng = np.random.default_rng(mesh.n_faces)
    turned = np.where(rng.random((mesh.n_faces, 1)) < 0.5, mesh.faces[:, ::-1], mesh.faces)
    x = mesh.vertices[np.unique(mesh.faces)]
    index = np.cumsum(np.isin(np.arange(mesh.n_vertices), mesh.faces)) - 1
    one = intrinsic_delaunay(Mesh(x, index[mesh.faces]))
    two = intrinsic_delaunay(Mesh(x, index[turned]))
    assert np.allclose(np.sort(one.face_areas), np.sort(two.face_areas))


def test_a_surface_with_one_side_is_refused():
    x, f = strategies.moebius(np.random.default_rng(0), 9)
    with pytest.raises(NotOrientableError) as caught:
        intrinsic_delaunay(Mesh(x, f))
    assert len(caught.value.edges)


@pytest.mark.parametrize("unit", [1e-120, 1e-9, 1e9, 1e120])
def test_the_unit_of_length_does_not_count(unit):
    mesh = MESHES["obt"]()
    new, other = (
        intrinsic_delaunay(mesh),
        intrinsic_delaunay(mesh.with_vertices(unit * mesh.vertices)),
    )
    assert other.flips == new.flips
    assert np.allclose(other.lengths / unit, new.lengths, rtol=1e-9)
    assert np.allclose(other.face_areas / unit / unit, new.face_areas, rtol=1e-9)
    assert np.allclose(other.half_cotangents, new.half_cotangents, rtol=1e-6, atol=1e-9)


def test_five_dimensions():
    mesh = MESHES["obt"]()
    rotation = np.linalg.qr(np.random.default_rng(837465).normal(size=(5, 5)))[0]
    embedded = mesh.with_vertices(mesh.vertices @ rotation[:3])
    new, other = intrinsic_delaunay(mesh), intrinsic_delaunay(embedded)
    assert np.array_equal(new.faces, other.faces)
    assert np.allclose(new.lengths, other.lengths, rtol=1e-10)


@given(st.integers(0, 2**40), st.sampled_from([1e-3, 1e-5, 1e-6]))
def test_needles_keep_their_digits(seed, height):
    """Points near a line: lengths alone would know the areas to 1e-16 / height² only."""
    rng = np.random.default_rng(seed)
    t = np.sort(rng.uniform(0, 1, 12)) + np.arange(12) * 0.05
    upper = np.column_stack([t, height * (1 + rng.random(12))])
    lower = np.column_stack([t + 0.01, np.zeros(12)])
    k = np.arange(11)
    mesh = Mesh(
        np.concatenate([upper, lower]),
        np.concatenate([np.stack([k, 12 + k, 13 + k], 1), np.stack([k, 13 + k, k + 1], 1)]),
    )
    new = intrinsic_delaunay(mesh)
    x = mesh.vertices[new.faces]
    u, v = x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]
    assert np.allclose(new.double_areas, u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0], rtol=1e-9)


def test_it_is_frozen_and_pickled():
    new = intrinsic_delaunay(MESHES["obt"]())
    with pytest.raises(AttributeError):
        new.flips = 3
    with pytest.raises(ValueError, match="read-only"):
        new.faces[0, 0] = 1
    again = pickle.loads(pickle.dumps(new))  # noqa: S301
    assert np.array_equal(again.twins, new.twins)
    assert repr(new) == f"<IntrinsicTriangulation: 300 vertices, 596 faces, {new.flips} flips>"


def test_defects_are_named(monkeypatch):
    x = [[0, 0], [1, 0], [0, 1], [2, 0], [1, 1]]
    with pytest.raises(EmptyMeshError):
        intrinsic_delaunay(Mesh(x, []))
    with pytest.raises(DegenerateFaceError) as caught:
        intrinsic_delaunay(Mesh(x, [[0, 1, 2], [0, 1, 3], [1, 4, 2]]))
    assert caught.value.faces.tolist() == [1]
    with pytest.raises(UnreferencedVertexError) as caught:
        intrinsic_delaunay(Mesh(x, [[0, 1, 2]]))
    assert caught.value.vertices.tolist() == [3, 4]
    with pytest.raises(NonFiniteError):
        intrinsic_delaunay(Mesh([[0, 0], [1, 0], [np.nan, 1]], [[0, 1, 2]]))
    assert intrinsic_delaunay(triangle(15, 150)).flips == 0
    monkeypatch.setattr(intrinsic, "_MOST", 0)
    with pytest.raises(ConvergenceError, match="flips"):
        intrinsic_delaunay(MESHES["bad"]())


def test_needles_whose_area_flips_lose_are_refused():
    rng = np.random.default_rng(5)
    x = rng.uniform(-1, 1, size=(14, 2))
    faces = Delaunay(x).simplices
    found = 0
    for thin in (1e-6, 1e-9, 6e-10):
        mesh = Mesh(x * [1, thin], faces)
        try:
            triangles = intrinsic_delaunay(mesh, cover=True)
        except ConvergenceError:
            found += 1
            continue
        assert triangles.area_parts.sum() == pytest.approx(mesh.area, rel=1e-6)
    assert found


@pytest.mark.parametrize("thin", [1e-7, 1e-9, 1e-10])
def test_flips_in_the_plane_are_exact_however_thin_the_faces(thin):
    """Against fractions: lengths, areas and cotangents of the triangles that it ends with."""
    mesh = MESHES["open"]()
    mesh = mesh.with_vertices(mesh.vertices * [1, thin])
    new = intrinsic_delaunay(mesh)
    assert new.flips > 500
    for f in range(0, len(new.faces), 7):
        x = [[Fraction(c) for c in mesh.vertices[v].tolist()] for v in new.faces[f]]
        sides = [[b - a for a, b in zip(x[k], x[(k + 1) % 3], strict=True)] for k in range(3)]
        (ux, uy), (vx, vy), (wx, wy) = sides
        double = ux * vy - uy * vx
        assert new.double_areas[f] == pytest.approx(float(double), rel=1e-9)
        cotangents = [-(ux * wx + uy * wy), -(vx * ux + vy * uy), -(wx * vx + wy * vy)]
        wanted = [float(dot / double) for dot in cotangents]
        assert 2 * new.half_cotangents[f] == pytest.approx(wanted, rel=1e-8, abs=1e-8)


@pytest.mark.parametrize("thin", [1e-9, 3e-10, 3e-11, 1e-11])
@pytest.mark.parametrize("cover", [False, True])
def test_a_surface_too_thin_to_go_round_is_refused_in_one_line(thin, cover):
    """Edges around a spindle are 1e-9 times as long as it: their squares vanish beside its own."""
    spindle = icosphere(2)
    spindle = spindle.with_vertices(spindle.vertices * [1, thin, thin])
    with pytest.raises(ConvergenceError, match="faces are too thin to be flipped") as caught:
        intrinsic_delaunay(spindle, cover=cover)
    assert "\n" not in str(caught.value)
