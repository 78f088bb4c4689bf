import numpy as np
import pytest

from beltrami.display.srgb import as_color, from_linear, from_oklab, to_linear, to_oklab
from beltrami.errors import MeshError


def test_known_values_of_the_transfer_curve():
    # half the light of white is 188 of 255; the straight part has the slope 12.92
    assert round(255 * float(from_linear(np.array(0.5)))) == 188
    assert float(to_linear(np.array(0.02))) == pytest.approx(0.02 / 12.92)


def test_the_curve_and_its_inverse():
    values = np.linspace(0, 1, 1001)
    assert np.allclose(from_linear(to_linear(values)), values, atol=1e-12)
    assert np.all(np.diff(to_linear(values)) > 0)


def test_oklab_of_known_colours():
    assert np.allclose(to_oklab(np.ones(3)), [1, 0, 0], atol=1e-6)
    # published value of pure red
    red = to_oklab(np.array([1.0, 0, 0]))
    assert np.allclose(red, [0.62796, 0.22486, 0.12585], atol=1e-4)


def test_oklab_and_its_inverse():
    colors = np.random.default_rng(883_126_407).random((50, 3))
    assert np.allclose(from_oklab(to_oklab(colors)), colors, atol=1e-6)


def test_colours_are_read():
    assert as_color("#ff0080").tolist() == [1, 0, 128 / 255]
    assert as_color("black").tolist() == [0, 0, 0]
    assert as_color((0.1, 0.2, 0.3)).tolist() == [0.1, 0.2, 0.3]


@pytest.mark.parametrize("color", ["no colour", (0, 1), (0, 0, 1.1), (0, 0, np.nan)])
def test_what_is_no_colour_is_refused(color):
    with pytest.raises(MeshError):
        as_color(color)
