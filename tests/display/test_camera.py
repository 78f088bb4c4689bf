import numpy as np
import pytest

from beltrami.display.camera import Camera
from beltrami.errors import DimensionError, MeshError, NonFiniteError


@pytest.mark.chapter("P8")
def test_known_points_have_known_images():
    # the eye at z = 4 with a half angle of 45 degrees: at the depth d the picture is 2 d wide
    camera = Camera((0, 0, 4), (0, 0, 0), (0, 1, 0), 90)
    points = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [2, 0, 2], [0, 0, -4]]
    expected = [[50, 50, 4], [100, 50, 4], [50, 0, 4], [100, 50, 2], [50, 50, 8]]
    assert np.allclose(camera.project(points, (100, 100)), expected, atol=1e-12)


def test_the_shorter_side_spans_the_field_of_view():
    camera = Camera((0, 0, 4), (0, 0, 0), (0, 1, 0), 90)
    assert np.allclose(camera.project([[0, 4, 0]], (300, 100)), [[150, 0, 4]])
    assert np.allclose(camera.project([[4, 0, 0]], (100, 300)), [[100, 150, 4]])


def test_axes_are_orthonormal_and_right_handed():
    camera = Camera((3, -2, 7), (1, 1, 0.5), (0.2, 1, 0.1))
    right, up, forward = camera.axes
    assert np.allclose(camera.axes @ camera.axes.T, np.eye(3))
    assert np.allclose(np.cross(right, up), -forward)
    assert up @ (0.2, 1, 0.1) > 0


def test_a_point_behind_the_eye_is_named():
    camera = Camera((0, 0, 4), (0, 0, 0), (0, 1, 0))
    with pytest.raises(MeshError) as caught:
        camera.project([[0, 0, 0], [0, 0, 5], [0, 0, 4]], (10, 10))
    assert caught.value.vertices.tolist() == [1, 2]


@pytest.mark.parametrize(
    ("arguments", "error"),
    [
        (((0, 0, 4), (0, 0, 0), (0, 0, 1)), MeshError),  # looks along its vertical
        (((0, 0, 0), (0, 0, 0), (0, 1, 0)), MeshError),  # looks nowhere
        (((0, 0, 4), (0, 0, 0), (0, 1, 0), 180), MeshError),
        (((0, 0, 4), (0, 0, 0), (0, 1, 0), np.nan), MeshError),
        (((0, 0), (0, 0, 0), (0, 1, 0)), DimensionError),
        (((0, 0, np.nan), (0, 0, 0), (0, 1, 0)), NonFiniteError),
    ],
)
def test_impossible_cameras_are_refused(arguments, error):
    with pytest.raises(error):
        Camera(*arguments)
