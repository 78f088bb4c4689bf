"""Geodesics of charts, and the fans that ball averages use."""

import numpy as np
import pytest

import charts
from beltrami.errors import RankLossError, SurfaceError, UnknownNameError
from beltrami.surfaces.ball_average import ball_average_laplacian
from beltrami.surfaces.domain import Disk
from beltrami.surfaces.geodesics import exponential_map
from beltrami.surfaces.surface import ParametricSurface


@pytest.mark.parametrize("make", [charts.stereographic, charts.skewed_sphere, charts.sphere])
def test_geodesics_of_the_sphere_are_great_circles(make):
    surface = make()
    u = {"stereographic": 0.2, "skewed_sphere": 0.1, "sphere": 1.0}[make.__name__]
    v = {"stereographic": -0.1, "skewed_sphere": -0.2, "sphere": 1.4}[make.__name__]
    w = np.array([[0.15, 0.05], [-0.1, 0.2], [0.05, -0.3]])
    ends = surface(*exponential_map(surface, u, v, *w.T).T)
    tangents = w @ surface.jacobian(u, v).T
    length = np.linalg.norm(tangents, axis=1, keepdims=True)
    circle = np.cos(length) * surface(u, v) + np.sin(length) * tangents / length
    assert np.allclose(ends, circle, atol=1e-10)


def test_the_method_has_order_4():
    surface = charts.torus()
    exact = exponential_map(surface, 0.3, 0.5, 0.9, 1.1, steps=128)
    errors = [
        np.abs(exponential_map(surface, 0.3, 0.5, 0.9, 1.1, steps=s) - exact).max()
        for s in (8, 16, 32)
    ]
    assert np.polyfit(np.log([8, 16, 32]), np.log(errors), 1)[0] == pytest.approx(-4, abs=0.3)


def test_geodesics_of_the_torus_keep_clairauts_constant():
    """The distance from the axis times the cosine of the angle with the circles around it."""
    surface, w = charts.torus(), np.array([0.5, 1.3])
    h = 1e-4
    end, before = (exponential_map(surface, 0, 0.2, *(s * w)) for s in (1, 1 - h))
    across = 2 + 0.7 * np.cos(np.array([0.2, (end[1] + before[1]) / 2]))
    rate = np.array([w[0], (end[0] - before[0]) / h])
    assert across[0] ** 2 * rate[0] == pytest.approx(across[1] ** 2 * rate[1], rel=1e-6)
    assert abs(rate[1] / rate[0] - 1) > 0.1


def test_leaving_the_chart_is_an_error():
    with pytest.raises(SurfaceError, match="outside") as caught:
        exponential_map(charts.stereographic(), 1.2, 0, [-0.1, 0.9], 0)
    assert caught.value.parameters[0, 0] > 1.5
    with pytest.raises(RankLossError) as caught:  # due north, into the pole
        exponential_map(charts.sphere(), 0, 0.5, 0, -0.5)
    assert caught.value.parameters == pytest.approx(np.zeros((1, 2)), abs=1e-6)
    exponential_map(charts.sphere(), 6.2, 1.5, 0.5, 0)  # over the seam


def test_around_a_pole_of_the_chart_there_is_no_fan():
    with pytest.raises(RankLossError):
        ball_average_laplacian(charts.sphere(), lambda x, y, z: z, 0.0, 0.0, 0.1)


@pytest.mark.parametrize("radius", [0, -1, np.nan, np.inf])
def test_the_radius_is_positive(radius):
    with pytest.raises(SurfaceError, match="radius"):
        ball_average_laplacian(charts.torus(), lambda x, y, z: z, 0.0, 0.0, radius)


def test_names_are_checked():
    for options in ({"over": "ball"}, {"of": "points"}):
        with pytest.raises(UnknownNameError):
            ball_average_laplacian(charts.torus(), lambda x, y, z: z, 0, 0, 0.1, **options)


def test_on_the_plane_the_means_of_quadratics_are_exact():
    """In any parameters: here the plane is sheared and stretched."""
    plane = ParametricSurface(lambda u, v: (3 * u + v, v - 0.5 * u), Disk(2.0))

    def quadratic(x, y):
        return x**2 + x * y - 3 * y**2

    def square(u, v):
        return u**2

    u, v = np.array([[0.1], [0.4]]), np.array([0.0, 0.2, -0.3])
    for over in ("disk", "circle"):
        delta = ball_average_laplacian(
            plane, lambda x, y: x**2 + x * y - 3 * y**2, u, v, 0.5, over=over
        )
        assert delta.shape == (2, 3)
        assert np.allclose(delta, -4, atol=1e-9)
        of_uv = ball_average_laplacian(
            plane, lambda u, v: u**2, 0, 0, 0.5, over=over, of="parameters"
        )
        exact = plane.laplace_beltrami(lambda u, v: u**2, of="parameters")(0, 0)
        assert of_uv == pytest.approx(exact, rel=1e-9)


def test_the_mean_may_be_of_any_code():
    plane = ParametricSurface(lambda u, v: (u, v), Disk(2.0))
    norm2 = lambda x, y: np.linalg.norm(np.stack([x, y]), axis=0) ** 2  # noqa: E731
    assert ball_average_laplacian(plane, norm2, 0.5, 0.5, 0.3) == pytest.approx(4)
