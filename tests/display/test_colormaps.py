import numpy as np
import pytest

from beltrami.display.colormaps import COLORMAPS, color_table, is_signed, symmetric_limits
from beltrami.display.srgb import to_oklab
from beltrami.errors import DimensionError, MeshError, NonFiniteError, UnknownNameError


@pytest.mark.parametrize("name", COLORMAPS)
def test_colours_can_be_shown_and_change_in_small_steps(name):
    table = color_table(name)
    assert table.min() >= 0
    assert table.max() <= 1
    assert np.abs(np.diff(to_oklab(table), axis=0)).max() < 0.01


@pytest.mark.parametrize("name", ["sequential", "gray"])
def test_lightness_grows_evenly(name):
    steps = np.diff(to_oklab(color_table(name))[:, 0])
    assert steps.min() > 0
    assert steps.max() < 1.01 * steps.min()


def test_diverging_is_white_in_the_middle_and_as_dark_at_both_ends():
    lab = to_oklab(color_table("diverging"))
    lightness, chroma = lab[:, 0], np.hypot(lab[:, 1], lab[:, 2])
    assert np.allclose(lightness, lightness[::-1], atol=1e-6)
    half = len(lab) // 2
    assert np.diff(lightness[:half]).min() > 0
    assert lightness.max() > 0.96
    assert chroma[half - 1 : half + 1].max() < 0.01
    assert lab[0, 2] < -0.1  # blue below
    assert lab[-1, 1] > 0.1  # red above


@pytest.mark.chapter("P52")
def test_signs_and_limits():
    assert is_signed(np.array([-1.0, 0, 2]))
    assert not is_signed(np.array([0.0, 2]))
    assert not is_signed(np.array([-3.0, 0]))
    assert not is_signed(np.zeros(0))
    assert symmetric_limits(np.array([-1.0, 0, 2])) == (-2, 2)
    assert symmetric_limits(np.array([-5.0, 0, 2])) == (-5, 5)


@pytest.mark.parametrize(
    ("table", "error"),
    [
        ("virids", UnknownNameError),
        ([[0, 0, 0]], MeshError),
        ([[0, 0, 0], [0, 0, 1.5]], MeshError),
        ([[0, 0], [1, 1]], MeshError),
        (3.0, DimensionError),
        ([[0, 0, 0], [0, 0, np.nan]], NonFiniteError),
    ],
)
def test_what_is_no_map_is_refused(table, error):
    with pytest.raises(error):
        color_table(table)
