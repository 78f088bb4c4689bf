"""Definition 1: parametric surfaces, one chart or several (E2)."""

import numpy as np
import pytest

import charts
from beltrami.errors import RankLossError
from beltrami.surfaces.atlas import Atlas
from charts import inside


@pytest.mark.chapter("D1")
@pytest.mark.parametrize("name", ["sphere", "skewed_sphere", "stereographic"])
def test_the_sphere_is_where_n_is_1(name):
    surface = getattr(charts, name)()
    u, v = surface.domain.samples(100)
    assert np.abs(np.linalg.norm(surface(u, v), axis=-1) - 1).max() < 1e-15 * 4
    assert np.abs((surface.mesh(20, 12).vertices ** 2).sum(axis=1) - 1).max() < 1e-14


@pytest.mark.chapter("D1")
def test_the_jacobian_has_rank_2_off_the_poles_and_1_there():
    surface = charts.sphere()
    u, v = inside(surface)
    assert (np.linalg.matrix_rank(surface.jacobian(u, v)) == 2).all()
    for pole in (0.0, np.pi):
        assert np.linalg.matrix_rank(surface.jacobian(0.3, pole), tol=1e-9) == 1
        assert np.linalg.det(surface.first_fundamental_form(0.3, pole)) < 1e-30
        with pytest.raises(RankLossError) as caught:
            surface.laplace_beltrami(lambda x, y, z: z)(0.3, pole)
        assert caught.value.parameters.tolist() == [[0.3, pole]]
    assert np.linalg.det(surface.first_fundamental_form(0.3, np.pi / 2)) == pytest.approx(1)


@pytest.mark.chapter("P1")
def test_the_sphere_on_two_disks():
    """Same length of a curve, same Laplacian, and I changes by JᵀIJ, on the overlap."""
    north, south = charts.stereographic(1), charts.stereographic(-1)
    change = Atlas([north, south]).transition(0, 1)

    def curve(t):
        return 0.9 + 0.3 * t, 0.5 * np.sin(3 * t) - 0.2 * t**2

    def other(t):
        return change(*curve(t))

    t = np.linspace(0, 1, 7)
    assert np.allclose(north.trace(curve, t), south.trace(other, t), atol=1e-14)
    for route, digits in (("intrinsic", 1e-13), ("extrinsic", 1e-13)):
        length = north.curve_length(curve, route=route, pieces=64)
        assert south.curve_length(other, route=route, pieces=64) == pytest.approx(
            length, rel=digits
        )
    assert not np.allclose(np.array(curve(t)), np.array(other(t)), atol=0.1)

    u, v = curve(t)
    there = change(u, v)
    for f in (lambda x, y, z: z + x * y, lambda x, y, z: np.exp(x) * y - z**3):
        here = north.laplace_beltrami(f)(u, v)
        assert np.allclose(south.laplace_beltrami(f)(*there), here, rtol=1e-11, atol=1e-12)


@pytest.mark.chapter("P2")
@pytest.mark.parametrize("name", ["sphere", "torus", "stereographic", "klein"])
def test_a_traced_curve_lies_on_the_surface(name):
    surface = getattr(charts, name)()

    def curve(t):
        return 0.4 + 0.5 * t, 0.3 + t**2 / 2

    t = np.linspace(0, 1, 12).reshape(3, 4)
    points = surface.trace(curve, t)
    assert points.shape == (3, 4, surface.dimension)
    assert np.array_equal(points, surface(0.4 + 0.5 * t, 0.3 + t**2 / 2))
