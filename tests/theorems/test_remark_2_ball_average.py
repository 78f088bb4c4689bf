"""Remark 2: the Laplacian as a mean over balls, with its factor 8/h² (E49)."""

import numpy as np
import pytest

import charts
from beltrami.surfaces.ball_average import ball_average_laplacian

pytestmark = pytest.mark.chapter("R2")

AT = (0.6 / 1.64, 0.48 / 1.64)  # stereographic parameters of (0.6, 0.48, 0.64)
RADII = (0.4, 0.2, 0.1, 0.05)


def f(x, y, z):
    return z + x * y


def test_the_numbers_of_the_errata():
    surface = charts.stereographic()
    assert surface(*AT) == pytest.approx([0.6, 0.48, 0.64])
    mine = [float(ball_average_laplacian(surface, f, *AT, h)) for h in RADII]
    assert mine == pytest.approx([-2.9232, -2.9865, -3.0026, -3.0066], abs=1e-4)
    errors = np.array(mine) + 2 * 0.64 + 6 * 0.288
    assert np.polyfit(np.log(RADII), np.log(errors), 1)[0] == pytest.approx(2, abs=0.02)


def test_the_mean_alone_as_printed_tends_to_f():
    surface = charts.stereographic()
    means = [0.928 + h**2 / 8 * float(ball_average_laplacian(surface, f, *AT, h)) for h in RADII]
    assert np.round(means, 4).tolist() == [0.8695, 0.9131, 0.9242, 0.9271]
    assert abs(means[-1] - 0.928) < 1e-3 < 3 < abs(means[-1] - -3.008)


@pytest.mark.parametrize("h", [0.05, 0.3, 0.6])
@pytest.mark.parametrize("chart", ["stereographic", "sphere", "skewed_sphere"])
def test_on_the_sphere_the_means_are_known(h, chart):
    """Over circles a harmonic of degree l is multiplied by P_l(cos h); over disks by its mean."""
    surface = getattr(charts, chart)()
    centre = {"stereographic": (0.4, -0.5), "sphere": (2.0, 1.3), "skewed_sphere": (0.1, -0.1)}
    u, v = centre[chart]
    x, y, z = surface(u, v)
    if chart == "skewed_sphere":
        h = h / 3  # the chart is small
    c = np.cos(h)
    circle = 4 / h**2 * (z * (c - 1) + x * y * ((3 * c**2 - 1) / 2 - 1))
    disk = 8 / h**2 * (z * ((1 + c) / 2 - 1) + x * y * (c * (1 + c) / 2 - 1))
    for over, exact in (("circle", circle), ("disk", disk)):
        mine = float(ball_average_laplacian(surface, f, u, v, h, over=over))
        assert mine == pytest.approx(exact, rel=1e-6)


@pytest.mark.parametrize("over", ["disk", "circle"])
@pytest.mark.parametrize("chart", ["torus", "klein"])
def test_second_order_to_laplace_beltrami_elsewhere(over, chart):
    surface = getattr(charts, chart)()
    u, v = 0.7, np.array([0.4, 2.0])

    def g(x, y, z, w=0.0):
        return np.sin(x) * y + z**2 + w

    exact = surface.laplace_beltrami(g)(u, v)
    radii = np.array([0.2, 0.1, 0.05])
    errors = [ball_average_laplacian(surface, g, u, v, h, over=over) - exact for h in radii]
    slopes = np.polyfit(np.log(radii), np.log(np.abs(errors)), 1)[0]
    assert slopes == pytest.approx([2, 2], abs=0.15)
    assert np.abs(errors[-1]).max() < 0.02 * np.abs(exact).max()


def test_the_two_factors_are_not_interchangeable():
    """8 is 2 (d + 2) and 4 is 2 d, with d = 2: the mean of y_1² is h²/4 and h²/2."""
    surface = charts.torus()
    exact = surface.laplace_beltrami(f)(0.7, 0.4)
    over = {
        kind: ball_average_laplacian(surface, f, 0.7, 0.4, 0.01, over=kind)
        for kind in ("disk", "circle")
    }
    for kind in over:
        assert over[kind] == pytest.approx(exact, rel=1e-3)
        assert abs(over[kind] / 2 - exact) > 0.4 * abs(exact)
