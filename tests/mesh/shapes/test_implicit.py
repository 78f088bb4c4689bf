import numpy as np
import pytest

from beltrami.mesh.shapes.implicit import Skin, field, project


@pytest.fixture
def skin():
    rng = np.random.default_rng(582_113_907)
    balls = np.zeros((9, 9))
    balls[:, :3] = rng.normal(size=(9, 3))
    balls[:, 3] = rng.uniform(0.2, 0.9, 9)
    direction = rng.normal(size=(9, 3))
    balls[:, 4:7] = direction / np.linalg.norm(direction, axis=1, keepdims=True)
    balls[:, 7] = rng.uniform(1, 3, 9)
    balls[:, 8] = rng.uniform(0, 0.3, 9)
    return Skin(balls, 7.0)


@pytest.fixture
def points():
    return np.random.default_rng(60_914_551).normal(scale=1.5, size=(200, 3))


def _reference(points, skin):
    """The formula of the docstring, with numpy."""
    p = points * (1, 1, 1)
    p[:, 1] = np.abs(p[:, 1])
    q = p[:, None] - skin.balls[None, :, :3]
    q[:, :, 1] += skin.balls[:, 8]
    normal = skin.balls[:, 4:7]
    q += ((skin.balls[:, 7] - 1) * (q * normal).sum(axis=2))[:, :, None] * normal
    d = np.linalg.norm(q, axis=2) - skin.balls[:, 3]
    return -np.log(np.exp(-skin.sharpness * d).sum(axis=1)) / skin.sharpness


def test_kernel_is_the_formula(skin, points):
    f, _ = field(points, skin)
    assert np.allclose(f, _reference(points, skin), rtol=1e-10, atol=1e-12)


def test_gradient_is_the_derivative(skin, points):
    _, gradient = field(points, skin)
    h = 1e-5
    for axis in range(3):
        step = np.eye(3)[axis] * h
        slope = (_reference(points + step, skin) - _reference(points - step, skin)) / (2 * h)
        assert np.allclose(gradient[:, axis], slope, atol=1e-7)


def test_far_away_nothing_overflows(skin):
    f, gradient = field(np.array([[500.0, 3.0, -700.0], [0.0, 1e8, 0.0]]), skin)
    assert np.isfinite(f).all()
    assert np.isfinite(gradient).all()
    assert (f > 400).all()


def test_mirror_images_are_exact_and_the_plane_is_kept(skin, points):
    mirror = (1.0, -1.0, 1.0)
    there = project(points, skin, 2)
    assert np.array_equal(project(points * mirror, skin, 2), there * mirror)
    points[:, 1] = 0.0
    assert (project(points, skin, 3)[:, 1] == 0).all()


def test_newton_reaches_the_level(skin, points):
    near = points[np.abs(field(points, skin)[0]) < 0.3]
    assert len(near) > 10
    for level in (0.0, 0.1):
        f, _ = field(project(near, skin, 8, level), skin)
        assert np.median(np.abs(f - level)) < 1e-12


def test_keel_makes_a_sharp_rim():
    lens = Skin(np.array([[0, 0, 0, 1.0, 0, 0, 1, 1, 0.8]]), 20.0)
    rim = project(np.array([[0.5, 0.0, 0.0], [0.6, 1e-9, 0.0]]), lens, 5)
    assert rim[0, 0] == pytest.approx(0.6)  # half height: sqrt(1 - 0.8^2)
    _, gradient = field(np.array([[0.6, 1e-9, 0.0], [0.6, -1e-9, 0.0]]), lens)
    assert np.allclose(gradient, [[0.6, 0.8, 0], [0.6, -0.8, 0]], atol=1e-6)
