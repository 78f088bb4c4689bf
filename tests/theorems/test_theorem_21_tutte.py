"""Theorem 21: convex combinations are bijections, on the conditions of E89."""

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltrami.errors import BoundaryCurveError
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import disk
from beltrami.operators.weights import edge_weights
from beltrami.parameterization.boundary import place_boundary, refuse_dividing_edges
from beltrami.parameterization.certificate import certify
from beltrami.parameterization.harmonic import harmonic, solve_harmonic
from beltrami.parameterization.parameterize import parameterize
from meshes_of_the_errata import bad, cur, open_, tor
from strategies import arrays, sheet

KINDS = ("combinatorial", "distance", "mean_value", "clamped")


def image_area(mesh, x):
    a, b, c = x[mesh.faces].transpose(1, 0, 2)
    u, v = b - a, c - a
    return (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]) / 2


def polygon_area(p):
    q = np.roll(p, -1, axis=0)
    return float((p[:, 0] * q[:, 1] - p[:, 1] * q[:, 0]).sum() / 2)


@pytest.mark.chapter("T21")
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("make", [open_, cur, bad], ids=lambda make: make.__name__)
def test_positive_weights_and_a_convex_curve_give_a_bijection(make, kind):
    mesh = make()
    psi = parameterize(mesh, "tutte", kind)
    areas = image_area(mesh, psi.uv)
    assert psi.is_bijective
    assert (areas > 0).all()
    rim = psi.uv[mesh.boundary_loops[0]]
    assert areas.sum() == pytest.approx(polygon_area(rim), rel=1e-13)


@pytest.mark.chapter("T21")
@pytest.mark.parametrize("make", [open_, cur, bad], ids=lambda make: make.__name__)
@pytest.mark.parametrize("curve", ["square", 3, 5, 6, 8])
def test_curves_with_straight_sides_are_refused_just_where_edges_divide_them(make, curve):
    """E89, which the printed theorem leaves out: then some face has no area."""
    mesh = make()
    (loop,) = mesh.boundary_loops
    placed = place_boundary(mesh, loop, curve)
    areas = image_area(mesh, harmonic(mesh, loop, placed, "combinatorial"))
    if areas.min() > 1e-15:
        assert areas.min() > 1e-6
        refuse_dividing_edges(mesh, loop, placed)
        assert parameterize(mesh, "tutte", "combinatorial", curve).is_bijective
        return
    with pytest.raises(BoundaryCurveError) as caught:
        refuse_dividing_edges(mesh, loop, placed)
    assert np.isin(caught.value.edges, loop).all()


def test_both_kinds_of_curves_are_among_these():
    """Lest the test above tells of one of them alone."""
    mesh = open_()
    with pytest.raises(BoundaryCurveError):
        parameterize(mesh, boundary=5)
    assert parameterize(mesh, boundary="square").is_bijective


@pytest.mark.chapter("T21")
@given(arrays(sheet), st.integers(0, 10**6))
def test_weights_need_no_symmetry(pair, seed):
    """E89: any positive weights, different in the two directions of an edge."""
    x, faces = pair
    used, local = np.unique(faces, return_inverse=True)
    mesh = Mesh(x[used], local.reshape(-1, 3))
    (loop,) = mesh.boundary_loops
    W = edge_weights(mesh.topology, "combinatorial").copy()
    W.data = 10.0 ** np.random.default_rng(seed).uniform(-2, 2, len(W.data))
    placed = place_boundary(mesh, loop)
    assert certify(mesh.topology, solve_harmonic(W, loop, placed, mesh.vertices)).is_bijective


@pytest.mark.chapter("T21")
def test_weights_between_boundary_vertices_do_not_enter():
    """The printed hypothesis, w > 0 on all of E, asks for more than there need be."""
    mesh = open_()
    (loop,) = mesh.boundary_loops
    placed = place_boundary(mesh, loop)
    W = edge_weights(mesh, "combinatorial").copy()
    psi = solve_harmonic(W, loop, placed, mesh.vertices)
    i = np.repeat(np.arange(mesh.n_vertices), np.diff(W.indptr))
    both = np.isin(i, loop) & np.isin(W.indices, loop)
    assert both.any()
    W.data[both] = -100
    np.testing.assert_array_equal(solve_harmonic(W, loop, placed, mesh.vertices), psi)


@pytest.mark.chapter("T21", "P73")
def test_the_curve_must_be_convex_and_go_around_once():
    mesh = open_()
    (loop,) = mesh.boundary_loops
    t = 2 * np.pi * np.arange(len(loop)) / len(loop)
    circle = np.stack([np.cos(t), np.sin(t)], axis=1)
    star = circle * (1 + 0.6 * np.cos(8 * t))[:, None]
    folded = certify(mesh.topology, harmonic(mesh, loop, star, "combinatorial"))
    assert len(folded.crossings) == 0  # the curve itself is simple
    assert len(folded.flipped) > 10
    twice = harmonic(mesh, loop, np.stack([np.cos(2 * t), np.sin(2 * t)], axis=1), "combinatorial")
    assert not certify(mesh.topology, twice + 0.0).is_bijective
    assert certify(mesh.topology, harmonic(mesh, loop, circle, "combinatorial")).is_bijective


@pytest.mark.chapter("T21")
def test_the_surface_must_be_a_disk():
    """A torus less two faces that share an edge has one boundary loop, and no bijection."""
    torus = tor()
    across = int(torus.topology.twins[0, 0]) // 3
    mesh = Mesh(torus.vertices, np.delete(torus.faces, [0, across], axis=0))
    (loop,) = mesh.boundary_loops
    placed = place_boundary(mesh, loop)
    psi = harmonic(mesh, loop, placed, "combinatorial")
    assert len(certify(mesh.topology, psi).flipped) > 100


@pytest.mark.chapter("U39", "R5", "P72")
@pytest.mark.parametrize("kind", [*KINDS, "cotangent"])
def test_inner_vertices_are_means_and_boundary_vertices_are_not(kind):
    """E88: the printed remark says it of all vertices."""
    mesh = cur()
    (loop,) = mesh.boundary_loops
    psi = harmonic(mesh, loop, place_boundary(mesh, loop), kind)
    W = edge_weights(mesh, kind)
    means = (W @ psi) / W.sum(axis=1)[:, None]
    residual = np.abs(means - psi).max(axis=1)
    inner = np.setdiff1d(np.arange(mesh.n_vertices), loop)
    assert residual[inner].max() < 1e-14
    assert residual[loop].max() > 0.05


@pytest.mark.chapter("U39")
@pytest.mark.parametrize("kind", ["mean_value", "cotangent"])
@pytest.mark.parametrize("make", [open_, bad], ids=lambda make: make.__name__)
def test_linear_functions_are_kept_on_planar_meshes(make, kind):
    mesh = make()
    (loop,) = mesh.boundary_loops
    x = mesh.vertices
    assert np.abs(harmonic(mesh, loop, x[loop], kind) - x).max() < 1e-13
    assert np.abs(harmonic(mesh, loop, x[loop], "combinatorial") - x).max() > 1e-3


@pytest.mark.chapter("P74")
def test_negative_weights_need_more_than_an_obtuse_angle():
    """E90: inner edges have one iff the angles add to more than π; obtuse alone does not do it."""
    mesh = bad()
    W = edge_weights(mesh, "cotangent")
    i, j = mesh.edges.T
    weights = np.asarray(W[i, j])
    angles = np.zeros(len(mesh.edges))
    np.add.at(angles, mesh.topology.face_edges.ravel(), mesh.corner_angles.ravel())
    inner = mesh.topology.edge_face_count == 2
    limit = np.where(inner, np.pi, np.pi / 2)
    np.testing.assert_array_equal(weights < 0, angles > limit)
    obtuse = int(np.count_nonzero(mesh.corner_angles > np.pi / 2))
    assert np.count_nonzero(weights < 0) < obtuse


@pytest.mark.chapter("P74")
def test_tall_shapes_are_clustered():
    """E91: on a capped cylinder of height h areas shrink as e^(-2h), by linear weights."""
    ratios = []
    for rings in (0, 12, 24, 36):
        base = disk(6)
        around = 36
        loop = base.boundary_loops[0]
        assert len(loop) == around
        height = 2 * np.pi / around
        rim = base.vertices[loop]
        levels = [np.column_stack([rim, np.full(around, -k * height)]) for k in range(1, rings + 1)]
        x = np.concatenate([np.column_stack([base.vertices, np.zeros(base.n_vertices)]), *levels])
        number = [loop, *(base.n_vertices + around * k + np.arange(around) for k in range(rings))]
        faces = [base.faces]
        for upper, lower in itertools.pairwise(number):
            ahead, below = np.roll(upper, -1), np.roll(lower, -1)
            faces += [np.stack([upper, lower, below], 1), np.stack([upper, below, ahead], 1)]
        mesh = Mesh(x, np.concatenate(faces))
        psi = parameterize(mesh, "tutte", "cotangent")
        assert psi.is_bijective
        ratios.append(psi.distortion.area.max() / psi.distortion.area.min())
    h = 12 * 2 * np.pi / 36
    growth = np.diff(np.log(ratios[1:])) / (2 * h)
    np.testing.assert_allclose(growth, 1, atol=0.1)
