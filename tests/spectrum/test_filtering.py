"""filter: three ways to the same function, each within what it was asked for."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import csr_array

import beltrami as bt
from beltrami.errors import (
    ApproximationError,
    BeltramiError,
    DimensionError,
    MeshError,
    NonFiniteError,
    UnknownNameError,
)
from beltrami.operators.laplacian import laplacian
from beltrami.operators.pair import MASSES
from beltrami.spectrum.filtering import filter as filter_function
from beltrami.spectrum.fourier_basis import fourier_basis
from beltrami.spectrum.interval import spectral_interval
from beltrami.spectrum.kernels import BandPass, Heat, HighPass, LowPass, Tikhonov, Wave
from beltrami.spectrum.lanczos import lanczos_filter
from meshes_of_the_errata import MESHES, flipped


def _error(pair, found, exact, f):
    """Largest error of a column in the norm of B, beside that of f."""
    columns = [x.reshape(pair.n, -1).T for x in (found - exact, f)]
    return max(pair.norm(e) / pair.norm(g) for e, g in zip(*columns, strict=True))


def _functions(mesh, columns=2):
    rough = np.random.default_rng(31).normal(size=(mesh.n_vertices, columns))
    rough[:, -1] = mesh.vertices[:, 0] ** 2 + mesh.vertices[:, 1]
    return rough


def _kernels(high):
    """Make kernels that look at all parts of a spectrum up to ``high``."""
    return [
        Heat(20 / high),
        Heat(1e5 / high),
        Wave(40 / high**0.5),
        Tikhonov(1e4 / high),
        LowPass(0.3 * high, 0.2 * high),
        BandPass(0.1 * high, 0.5 * high, 0.2 * high),
        lambda x: np.exp(-(((x - 0.4 * high) / (0.05 * high)) ** 2)),
    ]


@pytest.mark.parametrize("method", ["chebyshev", "lanczos"])
@pytest.mark.parametrize("mass", MASSES)
@pytest.mark.parametrize("name", ["closed", "bad", "leaves"])
def test_both_methods_are_exact_to_the_tolerance(name, mass, method):
    mesh = MESHES[name]()
    pair = laplacian(mesh, mass=mass)
    f = _functions(mesh)
    basis = fourier_basis(pair, pair.n)
    for number, h in enumerate(_kernels(spectral_interval(pair).high)):
        exact = filter_function(pair, f, h, "exact", basis=basis)
        found = filter_function(pair, f, h, method)
        assert found.shape == f.shape
        assert _error(pair, found, exact, f) < 1e-8
        if number % 3 == 0:
            loose = filter_function(pair, f, h, method, tolerance=1e-3)
            assert _error(pair, loose, exact, f) < 1e-3


@settings(deadline=None, max_examples=25)
@given(st.integers(0, 2**40), st.floats(0.02, 1), st.integers(-8, 8), st.floats(-2, 5))
def test_on_meshes_in_any_unit(seed, aspect, unit, log_time):
    mesh = flipped(seed, n=20, aspect=aspect)
    mesh = mesh.with_vertices(10.0**unit * mesh.vertices)
    pair = laplacian(mesh)
    f = _functions(mesh)
    h = Heat(10**log_time / spectral_interval(pair).high)
    exact = filter_function(pair, f, h, "exact")
    for method in ("chebyshev", "lanczos"):
        assert _error(pair, filter_function(pair, f, h, method), exact, f) < 1e-8


def test_one_column_is_a_vector():
    mesh = MESHES["closed"]()
    pair = laplacian(mesh)
    f = _functions(mesh, 5)
    for method in ("chebyshev", "lanczos", "exact"):
        whole = filter_function(pair, f, Heat(0.1), method)
        one = filter_function(pair, f[:, 2], Heat(0.1), method)
        assert one.shape == (pair.n,)
        np.testing.assert_allclose(one, whole[:, 2], atol=1e-13)
    assert filter_function(pair, f[:, :0], Heat(0.1)).shape == (pair.n, 0)


def test_the_default_is_chebyshev_and_is_public():
    pair = laplacian(MESHES["closed"]())
    f = _functions(pair.domain)
    named = filter_function(pair, f, Heat(0.1), "chebyshev", tolerance=1e-8)
    assert (bt.filter(pair, f, bt.kernels.Heat(0.1)) == named).all()


# ------------------------------------------------------------------------------ ideal filters


def _gap(basis):
    """Return the middle of the widest relative gap of the spectrum."""
    values = basis.eigenvalues
    at = (np.diff(values) / values[1:])[10:].argmax() + 10
    return (values[at] + values[at + 1]) / 2


@pytest.mark.parametrize("make", [LowPass, HighPass])
@pytest.mark.parametrize("name", ["closed", "bad", "obt"])
def test_ideal_filters(name, make):
    """Chebyshev refuses; Lanczos finds the gap between two eigenvalues, when it has seen enough."""
    mesh = MESHES[name]()
    pair = laplacian(mesh)
    f = _functions(mesh)
    basis = fourier_basis(pair, pair.n)
    h = make(_gap(basis))
    exact = basis.filter(f, h)
    assert _error(pair, filter_function(pair, f, h, "lanczos"), exact, f) < 1e-8
    with pytest.raises(ApproximationError, match="jumps"):
        filter_function(pair, f, h)
    forced = filter_function(pair, f, h, order=200)
    assert 1e-6 < _error(pair, forced, exact, f) < 0.5
    again = filter_function(pair, exact, h, "exact")
    assert _error(pair, again, exact, f) < 1e-10  # a projection


def test_an_ideal_filter_of_a_smooth_kernel_that_hides_its_jump():
    pair = laplacian(MESHES["closed"]())
    with pytest.raises(ApproximationError, match="error of about"):
        filter_function(pair, np.ones(pair.n), lambda x: x > 10)


# ------------------------------------------------------------------------------ Lanczos


def test_lanczos_stops_where_the_space_closes():
    """A function of q eigenspaces needs q steps, and nothing is left out."""
    pair = laplacian(MESHES["closed"]())
    basis = fourier_basis(pair, pair.n)
    f = basis.eigenvectors[:, [3, 77, 200]] @ [1.0, 2.0, -3.0]
    h = Wave(5.0)
    exact = basis.filter(f, h)
    few = filter_function(pair, f, h, "lanczos", order=3)
    np.testing.assert_allclose(few, exact, atol=1e-9)
    assert np.abs(filter_function(pair, f, h, "lanczos", order=2) - exact).max() > 1e-2
    np.testing.assert_allclose(filter_function(pair, f, h, "lanczos"), exact, atol=1e-9)


@pytest.mark.parametrize("scale", [0.0, 1e-200, 1.0, 1e200])
@pytest.mark.parametrize("method", ["chebyshev", "lanczos"])
def test_constants_of_any_size(scale, method):
    pair = laplacian(MESHES["bad"]())
    found = filter_function(pair, np.full(pair.n, scale), Heat(1.0), method)
    np.testing.assert_allclose(found, scale, rtol=1e-8)


def test_heat_that_the_first_ritz_values_do_not_see():
    """Far from 0, where alone the kernel is not 0: nothing changes, and yet it would be wrong."""
    mesh = bt.shapes.icosphere(3)
    pair = laplacian(mesh)
    f = np.random.default_rng(0).normal(size=pair.n)
    found = filter_function(pair, f, Heat(10.0), "lanczos")
    assert np.abs(found - pair.mean(f)).max() < 1e-7
    assert abs(pair.mean(f)) > 1e-3


def _at_the_low_end(x):
    """Fall at 0, oscillate, and rise once more in the middle of 0 to 104157."""
    bump = np.exp(-(((x - 70861.3) / 1087.4) ** 2))
    return 0.9231 * bump - 0.5852 * np.cos(0.34913 * np.sqrt(x)) - 0.3986 * np.exp(-9.7806 * x)


def _narrow_bump(x):
    """Rise only at 1117, a thousandth of the interval, on a slow decay."""
    bump = np.exp(-(((x - 1117.07) / 105.9) ** 2))
    return 0.508 / (1 + 2.93e-6 * x) + 2.037 / (1 + 1.736e-4 * x) - 0.7733 * bump


@pytest.mark.parametrize(
    ("name", "mass", "h", "tolerance"),
    [
        ("cur", "voronoi", _at_the_low_end, 5.3e-7),
        ("bad", "consistent", _narrow_bump, 3.3e-3),
    ],
)
def test_features_that_few_ritz_values_do_not_see(name, mass, h, tolerance):
    """Found by a search: one needs the ends of the interval, the other close looks near 0."""
    pair = laplacian(MESHES[name](), mass=mass)
    f = np.eye(pair.n)[:, [0, 7, 52, 55, 64, 112, 126]]
    exact = filter_function(pair, f, h, "exact")
    found = filter_function(pair, f, h, "lanczos", tolerance=tolerance)
    assert _error(pair, found, exact, f) < 2 * tolerance


def test_lanczos_with_few_vectors_says_so(monkeypatch):
    monkeypatch.setattr("beltrami.spectrum.lanczos._MOST", 30)
    pair = laplacian(MESHES["bad"]())
    f = np.random.default_rng(0).normal(size=pair.n)
    with pytest.raises(ApproximationError, match="30 vectors"):
        filter_function(pair, f, LowPass(100.0), "lanczos")
    filter_function(pair, f, LowPass(100.0), "lanczos", order=20)  # asked for, not promised


def test_lanczos_keeps_its_vectors_orthogonal():
    """Without it copies of the outer Ritz values come, and 192 vectors do not close the space."""
    pair = laplacian(MESHES["bad"]())
    f = np.random.default_rng(0).normal(size=(pair.n, 1))
    interval = spectral_interval(pair)
    exact = filter_function(pair, f, Heat(1e4 / interval.high), "exact")
    found = lanczos_filter(pair, f, Heat(1e4 / interval.high), interval, order=pair.n)
    assert _error(pair, found, exact, f) < 1e-11


# ------------------------------------------------------------------------------ what is refused


def test_weights_of_either_sign():
    """The spectrum goes below 0, and so does the interval of the polynomials."""
    rng = np.random.default_rng(8)
    W = np.triu(rng.normal(size=(30, 30)), 1)
    pair = laplacian(csr_array(W + W.T), mass="unit")
    values, vectors = np.linalg.eigh(pair.stiffness.toarray())
    assert values[0] < -5
    f = rng.normal(size=30)
    exact = vectors @ (np.exp(-0.1 * values) * (vectors.T @ f))
    for method in ("chebyshev", "lanczos"):
        found = filter_function(pair, f, Heat(0.1), method)
        assert np.abs(found - exact).max() < 1e-8 * np.exp(-0.1 * values[0]) * 10


def test_an_exact_filter_of_many_vertices_is_refused():
    mesh = bt.shapes.icosphere(5)
    pair = laplacian(mesh)
    with pytest.raises(MeshError, match=r"chebyshev.*fourier_basis"):
        filter_function(pair, mesh.vertices, Heat(1.0), "exact")


def test_an_incomplete_basis_is_not_exact():
    pair = laplacian(MESHES["closed"]())
    with pytest.raises(DimensionError, match=r"has 10 of 300.*span"):
        filter_function(pair, np.ones(300), Heat(1.0), "exact", basis=fourier_basis(pair, 10))
    other = fourier_basis(laplacian(MESHES["bad"]()), 192)
    with pytest.raises(DimensionError, match="192"):
        filter_function(pair, np.ones(300), Heat(1.0), "exact", basis=other)
    with pytest.raises(BeltramiError, match="serves"):
        filter_function(pair, np.ones(300), Heat(1.0), basis=fourier_basis(pair, 10))


@pytest.mark.parametrize("method", ["chebyshev", "lanczos", "exact"])
def test_bad_input(method):
    pair = laplacian(MESHES["closed"]())
    f = np.ones(pair.n)
    with pytest.raises(DimensionError):
        filter_function(pair, f[1:], Heat(1.0), method)
    f[7] = np.nan
    with pytest.raises(NonFiniteError) as caught:
        filter_function(pair, f, Heat(1.0), method)
    assert caught.value.vertices.tolist() == [7]
    with pytest.raises(BeltramiError, match="function of the eigenvalues"):
        filter_function(pair, np.ones(pair.n), 0.5, method)
    for tolerance in (0, -1, np.nan, np.inf):
        with pytest.raises(BeltramiError, match="tolerance"):
            filter_function(pair, np.ones(pair.n), Heat(1.0), method, tolerance=tolerance)
    for order in (0, 1.5, 10**7, "3", np.nan):
        with pytest.raises(BeltramiError, match="order"):
            filter_function(pair, np.ones(pair.n), Heat(1.0), method, order=order)


def test_a_misspelt_method():
    pair = laplacian(MESHES["closed"]())
    with pytest.raises(UnknownNameError, match="'chebyshev'"):
        filter_function(pair, np.ones(pair.n), Heat(1.0), "chebychev")


def test_one_vertex_and_no_edges():
    """The spectrum is {0}: h(0) f."""
    pair = laplacian(csr_array((3, 3)), mass="unit")
    for method in ("chebyshev", "lanczos"):
        same = filter_function(pair, [1.0, 2, 3], Heat(1.0), method)
        np.testing.assert_allclose(same, [1, 2, 3], rtol=1e-15)
        assert filter_function(pair, [1.0, 2, 3], lambda x: x, method).tolist() == [0, 0, 0]


def test_progress_of_each_method():
    pair = laplacian(MESHES["closed"]())
    for method in ("chebyshev", "lanczos"):
        told = []
        f = np.random.default_rng(0).normal(size=(pair.n, 2))
        filter_function(pair, f, Heat(0.1), method, progress=lambda *step: told.append(step))  # noqa: B023
        assert told[-1][0] == told[-1][1] > 0
