import numpy as np
import pytest

from beltrami.display.colormaps import color_table
from beltrami.display.values import as_values, choose_limits, seen_values
from beltrami.errors import DimensionError, MeshError, NonFiniteError
from beltrami.mesh.mesh import Mesh


def test_numbers_and_colours(square):
    assert as_values(square, [1, 2, 3, 4]).tolist() == [[1], [2], [3], [4]]
    assert as_values(square, np.full((4, 1), 7.0)).shape == (4, 1)
    assert as_values(square, np.full((4, 3), 0.25)).tolist() == [[0.25] * 3] * 4


def test_bytes_are_colours_and_other_integers_are_not(square):
    assert as_values(square, np.full((4, 3), 51, np.uint8)).tolist() == [[0.2] * 3] * 4
    with pytest.raises(MeshError):
        as_values(square, np.full((4, 3), 51))
    assert as_values(square, np.full(4, 51, np.uint8)).tolist() == [[51]] * 4  # numbers


@pytest.mark.parametrize(
    ("f", "error"),
    [
        (np.zeros(3), DimensionError),
        (np.zeros((4, 2)), DimensionError),
        (np.zeros((4, 3, 1)), DimensionError),
        ([0, 0, np.nan, 0], NonFiniteError),
        ([0, 0, np.inf, 0], NonFiniteError),
    ],
)
def test_what_is_no_function_is_refused(square, f, error):
    with pytest.raises(error):
        as_values(square, f)


def test_colours_outside_are_named(square):
    with pytest.raises(MeshError) as caught:
        as_values(square, [[0, 0, 0], [0, 0, 2], [1, 1, 1], [-1, 0, 0]])
    assert caught.value.vertices.tolist() == [1, 3]


def test_limits():
    f = np.array([-1.0, 3.0])
    assert choose_limits(f, None, None)[0] == (-3, 3)
    assert choose_limits(f, None, "sequential")[0] == (-1, 3)
    assert choose_limits(f, (-2, 5), None)[0] == (-2, 5)
    assert choose_limits(np.array([1.0, 3.0]), None, None)[0] == (1, 3)
    assert choose_limits(np.array([1.0, 3.0]), None, "diverging")[0] == (-3, 3)


def test_maps():
    assert np.array_equal(
        choose_limits(np.array([-1.0, 3]), None, None)[1], color_table("diverging")
    )
    assert np.array_equal(
        choose_limits(np.array([1.0, 3]), None, None)[1], color_table("sequential")
    )
    assert np.array_equal(choose_limits(np.array([1.0, 3]), None, "gray")[1], color_table("gray"))


@pytest.mark.parametrize("limits", [(1, 0), (0, np.inf), (np.nan, 1)])
def test_what_are_no_limits_is_refused(limits):
    with pytest.raises(MeshError):
        choose_limits(np.zeros(3), limits, None)


def test_values_that_no_face_shows_do_not_count():
    mesh = Mesh(np.zeros((4, 3)), [[0, 1, 3]])
    assert seen_values(mesh, np.array([1.0, 2, 999, 4])).tolist() == [1, 2, 4]
