"""What φ may be, what is refused, and shapes."""

import numpy as np
import pytest

import charts
from beltrami.errors import DimensionError, NotDifferentiableError, RankLossError, SurfaceError
from beltrami.surfaces.domain import Disk, Rectangle
from beltrami.surfaces.surface import ParametricSurface

SQUARE = ((0, 1), (0, 2))
WAYS = {
    "tuple": lambda u, v: (u * v, np.sin(u), v),
    "array": lambda u, v: np.array([u * v, np.sin(u), v]),
    "first axis": lambda u, v: np.stack([u * v, np.sin(u), v]),
    "last axis": lambda u, v: np.stack([u * v, np.sin(u), v], axis=-1),
    "through arrays": lambda u, v: (np.asarray(u) * v, np.sin(np.asarray(u)), v),
}


@pytest.mark.parametrize("n", [1, 2, 3, 7])
@pytest.mark.parametrize("way", WAYS)
def test_phi_may_return_its_coordinates_in_several_ways(way, n):
    surface = ParametricSurface(WAYS[way], SQUARE)
    u, v = surface.domain.samples(n)
    assert np.allclose(surface(u, v), np.stack([u * v, np.sin(u), v], axis=-1), rtol=1e-15)
    nil, one = np.zeros(n), np.ones(n)
    rows = [[v, u], [np.cos(u), nil], [nil, one]]
    assert np.allclose(surface.jacobian(u, v), np.moveaxis(np.array(rows), -1, 0), rtol=1e-15)
    assert np.isfinite(surface.gaussian_curvature(u, v)).all()


def test_constant_coordinates_are_spread():
    plane = ParametricSurface(lambda u, v: (u, v, 4), SQUARE)
    assert plane([0.1, 0.2], 1).tolist() == [[0.1, 1, 4], [0.2, 1, 4]]
    assert plane.is_isometric()


@pytest.mark.parametrize("shape", [(), (5,), (2, 3), (0,)])
def test_shapes(shape):
    surface = charts.torus()
    u, v = np.full(shape, 0.3), np.full(shape, 1.2)
    assert surface(u, v).shape == (*shape, 3)
    assert surface.jacobian(u, v).shape == (*shape, 3, 2)
    assert surface.first_fundamental_form(u, v).shape == (*shape, 2, 2)
    assert surface.first_fundamental_form(0.3, v).shape == (*shape, 2, 2)
    assert surface.gaussian_curvature(u, v).shape == shape
    assert surface.mean_curvature(u, v).shape == shape
    assert surface.area_element(u, v).shape == shape
    assert surface.laplace_beltrami(lambda x, y, z: x * y + z)(u, v).shape == shape


def test_a_given_jacobian_serves_where_phi_is_any_code():
    def phi(u, v):  # np.linalg.norm is not followed by jets
        s = 1 + np.linalg.norm(np.stack([u, v]), axis=0) ** 2
        return 2 * u / s, 2 * v / s, 2 / s - 1

    def jacobian(u, v):
        s = 1 + u**2 + v**2
        a, b = -4 * u / s**2, -4 * v / s**2
        return [[2 / s + u * a, u * b], [v * a, 2 / s + v * b], [a, b]]

    with pytest.raises(NotDifferentiableError, match="norm"):
        ParametricSurface(phi, Disk(1.5)).gaussian_curvature(0, 0)
    given = ParametricSurface(phi, Disk(1.5), jacobian=jacobian)
    u, v = given.domain.samples(20)
    other = charts.stereographic()
    assert np.allclose(given.gaussian_curvature(u, v), 1, rtol=1e-12)
    f = lambda x, y, z: z + x * y  # noqa: E731
    assert np.allclose(
        given.laplace_beltrami(f)(u, v), other.laplace_beltrami(f)(u, v), rtol=1e-10, atol=1e-10
    )

    def stacked(u, v):
        return np.stack([np.stack(row, axis=-1) for row in jacobian(u, v)], axis=-2)

    assert np.allclose(
        ParametricSurface(phi, Disk(1.5), jacobian=stacked).gaussian_curvature(u, v), 1, rtol=1e-12
    )


def test_with_a_hessian_nothing_is_differentiated():
    def plain(function):
        return lambda u, v: function(np.asarray(u, dtype=float), np.asarray(v, dtype=float))

    def hessian(u, v):
        return [[[2 + 0 * u, 0], [0, 0]], [[0, 1], [1, 0]], [[0, 0], [0, 6 * v]]]

    parts = (
        plain(lambda u, v: (u**2, u * v, v**3)),
        plain(lambda u, v: [[2 * u, 0], [v, u], [0, 3 * v**2]]),
        plain(hessian),
    )
    blind = ParametricSurface(parts[0], ((1, 2), (1, 2)), jacobian=parts[1], hessian=parts[2])
    seeing = ParametricSurface(lambda u, v: (u**2, u * v, v**3), ((1, 2), (1, 2)))
    at = blind.domain.samples(9)
    assert np.allclose(blind.gaussian_curvature(*at), seeing.gaussian_curvature(*at), rtol=1e-11)
    assert np.allclose(blind.mean_curvature(*at), seeing.mean_curvature(*at), rtol=1e-11)
    with pytest.raises(NotDifferentiableError):
        ParametricSurface(parts[0], ((1, 2), (1, 2)), jacobian=parts[1]).gaussian_curvature(*at)
    wrong = plain(lambda u, v: [[[2, 0], [0, 0]], [[0, 1], [1, 0]], [[0, 0], [0, 3 * v]]])
    with pytest.raises(SurfaceError, match="Hessian is not that"):
        ParametricSurface(parts[0], ((1, 2), (1, 2)), jacobian=parts[1], hessian=wrong)
    with pytest.raises(SurfaceError, match="without a Jacobian"):
        ParametricSurface(parts[0], ((1, 2), (1, 2)), hessian=parts[2])


@pytest.mark.parametrize(
    "jacobian",
    [
        lambda u, v: [[1, 0], [0, 1], [v, 1.001 * u]],
        lambda u, v: [[1, 0], [0, 1], [u, v]],
        lambda u, v: [[1, 0], [0, 1], [v, -u]],
        lambda u, v: [[0, 1], [1, 0], [u, v]],
    ],
)
def test_a_wrong_jacobian_is_refused(jacobian):
    with pytest.raises(SurfaceError, match="Jacobian is not that") as caught:
        ParametricSurface(lambda u, v: (u, v, u * v), SQUARE, jacobian=jacobian)
    assert len(caught.value.parameters)
    ParametricSurface(  # the right one is not
        lambda u, v: (u, v, u * v), SQUARE, jacobian=lambda u, v: [[1, 0], [0, 1], [v, u]]
    )


def test_a_jacobian_of_the_wrong_size_is_refused():
    with pytest.raises(DimensionError):
        ParametricSurface(lambda u, v: (u, v), SQUARE, jacobian=lambda u, v: [[1, 0]])


@pytest.mark.parametrize(
    "phi",
    [
        lambda u, v: u,
        lambda u, v: (u,),
        lambda u, v: 3.0,
        lambda u, v: (u, v, "z"),
        lambda u, v: (np.concatenate([u, u]), v),
        lambda u, v: None,
        lambda u, v: (u.ravel(), v.ravel(), u[:2, 0]),
    ],
)
def test_what_is_no_map_is_refused(phi):
    with pytest.raises(DimensionError):
        ParametricSurface(phi, SQUARE)


@pytest.mark.parametrize(
    "domain",
    [((0, 0), (0, 1)), ((0, 1), (2, 1)), ((0, np.inf), (0, 1)), (0, 1), "square", ((0, 1),)],
)
def test_wrong_domains(domain):
    with pytest.raises(SurfaceError):
        ParametricSurface(lambda u, v: (u, v), domain)


def test_periodic_belongs_to_intervals():
    for domain in (Disk(1.0), Rectangle((0, 1), (0, 1))):
        with pytest.raises(SurfaceError, match="periodic is for"):
            ParametricSurface(lambda u, v: (u, v), domain, periodic=(True, False))
    for radius in (0, -1, np.nan, np.inf):
        with pytest.raises(SurfaceError, match="radius"):
            Disk(radius)


def test_parameters_outside_are_named():
    surface = charts.sphere()
    surface([7.0, -100.0], [1.0, 2.0])  # u goes around
    with pytest.raises(SurfaceError, match="outside") as caught:
        surface([0.0, 1.0, 2.0], [0.5, 4.0, -0.1])
    assert caught.value.parameters.tolist() == [[1, 4], [2, -0.1]]
    with pytest.raises(SurfaceError, match="outside"):
        surface(np.nan, 1.0)
    with pytest.raises(SurfaceError, match="outside"):
        charts.stereographic()(1.2, 1.2)
    with pytest.raises(DimensionError):
        surface([0, 1], [0, 1, 2])


def test_points_that_are_not_finite_are_named():
    with pytest.raises(SurfaceError, match="NaN or infinite"):
        ParametricSurface(lambda u, v: (np.log(u), v), ((-1, 1), (0, 1)))
    surface = ParametricSurface(lambda u, v: (np.log(u), v), ((0, 1), (0, 1)))
    with pytest.raises(SurfaceError, match="NaN or infinite") as caught:
        surface([0.5, 0.0], 0.5)
    assert caught.value.parameters.tolist() == [[0, 0.5]]


def test_a_point_without_a_derivative_is_named():
    surface = ParametricSurface(lambda u, v: (u, v, np.abs(u)), ((-1, 1), (0, 1)))
    assert np.allclose(surface.gaussian_curvature([-0.5, 0.5], 0.5), 0)
    for ask in (surface.jacobian, surface.gaussian_curvature):
        with pytest.raises(NotDifferentiableError) as caught:
            ask([0.5, 0.0], 0.5)
        assert caught.value.parameters.tolist() == [[0, 0.5]]
    plane = ParametricSurface(lambda u, v: (u, v), ((-1, 1), (-1, 1)))
    with pytest.raises(NotDifferentiableError, match="f has no finite") as caught:
        plane.laplace_beltrami(lambda x, y: np.hypot(x, y))([0.0, 0.5], [0.0, 0.0])
    assert caught.value.parameters.tolist() == [[0, 0]]


def test_the_nearest_parameters_of_a_domain():
    around = Rectangle((1, 3), (0, 1), periodic=(True, False))
    u, v = around.nearest(np.array([0.5, 3.5, 2.0]), np.array([-1.0, 2.0, 0.3]))
    assert u.tolist() == [2.5, 1.5, 2]
    assert v.tolist() == [0, 1, 0.3]
    u, v = Disk(2.0, center=(1.0, 0.0)).nearest(np.array([5.0, 1.0]), np.array([0.0, 1.5]))
    assert (u.tolist(), v.tolist()) == ([3, 1], [0, 1.5])


def test_samples_are_inside_and_spread():
    for domain in (Rectangle((1, 3), (0, 1)), Disk(2.0, center=(1.0, 0.0))):
        u, v = domain.samples(4000)
        assert domain.contains(u, v).all()
        middle = {"Rectangle": (2, 0.5), "Disk": (1, 0)}[type(domain).__name__]
        assert (u.mean(), v.mean()) == pytest.approx(middle, abs=0.01)
    r = np.hypot(u - 1, v)  # evenly by area
    assert (r < 1).mean() == pytest.approx(1 / 4, abs=0.01)


@pytest.mark.chapter("D1")
@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_rank_loss_names_the_parameters_in_any_unit(scale):
    """E2: det I = 0 at the poles of the sphere, where definition 16 divides by sqrt(g)."""

    def phi(u, v):
        v = v / scale
        return scale * np.sin(v) * np.cos(u), scale * np.sin(v) * np.sin(u), scale * np.cos(v)

    surface = ParametricSurface(phi, (charts.TURN, (0, np.pi * scale)))
    poles = np.array([0.0, 0.5, 1.0]) * np.pi * scale
    g = np.linalg.det(surface.first_fundamental_form(1.0, poles)) / scale**2
    assert g == pytest.approx([0, 1, 0], abs=1e-14)
    asks = (
        surface.gaussian_curvature,
        surface.mean_curvature,
        surface.laplace_beltrami(lambda x, y, z: x),
    )
    for ask in asks:
        with pytest.raises(RankLossError) as caught:
            ask(1.0, poles)
        assert caught.value.parameters.tolist() == [[1, poles[0]], [1, poles[2]]]
        assert np.isfinite(ask(1.0, poles[1:2])).all()
    assert surface.gaussian_curvature(1, 1e-3 * poles[1]) == pytest.approx(scale**-2, rel=1e-8)


def test_a_map_to_a_line_is_no_immersion_anywhere():
    line = ParametricSurface(lambda u, v: (u + v, 2 * u + 2 * v, 0), SQUARE)
    with pytest.raises(RankLossError):
        line.gaussian_curvature(0.5, 0.5)


def test_surfaces_are_frozen():
    surface = charts.sphere()
    with pytest.raises(AttributeError):
        surface.domain = Disk(1.0)
    assert repr(surface) == "<ParametricSurface in R³ on [0, 6.28319) x [0, 3.14159]>"
    assert repr(charts.stereographic()).endswith("R³ on the disk of radius 1.5>")


def test_mean_curvature_needs_space():
    with pytest.raises(DimensionError):
        charts.klein().mean_curvature(0.1, 0.1)
