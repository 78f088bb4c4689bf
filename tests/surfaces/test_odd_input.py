"""What a surface is given by mistake: refused by name, and never answered with a wrong number."""

import math

import numpy as np
import pytest

from beltrami.errors import (
    BeltramiError,
    DimensionError,
    NonFiniteError,
    NotDifferentiableError,
    SurfaceError,
)
from beltrami.surfaces.atlas import Atlas
from beltrami.surfaces.ball_average import ball_average_laplacian
from beltrami.surfaces.domain import Disk, Rectangle
from beltrami.surfaces.geodesics import exponential_map
from beltrami.surfaces.surface import ParametricSurface

SQUARE = ((0, 1), (0, 1))


def plane(u, v):
    return u, v, 0


def test_a_curve_run_through_backwards_has_the_same_length():
    surface = ParametricSurface(plane, SQUARE)
    for route in ("intrinsic", "extrinsic"):
        assert surface.curve_length(lambda t: (t, t), 1, 0, route=route) == pytest.approx(2**0.5)


@pytest.mark.parametrize("ends", [("a", 1), (None, 1), (1j, 1), ([0, 1], 1), (0, np.inf)])
@pytest.mark.parametrize("route", ["intrinsic", "extrinsic"])
def test_a_curve_runs_between_two_finite_numbers(ends, route):
    with pytest.raises(DimensionError, match="two finite numbers"):
        ParametricSurface(plane, SQUARE).curve_length(lambda t: (t, t), *ends, route=route)


@pytest.mark.parametrize(
    "phi",
    [
        lambda u, v: (u, v, 1j * u),
        lambda u, v: (u, v, np.exp(1j * u)),
        lambda u, v: np.stack([u, v, 1j * u]),
        lambda u, v: (u, v, 1j),
    ],
)
def test_imaginary_parts_are_not_dropped(phi):
    with pytest.raises(DimensionError, match="complex"):
        ParametricSurface(phi, SQUARE)
    with pytest.raises(DimensionError, match="complex"):
        ParametricSurface(plane, SQUARE).laplace_beltrami(lambda x, y, z: 1j * x)(0.5, 0.5)


@pytest.mark.parametrize("phi", [lambda u, v: (), lambda u, v: (u, v, [[1], [2, 3]])])
def test_maps_that_return_nothing_or_ragged_rows(phi):
    with pytest.raises(DimensionError, match="returned the shape"):
        ParametricSurface(phi, SQUARE)


def test_methods_of_arrays_have_no_known_derivative():
    surface = ParametricSurface(lambda u, v: (u, v, u.sum()), SQUARE)
    with pytest.raises(NotDifferentiableError, match=r"\.sum"):
        surface.jacobian(0.5, 0.5)


def test_a_map_may_write_into_what_it_is_given():
    def f(u, v):
        u *= 2
        return u**2

    surface = ParametricSurface(lambda u, v: (u, v), ((-1, 1), (-1, 1)))
    found = ball_average_laplacian(surface, f, 0.3, 0.1, 0.1, of="parameters")
    assert found == pytest.approx(8, abs=1e-6)


@pytest.mark.parametrize("scale", [1e-170, 1e-90, 1e90, 1e170])
def test_surfaces_whose_metric_leaves_the_floats_are_refused(scale):
    with pytest.raises(SurfaceError, match="range of floats"):
        ParametricSurface(lambda u, v: (scale * u, scale * v, scale * u * v), SQUARE)
    with pytest.raises(SurfaceError, match="range of floats"):
        ParametricSurface(plane, ((0, scale), (0, 1)))


@pytest.mark.parametrize("size", [1e-50, 1e50])
def test_others_have_their_curvature(size):
    surface = ParametricSurface(lambda u, v: (size * u, size * v, size * u * v), SQUARE)
    assert surface.gaussian_curvature(0, 0) * size**2 == pytest.approx(-1)


def test_a_function_that_is_not_finite_has_no_average():
    surface = ParametricSurface(plane, SQUARE)
    with pytest.raises(SurfaceError, match="f is NaN"):
        ball_average_laplacian(surface, lambda x, y, z: x * np.nan, 0.5, 0.5, 0.1)
    for radius in ("a", None, 1j, [0.1, 0.2]):
        with pytest.raises(SurfaceError, match="radius"):
            ball_average_laplacian(surface, lambda x, y, z: x, 0.5, 0.5, radius)
    for directions in (-1, "a", None):
        with pytest.raises(BeltramiError, match="directions"):
            ball_average_laplacian(surface, lambda x, y, z: x, 0.5, 0.5, 0.1, directions=directions)


def test_where_the_jacobian_is_not_finite_no_geodesic_starts():
    edge = ParametricSurface(lambda u, v: (u, v, np.maximum(u, v)), SQUARE)
    with pytest.raises(NotDifferentiableError):
        ball_average_laplacian(edge, lambda x, y, z: x, 0.5, 0.5, 0.1)


@pytest.mark.parametrize("velocity", ["a", 1j, [[1], [2, 3]], [1, 2, 3]])
def test_velocities_that_are_none(velocity):
    with pytest.raises(DimensionError):
        exponential_map(ParametricSurface(plane, SQUARE), [0.1, 0.2], 0.1, velocity, 0)
    with pytest.raises(NonFiniteError):
        exponential_map(ParametricSurface(plane, SQUARE), 0.1, 0.1, np.nan, 0)


@pytest.mark.parametrize("periodic", [(True, True, True), "ab", (np.nan, 0), (1, 0), True, None])
def test_periodic_is_two_truth_values(periodic):
    with pytest.raises(SurfaceError, match="truth values"):
        ParametricSurface(plane, SQUARE, periodic=periodic)
    with pytest.raises(SurfaceError, match="truth values"):
        Rectangle((0, 1), (0, 1), periodic)


@pytest.mark.parametrize("pair", [(0, 1, 2), ("a", 1), None, (0, 1j), 5, (0, 10**400)])
def test_intervals_and_centers_are_two_numbers(pair):
    with pytest.raises(SurfaceError):
        Rectangle(pair, (0, 1))
    with pytest.raises(SurfaceError):
        ParametricSurface(plane, (pair, (0, 1)))
    with pytest.raises(SurfaceError):
        Disk(1.0, pair)


@pytest.mark.parametrize("radius", ["a", None, 1j, np.nan, 0, -1])
def test_a_radius_is_a_positive_number(radius):
    with pytest.raises(SurfaceError, match="radius"):
        Disk(radius)
    with pytest.raises(SurfaceError, match="center"):
        Disk(1.0, (np.nan, 0))
    assert str(Disk(1.0, np.zeros(2))) == "the disk of radius 1"


def test_what_an_atlas_refuses():
    surface = ParametricSurface(plane, SQUARE)
    for charts in ([1], None, surface):
        if charts is not surface:
            with pytest.raises(SurfaceError, match="surfaces"):
                Atlas(charts)
    atlas = Atlas([surface])
    for point in ([[np.nan, 0, 0]], [[np.inf, 0, 0]]):
        with pytest.raises(NonFiniteError):
            atlas.locate(point)
    for number in (1, -1, "a", 0.0, None, False):
        with pytest.raises(SurfaceError, match="chart"):
            atlas.covers(number, [[0.5, 0.5, 0]])
        with pytest.raises(SurfaceError, match="chart"):
            atlas.transition(0, number)


def test_what_is_no_function_is_refused():
    with pytest.raises(SurfaceError, match="functions"):
        ParametricSurface(3, SQUARE)
    with pytest.raises(SurfaceError, match="functions"):
        ParametricSurface(plane, SQUARE, jacobian=3)


@pytest.mark.parametrize("thing", [None, 3, "cos", np.zeros(3)])
def test_curves_and_functions_are_functions(thing):
    surface = ParametricSurface(plane, SQUARE)
    for refused in (
        lambda: surface.trace(thing, [0.5]),
        lambda: surface.curve_length(thing),
        lambda: surface.pullback(thing),
        lambda: surface.laplace_beltrami(thing),
        lambda: ball_average_laplacian(surface, thing, 0.5, 0.5, 0.1),
        lambda: ball_average_laplacian(surface, thing, 0.5, 0.5, 0.1, of="parameters"),
    ):
        with pytest.raises(SurfaceError, match="where a function is needed"):
            refused()


@pytest.mark.parametrize("thing", [3, "sphere", plane, np.zeros(3)])
def test_surfaces_are_surfaces(thing):
    surface = ParametricSurface(plane, SQUARE)
    for refused in (
        lambda: exponential_map(thing, 0.5, 0.5, 0.1, 0.1),
        lambda: ball_average_laplacian(thing, lambda x, *_: x, 0.5, 0.5, 0.1),
        lambda: surface.is_isometric(thing),
    ):
        with pytest.raises(SurfaceError, match="a ParametricSurface is needed"):
            refused()


def test_maps_that_take_no_arrays_are_told_to_use_numpy():
    for phi in (lambda u, v: (u, v, math.sin(u)), lambda u: (u, u, u), lambda u, v, w: (u, v, w)):
        with pytest.raises(SurfaceError, match="φ cannot be called with 2 arrays") as caught:
            ParametricSurface(phi, SQUARE)
        assert isinstance(caught.value.__cause__, TypeError)
    with pytest.raises(SurfaceError, match="the curve cannot be called"):
        ParametricSurface(plane, SQUARE).trace(lambda t: (math.sin(t), t), [0.1, 0.2])


def test_conditions_on_arrays_are_told_to_use_numpy():
    for phi in (
        lambda u, v: (u, v, u if u > 0 else 0 * u),
        lambda u, v: np.eye(3, 2) @ np.array([u, v]),
    ):
        with pytest.raises(
            SurfaceError, match=r"φ cannot be called with 2 arrays.*numpy"
        ) as caught:
            ParametricSurface(phi, SQUARE)
        assert isinstance(caught.value.__cause__, ValueError)


def test_a_function_of_parameters_where_one_of_space_is_needed():
    surface = ParametricSurface(plane, SQUARE)
    coordinates = surface(0.5, 0.5).shape[-1]
    told = rf"the {coordinates} coordinates of points.*of=\"parameters\""
    for ask in (
        lambda: surface.laplace_beltrami(lambda u, v, *, w: u)(0.5, 0.5),
        lambda: surface.pullback(lambda u: u)(0.5, 0.5),
        lambda: ball_average_laplacian(surface, lambda: 1.0, 0.5, 0.5, 0.1),
    ):
        with pytest.raises(SurfaceError, match=told):
            ask()
