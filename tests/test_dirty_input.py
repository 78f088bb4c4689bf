"""Any mesh into any function of the operators and geodesics: numbers, or an error that says why."""

import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import beltrami as bt
import strategies
from beltrami.errors import BeltramiError
from beltrami.geodesics.distance import DISTANCE_METHODS
from beltrami.operators.areas import AREA_KINDS
from beltrami.operators.edge_areas import EDGE_AREA_KINDS
from beltrami.operators.energy import ROUTES
from beltrami.operators.integrals import PLACES
from beltrami.operators.pair import INTRINSIC, MASSES, TUFTED
from beltrami.operators.weights import SYMMETRIC_WEIGHTS
from beltrami.spectrum.filtering import FILTER_METHODS

WEIGHTS = (*SYMMETRIC_WEIGHTS, INTRINSIC, TUFTED)


def _pairs(mesh, f):
    """Everything that a pair can be asked, for all weights and masses."""
    for kind in WEIGHTS:
        for mass in MASSES:
            pair = bt.laplacian(mesh, kind, mass)
            yield pair.stiffness, pair.mass, pair.weights, pair.spectral_bound()
            yield pair.inner(f, f), pair.norm(f), pair.mean(f), pair.dirichlet_energy(f)
            yield pair.normalized, pair.incidence, pair.properties.spectral_bound
            if mass != "consistent":
                yield pair.apply(f), bt.project(pair, f, np.ones(pair.n))
            if pair.properties.non_negative_weights:
                yield pair.averaging, pair.gradient


def _filters(mesh, f):
    """Filters of each method, and wavelets, for masses of each kind."""
    for mass in ("voronoi", "degree", "consistent"):
        pair = bt.laplacian(mesh, mass=mass)
        high = pair.spectral_bound()
        for h in (bt.kernels.Heat(9 / high), bt.kernels.LowPass(high / 2, high / 3)):
            for method in FILTER_METHODS:
                yield bt.filter(pair, f, h, method, tolerance=1e-5)
        yield bt.meyer_frame(high, 2).analyze(pair, f, tolerance=1e-5)


def _fields(result):
    return vars(result).values()


CALLS = {
    "pairs": _pairs,
    "filters": _filters,
    "curvature": lambda mesh, f: _fields(bt.curvature(mesh)),
    "triangles": lambda mesh, f: _fields(bt.intrinsic_delaunay(mesh)),
    "cover": lambda mesh, f: _fields(bt.intrinsic_delaunay(mesh, cover=True)),
    "gradient": lambda mesh, f: (bt.face_gradient(mesh), bt.face_divergence(mesh)),
    "slopes": lambda mesh, f: bt.edge_derivative(mesh, f),
    "colouring": lambda mesh, f: bt.colouring(mesh),
    "neighbours": lambda mesh, f: [
        bt.knn_graph(mesh.vertices, 3, kind) for kind in ("combinatorial", "gaussian")
    ],
    "mean value": lambda mesh, f: bt.edge_weights(mesh, "mean_value"),
    **{f"weights {k}": lambda mesh, f, k=k: bt.edge_weights(mesh, k) for k in SYMMETRIC_WEIGHTS},
    **{f"areas {k}": lambda mesh, f, k=k: bt.vertex_areas(mesh, k) for k in AREA_KINDS},
    **{f"edge areas {k}": lambda mesh, f, k=k: bt.edge_areas(mesh, k) for k in EDGE_AREA_KINDS},
    **{f"energy {k}": lambda mesh, f, k=k: bt.dirichlet_energy(mesh, f, k) for k in ROUTES},
    **{f"integral {k}": lambda mesh, f, k=k: bt.integrate(mesh, f, k) for k in PLACES},
}
DISTANCES = {
    **{k: {"method": k} for k in DISTANCE_METHODS},
    "average": {"boundary": "average"},
    "given": {"intrinsic": False},
}


def _numbers(result):
    """All floats in arrays, sparse matrices, and lists of them."""
    if hasattr(result, "indptr"):
        return [result.data]
    if isinstance(result, np.ndarray | float):
        return [np.asarray(result)]
    if isinstance(result, str | int | None):
        return []
    return [numbers for part in result for numbers in _numbers(part)]


@st.composite
def meshes(draw):
    """Any damaged mesh, in any unit, sometimes flattened almost to nothing or in R⁵."""
    mesh = draw(strategies.any_meshes())
    x = mesh.vertices * 10.0 ** draw(st.sampled_from([0, 0, 0, -12, 12, -40, 40]))
    if draw(st.integers(0, 3)) == 0:
        x = x * np.r_[np.ones(x.shape[1] - 1), 10.0 ** draw(st.integers(-12, 0))]
    if draw(st.integers(0, 5)) == 0:
        x = np.c_[x, x[:, :1] / 3, x[:, 1:2] / 7]
    return bt.Mesh(x, mesh.faces)


@pytest.mark.parametrize("name", CALLS)
@settings(deadline=None, max_examples=25)
@given(meshes(), strategies.generators())
def test_finite_numbers_or_an_error_that_says_why(name, mesh, rng):
    f = rng.normal(size=(mesh.n_vertices, 2))
    before = mesh.vertices.copy()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            found = _numbers(CALLS[name](mesh, f))
        except BeltramiError:
            return
    assert all(np.isfinite(numbers).all() for numbers in found)
    assert np.array_equal(mesh.vertices, before)


@pytest.mark.parametrize("name", DISTANCES)
@settings(deadline=None, max_examples=25)
@given(meshes(), strategies.generators())
def test_distances_are_numbers_or_infinite_out_of_reach(name, mesh, rng):
    if not mesh.n_vertices:
        return
    sources = rng.integers(mesh.n_vertices, size=2)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            distance = bt.geodesic_distance(mesh, sources, **DISTANCES[name])
        except BeltramiError:
            return
    assert not np.isnan(distance).any()
    assert np.isfinite(distance[sources]).all()
    assert distance[sources].min() == 0


@pytest.mark.parametrize("place", [0, 3])
@pytest.mark.parametrize("wrong", [np.nan, np.inf])
@pytest.mark.parametrize("name", CALLS)
def test_numbers_that_are_not_finite_are_refused(name, wrong, place):
    x = bt.shapes.icosphere(1).vertices.copy()
    x[place] = wrong
    mesh = bt.Mesh(x, bt.shapes.icosphere(1).faces)
    if name == "colouring":  # made of edges alone
        return
    with pytest.raises(BeltramiError):
        _numbers(CALLS[name](mesh, np.ones(mesh.n_vertices)))
