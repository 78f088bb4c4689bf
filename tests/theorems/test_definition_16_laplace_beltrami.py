"""Definition 16: Laplace-Beltrami, right as printed; pullbacks the right way round (E83)."""

import numpy as np
import pytest

import charts
from beltrami.errors import NotDifferentiableError, UnknownNameError
from beltrami.surfaces.surface import ParametricSurface
from charts import inside

FUNCTIONS = {
    "z": (lambda x, y, z: z, lambda x, y, z: -2 * z),
    "xy": (lambda x, y, z: x * y, lambda x, y, z: -6 * x * y),
    "xyz": (lambda x, y, z: x * y * z, lambda x, y, z: -12 * x * y * z),
    "mixed": (lambda x, y, z: z + x * y, lambda x, y, z: -2 * z - 6 * x * y),
    "1": (lambda x, y, z: 4.0, lambda x, y, z: 0 * x),
}


def _as_printed(surface, f, u, v, root=True, cross=1.0):
    """The formula of the chapter: inner derivatives by complex steps, outer by differences."""
    phi, i = surface.immersion.phi, 1e-30j

    def fluxes(u, v):
        phi_u, phi_v = (np.array(phi(u + i, v)).imag / 1e-30, np.array(phi(u, v + i)).imag / 1e-30)
        g11, g22 = (phi_u**2).sum(axis=0), (phi_v**2).sum(axis=0)
        g12 = cross * (phi_u * phi_v).sum(axis=0)
        g = g11 * g22 - g12**2
        f_u, f_v = f(*phi(u + i, v)).imag / 1e-30, f(*phi(u, v + i)).imag / 1e-30
        s = np.sqrt(g)
        return (g22 * f_u - g12 * f_v) / s, (g11 * f_v - g12 * f_u) / s, s

    h = 1e-3
    du = (
        8 * (fluxes(u + h, v)[0] - fluxes(u - h, v)[0])
        - (fluxes(u + 2 * h, v)[0] - fluxes(u - 2 * h, v)[0])
    ) / (12 * h)
    dv = (
        8 * (fluxes(u, v + h)[1] - fluxes(u, v - h)[1])
        - (fluxes(u, v + 2 * h)[1] - fluxes(u, v - 2 * h)[1])
    ) / (12 * h)
    return (du + dv) / (fluxes(u, v)[2] if root else 1)


@pytest.mark.chapter("D16", "P39")
@pytest.mark.parametrize("chart", ["sphere", "skewed_sphere", "stereographic"])
@pytest.mark.parametrize("name", FUNCTIONS)
def test_spherical_harmonics_in_every_chart(chart, name):
    surface = getattr(charts, chart)()
    f, exact = FUNCTIONS[name]
    u, v = inside(surface)
    wanted = exact(*np.moveaxis(surface(u, v), -1, 0))
    assert np.allclose(surface.laplace_beltrami(f)(u, v), wanted, rtol=1e-11, atol=1e-11)


@pytest.mark.chapter("D16")
@pytest.mark.parametrize("name", ["z", "xy", "xyz"])
def test_the_printed_formula_and_what_breaks_it(name):
    """Skewed chart: without 1/sqrt(g), or with the sign of g12 flipped, the values are far off."""
    surface = charts.skewed_sphere()
    f, _ = FUNCTIONS[name]
    u, v = inside(surface)
    mine = surface.laplace_beltrami(f)(u, v)
    assert np.allclose(_as_printed(surface, f, u, v), mine, rtol=1e-8, atol=1e-8)
    scale = np.abs(mine).max()
    for wrong in ({"root": False}, {"cross": -1.0}, {"cross": 0.0}):
        assert np.abs(_as_printed(surface, f, u, v, **wrong) - mine).max() > 0.1 * scale


@pytest.mark.chapter("D16")
@pytest.mark.parametrize("chart", ["torus", "klein", "mobius", "cylinder"])
def test_the_printed_formula_on_other_surfaces(chart):
    surface = getattr(charts, chart)()

    def f(x, y, z, w=0.0):
        return np.sin(x) * y + z**2 * x + w * y

    u, v = inside(surface)
    mine = surface.laplace_beltrami(f)(u, v)
    assert np.allclose(_as_printed(surface, f, u, v), mine, rtol=1e-7, atol=1e-7)


@pytest.mark.chapter("D16")
def test_harmonic_in_the_plane():
    plane = charts.polar_plane()
    r, t = inside(plane)
    assert np.allclose(plane.laplace_beltrami(lambda x, y: x**2 - y**2)(r, t), 0, atol=1e-11)
    assert np.allclose(plane.laplace_beltrami(lambda x, y: x**2 + y**2)(r, t), 4, rtol=1e-11)
    log = plane.laplace_beltrami(lambda r, t: np.log(r), of="parameters")
    assert np.allclose(log(r, t), 0, atol=1e-10)


@pytest.mark.chapter("D16")
def test_it_is_negative_where_f_has_a_maximum():
    assert charts.stereographic().laplace_beltrami(lambda x, y, z: z)(0, 0) == pytest.approx(-2)


@pytest.mark.chapter("D16")
@pytest.mark.parametrize("chart", ["sphere", "torus", "klein"])
def test_it_is_symmetric_with_mean_zero_on_closed_surfaces(chart):
    """∫ Δf = 0 and ∫ g Δf = ∫ f Δg; trapezoids around, Gauss between the poles."""
    surface = getattr(charts, chart)()
    n = 64
    u = np.linspace(0, 2 * np.pi, n, endpoint=False)
    v, weight = np.polynomial.legendre.leggauss(n)
    low, high = surface.domain.v
    v, weight = (low + high + (high - low) * v) / 2, weight * (high - low) / 2 * 2 * np.pi / n
    u, v = u[:, None], v[None, :]
    area = surface.area_element(u, v) * weight
    f = lambda *x: x[2] ** 2 + x[0] * x[1]  # noqa: E731
    g = lambda *x: np.exp(x[0] / 3) - x[2] ** 2  # noqa: E731
    x = np.moveaxis(surface(u, v), -1, 0)
    df, dg = surface.laplace_beltrami(f)(u, v), surface.laplace_beltrami(g)(u, v)
    assert (area * df).sum() == pytest.approx(0, abs=1e-9)
    left, right = (area * g(*x) * df).sum(), (area * f(*x) * dg).sum()
    assert left == pytest.approx(right, rel=1e-9)
    assert abs(left) > 0.1
    assert (area * f(*x) * df).sum() < 0


@pytest.mark.chapter("P39")
def test_the_same_value_in_another_chart_of_the_torus():
    torus = charts.torus()

    def psi(s, t):
        return 1 + s + 0.3 * t**2, 2 - t + 0.4 * s * t

    other = ParametricSurface(lambda s, t: torus.immersion.phi(*psi(s, t)), ((0, 1), (0, 1)))
    s, t = other.domain.samples(30)
    f = lambda x, y, z: np.exp(x) * z + y  # noqa: E731
    here, there = other.laplace_beltrami(f)(s, t), torus.laplace_beltrami(f)(*psi(s, t))
    assert np.allclose(here, there, rtol=1e-11, atol=1e-11)


@pytest.mark.chapter("P65")
@pytest.mark.parametrize("chart", ["torus", "skewed_sphere", "stereographic"])
def test_the_pullback_is_f_after_phi(chart):
    surface = getattr(charts, chart)()
    f = lambda x, y, z: z + np.sin(x * y)  # noqa: E731
    fbar = surface.pullback(f)
    u, v = inside(surface)
    assert np.array_equal(fbar(u, v), f(*np.moveaxis(surface(u, v), -1, 0)))
    by_parameters = surface.laplace_beltrami(fbar, of="parameters")(u, v)
    assert np.allclose(by_parameters, surface.laplace_beltrami(f)(u, v), rtol=1e-13)
    with pytest.raises(TypeError):  # as printed, φ ∘ f̄: φ takes two parameters, not one value
        surface(fbar(u, v))


@pytest.mark.chapter("D16")
def test_what_cannot_be_differentiated_is_refused():
    surface = charts.torus()
    with pytest.raises(UnknownNameError):
        surface.laplace_beltrami(lambda x, y, z: x, of="points")
    with pytest.raises(NotDifferentiableError, match="norm"):
        surface.laplace_beltrami(lambda x, y, z: np.linalg.norm(x))(0.1, 0.2)
