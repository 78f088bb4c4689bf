"""Definition 2: the first fundamental form, and lengths by both routes (E3)."""

import numpy as np
import pytest

import charts
from beltrami.errors import DimensionError, MeshError, NotDifferentiableError, UnknownNameError
from beltrami.surfaces.surface import ParametricSurface
from charts import inside


@pytest.mark.chapter("D2")
def test_closed_forms():
    cases = (
        (charts.sphere(), lambda u, v: (np.sin(v) ** 2, 0 * u, 1 + 0 * u)),
        (charts.torus(), lambda u, v: ((2 + 0.7 * np.cos(v)) ** 2, 0 * u, 0.49 + 0 * u)),
        (charts.polar_plane(), lambda r, t: (1 + 0 * r, 0 * r, r**2)),
        (charts.cylinder(), lambda u, v: (4 + 0 * u, 0 * u, 1 + 0 * u)),
        (
            charts.klein(),
            lambda u, v: ((3 + np.cos(v)) ** 2 + np.sin(v) ** 2 / 4, 0 * u, 1 + 0 * u),
        ),
    )
    for surface, exact in cases:
        u, v = inside(surface)
        g = surface.first_fundamental_form(u, v)
        assert g.shape == (len(u), 2, 2)
        assert np.array_equal(g, np.swapaxes(g, 1, 2))
        mine = np.stack([g[:, 0, 0], g[:, 0, 1], g[:, 1, 1]])
        assert np.allclose(mine, exact(u, v), rtol=1e-13, atol=1e-14)
        assert (np.linalg.eigvalsh(g) > 0).all()
        assert np.allclose(surface.area_element(u, v) ** 2, np.linalg.det(g), rtol=1e-12)


@pytest.mark.chapter("D2")
def test_under_a_change_of_parameters_it_becomes_jt_i_j():
    torus = charts.torus()

    def psi(s, t):
        return 1 + s + 0.3 * t**2, 2 - t + 0.4 * s * t

    other = ParametricSurface(lambda s, t: torus.immersion.phi(*psi(s, t)), ((0, 1), (0, 1)))
    s, t = other.domain.samples(30)
    J = np.moveaxis(np.array([[1 + 0 * s, 0.6 * t], [0.4 * t, 0.4 * s - 1]]), -1, 0)
    old = torus.first_fundamental_form(*psi(s, t))
    mine = other.first_fundamental_form(s, t)
    assert np.allclose(mine, np.swapaxes(J, 1, 2) @ old @ J, rtol=1e-13, atol=1e-14)
    assert not np.allclose(mine, J @ old @ np.swapaxes(J, 1, 2), rtol=0.01)


@pytest.mark.chapter("U1")
@pytest.mark.parametrize("latitude", [0.3, 1.0, np.pi / 2])
def test_lengths_on_the_sphere(latitude):
    sphere = charts.sphere()
    around = 2 * np.pi * np.sin(latitude)
    for route, tolerance in (("intrinsic", 1e-13), ("extrinsic", 1e-4)):
        length = sphere.curve_length(lambda t: (2 * np.pi * t, latitude), route=route)
        assert length == pytest.approx(around, rel=tolerance)
        meridian = sphere.curve_length(lambda t: (0.4, t), 0, np.pi, route=route)
        assert meridian == pytest.approx(np.pi, rel=tolerance)


@pytest.mark.chapter("U1")
@pytest.mark.parametrize("name", ["torus", "skewed_sphere", "stereographic", "klein", "mobius"])
def test_both_routes_agree_to_the_order_of_the_polyline(name):
    surface = getattr(charts, name)()

    def curve(t):
        return 0.1 + 0.4 * np.sin(t), 0.25 * np.cos(t)

    exact = surface.curve_length(curve)
    assert surface.curve_length(curve, pieces=13) == pytest.approx(exact, rel=1e-13)
    pieces = np.array([16, 32, 64])
    chords = [surface.curve_length(curve, route="extrinsic", pieces=int(n)) for n in pieces]
    missing = exact - np.array(chords)
    assert (missing > 0).all()  # chords are shorter
    assert np.polyfit(np.log(pieces), np.log(missing), 1)[0] == pytest.approx(-2, abs=0.05)


@pytest.mark.chapter("U1")
def test_without_the_metric_or_without_its_cross_term_the_length_is_wrong():
    surface = charts.skewed_sphere()
    t = np.linspace(0, 1, 20001)
    u, v = -0.5 + 1.2 * t, -0.6 + t
    g = surface.first_fundamental_form((u[1:] + u[:-1]) / 2, (v[1:] + v[:-1]) / 2)
    assert np.abs(g[:, 0, 1]).min() > 0.1

    def length(cross):
        square = g[:, 0, 0] * 1.2**2 + 2 * cross * g[:, 0, 1] * 1.2 + g[:, 1, 1]
        return np.sqrt(square).mean()

    mine = surface.curve_length(lambda t: (-0.5 + 1.2 * t, -0.6 + t))
    assert mine == pytest.approx(length(1), rel=1e-7)
    for wrong in (0, -1):
        assert abs(length(wrong) - mine) > 0.1
    assert abs(np.hypot(1.2, 1) - mine) > 0.1


@pytest.mark.chapter("U1")
def test_the_length_is_one_number_for_the_curve_and_adds_up():
    torus = charts.torus()

    def curve(t):
        return t, 2 * t**2

    whole = torus.curve_length(curve, 0, 2)
    parts = torus.curve_length(curve, 0, 0.7) + torus.curve_length(curve, 0.7, 2)
    assert parts == pytest.approx(whole, rel=1e-13)
    slower = torus.curve_length(lambda t: curve(t**3), 0, 2 ** (1 / 3))
    assert slower == pytest.approx(whole, rel=1e-12)


@pytest.mark.chapter("U1")
def test_what_is_no_curve_is_refused():
    torus = charts.torus()
    with pytest.raises(DimensionError, match="3 coordinates"):
        torus.curve_length(lambda t: (t, t, t))
    with pytest.raises(DimensionError, match="1 coordinates"):
        torus.trace(lambda t: (t,), 0.5)
    with pytest.raises(UnknownNameError):
        torus.curve_length(lambda t: (t, t), route="euclidean")
    with pytest.raises(MeshError):
        torus.curve_length(lambda t: (t, t), pieces=0)
    with pytest.raises(NotDifferentiableError, match="floor"):
        torus.curve_length(lambda t: (t, np.floor(t)))
    jump = torus.curve_length(lambda t: (t, np.floor(t)), route="extrinsic")
    assert jump > torus.curve_length(lambda t: (t, 0 * t))
