"""The figure of the waves shows what it says: bumps that part, an energy that stays."""

import runpy
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import beltrami as bt

EXAMPLE = Path(__file__).parents[1] / "examples" / "waves.py"


@pytest.fixture(scope="module")
def waves():
    return runpy.run_path(str(EXAMPLE))


@pytest.mark.chapter("F3.6", "P48")
def test_the_figure(waves, tmp_path):
    strays = waves["main"](tmp_path)
    assert max(strays) < 1e-12
    for name, width in (("sphere", 320), ("creature", 460)):
        with Image.open(tmp_path / f"wave_{name}.png") as picture:
            pixels = np.asarray(picture.convert("RGB"), dtype=int)
        assert pixels.shape[1] == 4 * width
        red, blue = pixels[..., 0], pixels[..., 2]
        for panel in np.split(red - blue, 4, axis=1)[:3]:  # then it is on the other side
            assert panel.max() > 25  # a crest ...
            assert panel.min() < -25  # ... and a trough


@pytest.mark.chapter("F3.6")
def test_waves_run_away_from_where_they_began(waves):
    """At the speed 1: the crest is at the distance of the time, up to the width of the bump."""
    sphere = bt.shapes.icosphere(4)
    (north,) = waves["corners"](sphere, [(0, 0, 1)])
    frames, _ = waves["swing"](sphere, [north], [1])
    distance = bt.geodesic_distance(sphere, north, method="exact")
    unit = sphere.area**0.5
    for time, frame in zip(waves["TIMES"], frames, strict=True):
        crest = distance[frame.argmax()]
        assert abs(crest - time * unit) < 0.1 * unit
    assert abs(frames[0].argmax() - north) == 0
