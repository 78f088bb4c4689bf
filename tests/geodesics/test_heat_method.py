"""The heat method against numpy, against exact distances, and what must not matter."""

import numpy as np
import pytest

import strategies
from beltrami.errors import BeltramiError, ConvergenceError, UnknownNameError
from beltrami.geodesics.distance import geodesic_distance
from beltrami.geodesics.heat_method import HeatMethod, _unit_flux
from beltrami.mesh import shapes
from beltrami.mesh.mesh import Mesh
from beltrami.operators.bounds import side_weights
from beltrami.operators.gradient import face_divergence, face_gradient
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import MESHES
from surfaces_to_walk_on import maze, shuffled


def mean_error(found, exact):
    """Mean of the errors over the mean of the distances."""
    return np.abs(found - exact).mean() / exact.mean()


def _by_numpy(mesh, sources, time):
    """The three steps as they are printed, with vectors and dense matrices."""
    pair = laplacian(mesh)
    L, B = pair.stiffness.toarray(), pair.mass.toarray()
    delta = np.zeros(mesh.n_vertices)
    delta[sources] = 1
    u = np.linalg.solve(B + time * L, delta)
    slope = (face_gradient(mesh) @ u).reshape(mesh.dimension, -1)
    X = -slope / np.linalg.norm(slope, axis=0)
    phi = -np.linalg.pinv(L, rcond=1e-12) @ (face_divergence(mesh) @ X.ravel())
    return phi - phi[sources].min()


@pytest.mark.parametrize("name", MESHES)
def test_against_the_three_steps_in_numpy(name):
    mesh = MESHES[name]()
    for sources in ([0], [2, mesh.n_vertices - 1]):
        method = HeatMethod(mesh, intrinsic=False)
        assert method.time == pytest.approx(mesh.edge_lengths.mean() ** 2)
        expected = _by_numpy(mesh, sources, method.time)
        assert np.allclose(method.distance(sources), expected, atol=1e-8 * np.abs(expected).max())


@pytest.mark.parametrize("name", ["obt", "open", "leaves"])
def test_the_flux_is_the_divergence_of_unit_vectors(name):
    mesh = MESHES[name]()
    u = np.random.default_rng(4).normal(size=mesh.n_vertices)
    reached = np.ones(mesh.n_vertices, bool)
    halves = side_weights(mesh, np.zeros(0), "cotangent")
    flux, cold = _unit_flux(mesh.faces, halves, mesh.face_areas, u, reached)
    slope = (face_gradient(mesh) @ u).reshape(mesh.dimension, -1)
    X = -slope / np.linalg.norm(slope, axis=0)
    assert np.allclose(flux, face_divergence(mesh) @ X.ravel(), atol=1e-9)
    assert cold == 0
    tiny, _ = _unit_flux(mesh.faces, halves, mesh.face_areas, 1e-250 * u, reached)
    assert np.allclose(tiny, flux, atol=1e-9)  # the squares of the slopes are no numbers


@pytest.mark.parametrize("name", ["closed", "obt", "open", "bad", "cur"])
@pytest.mark.parametrize("source", [0, 100])
def test_near_the_exact_distances_on_irregular_meshes(name, source):
    mesh = MESHES[name]()
    exact = geodesic_distance(mesh, source, method="exact")
    assert mean_error(geodesic_distance(mesh, source), exact) < 0.045


@pytest.mark.parametrize("name", ["obt", "bad", "cur"])
def test_obtuse_faces_at_the_source_need_intrinsic_triangles(name):
    mesh = MESHES[name]()
    exact = geodesic_distance(mesh, 0, method="exact")
    raw, new = (mean_error(geodesic_distance(mesh, 0, intrinsic=i), exact) for i in (False, True))
    assert new < 0.03
    assert raw > 10 * new


def test_intrinsic_triangles_are_the_same_heat_on_a_delaunay_mesh():
    mesh = MESHES["closed"]()
    one, two = (geodesic_distance(mesh, 3, intrinsic=i) for i in (False, True))
    assert np.allclose(one, two, atol=1e-10)
    assert HeatMethod(mesh).time == pytest.approx(HeatMethod(mesh, intrinsic=False).time)


def test_intrinsic_triangles_cover_any_surface():
    x, f = strategies.moebius(np.random.default_rng(0), 40)
    strip, leaves = Mesh(x, f), MESHES["leaves"]()
    for mesh, bound in ((strip, 0.2), (leaves, 0.5)):
        found = geodesic_distance(mesh, 0)
        exact = geodesic_distance(mesh, 0, method="exact" if mesh is strip else "edges")
        assert mean_error(found, exact) < bound


def test_on_the_creature():
    mesh = shapes.blob(2500)
    for intrinsic in (False, True):
        exact = geodesic_distance(mesh, 11, method="exact")
        assert mean_error(geodesic_distance(mesh, 11, intrinsic=intrinsic), exact) < 0.025


@pytest.mark.parametrize("intrinsic", [False, True])
def test_what_must_not_matter(intrinsic):
    for name in ("obt", "cur"):
        mesh = MESHES[name]()
        method = lambda m: geodesic_distance(m, [5, 44], intrinsic=intrinsic)  # noqa: E731
        d = method(mesh)
        assert np.allclose(method(shuffled(mesh, 3)), d, atol=1e-8 * d.max())
        for unit in (1e-9, 1e9):
            other = mesh.with_vertices(unit * mesh.vertices)
            assert np.allclose(method(other) / unit, d, atol=1e-7 * d.max())
        rotation = np.linalg.qr(np.random.default_rng(837465).normal(size=(5, 5)))[0]
        embedded = mesh.with_vertices(mesh.vertices @ rotation[: mesh.dimension] + 1)
        assert np.allclose(method(embedded), d, atol=1e-8 * d.max())


def test_one_method_serves_many_sources():
    mesh = shapes.icosphere(3)
    method = HeatMethod(mesh)
    single = np.array([method.distance(s) for s in (0, 100, 333)])
    assert np.array_equal(single[1], geodesic_distance(mesh, 100))
    assert single[0, 100] == pytest.approx(single[1, 0], rel=0.02)  # symmetric but for its error
    several = method.distance([0, 100, 333])
    assert mean_error(several, single.min(axis=0)) < 0.05
    assert several[[0, 100, 333]].min() == 0
    assert several[[0, 100, 333]].max() < 0.05
    assert (
        repr(method) == f"<HeatMethod: 642 vertices, intrinsic triangles, time {method.time:.6g}>"
    )


def test_other_components_are_out_of_reach():
    one, two = shapes.icosphere(2), MESHES["tor"]()
    n = one.n_vertices
    both = Mesh(
        np.concatenate([one.vertices, two.vertices + np.array([9, 0, 0])]),
        np.concatenate([one.faces, two.faces + n]),
    )
    method = HeatMethod(both, time=0.02)
    d = method.distance(4)
    assert np.isinf(d[n:]).all()
    assert np.allclose(d[:n], geodesic_distance(one, 4, time=0.02), atol=1e-10)
    d = method.distance([4, n + 7, n + 200])
    assert np.allclose(d[n:], geodesic_distance(two, [7, 200], time=0.02), atol=1e-10)
    assert d[[n + 7, n + 200]].min() == 0
    assert d[4] == 0


def test_longer_times_round_it_off():
    mesh = shapes.torus(60, 30)
    exact = geodesic_distance(mesh, 0, method="exact")
    errors = [mean_error(geodesic_distance(mesh, 0, time=t), exact) for t in (None, 0.03, 3)]
    assert errors[0] < 0.03 < 0.035 < errors[1] < 0.045 < 0.06 < errors[2]


def test_a_cold_boundary_averaged_with_an_insulated_one():
    """Neumann bends the lines of equal distance at the boundary, Dirichlet the other way."""
    mesh = shapes.disk(24)
    x = mesh.vertices
    source = int(np.linalg.norm(x - [0.5, 0], axis=1).argmin())
    exact = np.linalg.norm(x - x[source], axis=1)
    far = np.linalg.norm(x, axis=1) > 0.85
    one, two = (
        np.abs(geodesic_distance(mesh, source, time=0.03, boundary=b) - exact)[far].mean()
        for b in ("neumann", "average")
    )
    assert two < 0.6 * one
    sphere = shapes.icosphere(2)
    closed = [geodesic_distance(sphere, 0, boundary=b) for b in ("neumann", "average")]
    assert np.array_equal(*closed)
    from_the_rim = [
        geodesic_distance(mesh, mesh.n_vertices - 1, boundary=b) for b in ("neumann", "average")
    ]
    assert np.allclose(*from_the_rim, atol=1e-9)  # no heat is left of a source on a cold boundary


def test_a_mesh_whose_vertices_are_all_on_the_boundary():
    mesh = Mesh([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1, 2], [0, 2, 3]])
    d = geodesic_distance(mesh, 0, boundary="average")
    assert np.array_equal(d, geodesic_distance(mesh, 0))
    assert d[1] == pytest.approx(d[3])


def test_heat_that_does_not_arrive_is_told():
    strip = shapes.grid(300, 2, 300.0, 2.0)
    exact = geodesic_distance(strip, 0, method="exact")
    assert mean_error(geodesic_distance(strip, 0), exact) < 0.05  # down to 1e-200 of the heat
    with pytest.raises(ConvergenceError, match="longer time") as caught:
        geodesic_distance(strip, 0, time=1e-3)
    assert "method='exact'" in str(caught.value)


def test_in_the_maze_it_walks_around_corners():
    mesh = maze()
    source = int(mesh.vertices.sum(axis=1).argmin())
    exact = geodesic_distance(mesh, source, method="exact")
    assert mean_error(geodesic_distance(mesh, source), exact) < 0.05


@pytest.mark.parametrize("time", [1e18, 1e300, 1e308])
@pytest.mark.parametrize("intrinsic", [False, True])
def test_a_time_in_which_the_mass_is_rounded_away_is_refused(intrinsic, time):
    mesh = MESHES["pl"]()
    with pytest.raises(BeltramiError, match="spread evenly"):
        HeatMethod(mesh, time=time, intrinsic=intrinsic)
    assert np.isfinite(HeatMethod(mesh, time=1e6, intrinsic=intrinsic).distance(0)).all()


def test_wrong_options():
    mesh = MESHES["pl"]()
    for time in (0, -1.0, np.nan, np.inf, "a", [1.0], np.ones(2), 1j):
        with pytest.raises(BeltramiError, match="must be positive"):
            HeatMethod(mesh, time=time)
    with pytest.raises(UnknownNameError, match="neumann"):
        HeatMethod(mesh, boundary="dirichlet")
    with pytest.raises(AttributeError, match="frozen"):
        HeatMethod(mesh).time = 3
