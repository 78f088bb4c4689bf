"""The atlas: finding parameters, changing charts, refusals."""

import numpy as np
import pytest

import charts
from beltrami.errors import DimensionError, SurfaceError
from beltrami.surfaces.atlas import Atlas
from beltrami.surfaces.domain import Disk
from beltrami.surfaces.jets import variables
from beltrami.surfaces.surface import ParametricSurface

pytestmark = pytest.mark.chapter("P1")


def two_disks(radius=1.5):
    return Atlas([charts.stereographic(1, radius), charts.stereographic(-1, radius)])


def random_directions(n):
    x = np.random.default_rng(2718281).normal(size=(n, 3))
    return x / np.linalg.norm(x, axis=1, keepdims=True)


def test_two_disks_cover_the_sphere():
    atlas, x = two_disks(), random_directions(500)
    which, uv = atlas.locate(x)
    assert set(which) == {0, 1}
    for number in (0, 1):
        here = which == number
        assert np.allclose(atlas.charts[number](*uv[here].T), x[here], atol=1e-14)
    edge = (1 - 1.5**2) / (1 + 1.5**2)  # the height that the disk of radius 1.5 reaches
    assert np.array_equal(atlas.covers(0, x), x[:, 2] >= edge)
    assert np.array_equal(atlas.covers(1, x), x[:, 2] <= -edge)


def test_one_disk_does_not():
    atlas = Atlas([charts.stereographic()])
    with pytest.raises(SurfaceError, match=r"on no chart: rows \[1\]"):
        atlas.locate([[0, 0, 1], [0, 0, -1]])
    off = [[0, 0, 1.1], [0, 0, 0.999999]]
    assert not atlas.covers(0, off).any()


def test_poles_and_seams_are_found():
    sphere = Atlas([charts.sphere()])
    x = np.concatenate([random_directions(50), [[0, 0, 1], [0, 0, -1], [1, 0, 0], [0.6, 0, 0.8]]])
    _, uv = sphere.locate(x)
    assert np.allclose(sphere.charts[0](*uv.T), x, atol=1e-12)
    torus = Atlas([charts.torus()])
    x = charts.torus()(*charts.torus().domain.samples(60))
    assert np.allclose(charts.torus()(*torus.locate(x)[1].T), x, atol=1e-13)


def test_the_change_of_charts_is_the_inversion():
    """φ_2⁻¹ ∘ φ_1 (u, v) = (u, -v) / (u² + v²), with its derivatives."""
    change = two_disks().transition(0, 1)
    u, v = np.array([[0.8], [-0.9], [1.0]]), np.array([[0.4], [0.7], [-0.6]])

    def exact(u, v):
        return u / (u**2 + v**2), -v / (u**2 + v**2)

    for mine, true in zip(change(u, v), exact(u, v), strict=True):
        assert mine.shape == (3, 1)
        assert np.allclose(mine, true, rtol=1e-13)
    for mine, true in zip(change(*variables(u, v)), exact(*variables(u, v)), strict=True):
        assert np.allclose(mine.value, true.value, rtol=1e-13)
        for a, b in zip((*mine.first, *mine.second), (*true.first, *true.second), strict=True):
            assert np.allclose(a, b, rtol=1e-11, atol=1e-11)


def test_the_direction_of_a_change_of_charts():
    """From spherical to stereographic parameters: tan(v / 2) (cos u, sin u), and not back."""
    atlas = Atlas([charts.sphere(), charts.stereographic()])
    u, v = np.array([0.3, 2.0]), np.array([0.9, 1.4])
    x, y = atlas.transition(0, 1)(u, v)
    assert np.allclose(x, np.tan(v / 2) * np.cos(u), rtol=1e-12)
    assert np.allclose(y, np.tan(v / 2) * np.sin(u), rtol=1e-12)
    assert np.allclose(atlas.transition(1, 0)(x, y), (u, v), rtol=1e-12)


def test_there_and_back():
    atlas = two_disks()
    u, v = 1.0, np.array([0.2, 0.5])
    back = atlas.transition(1, 0)(*atlas.transition(0, 1)(u, v))
    assert np.allclose(back[0], u, rtol=1e-13)
    assert np.allclose(back[1], v, rtol=1e-13)


def test_off_the_overlap_is_refused():
    with pytest.raises(SurfaceError, match="not on chart 1") as caught:
        two_disks().transition(0, 1)([0.1, 0.9], 0.0)
    assert caught.value.parameters.tolist() == [[0.1, 0]]


def test_what_is_no_atlas():
    with pytest.raises(SurfaceError, match="without charts"):
        Atlas([])
    plane = ParametricSurface(lambda u, v: (u, v), Disk(1.0))
    with pytest.raises(DimensionError, match=r"R\^3, R\^2"):
        Atlas([charts.stereographic(), plane])
    for points in ([0, 0, 1], [[0, 1]]):
        with pytest.raises(DimensionError):
            two_disks().locate(points)
    assert repr(two_disks()) == "<Atlas of 2 charts in R^3>"


def test_the_laplacian_at_points_uses_whichever_chart():
    x = random_directions(100)
    delta = two_disks().laplace_beltrami(lambda x, y, z: z + x * y)(x)
    assert np.allclose(delta, -2 * x[:, 2] - 6 * x[:, 0] * x[:, 1], atol=1e-12)
