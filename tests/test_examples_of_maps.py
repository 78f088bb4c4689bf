"""The figures of maps show what they say: no fold by positive weights, folds of flattenings."""

import runpy
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

EXAMPLE = Path(__file__).parents[1] / "examples" / "maps.py"


@pytest.fixture(scope="module")
def maps():
    return runpy.run_path(str(EXAMPLE))


@pytest.mark.chapter("F3.10", "F3.11")
def test_the_figures(maps, tmp_path):
    flipped, flattened = maps["main"](tmp_path)
    assert flipped == [0, 0, 0, 0, 0]
    assert flattened[0] == 0
    assert min(flattened[1:]) > 20
    for name, count in (("parameterizations", 5), ("flattenings", 3)):
        with Image.open(tmp_path / f"{name}.png") as picture:
            pixels = np.asarray(picture.convert("L"), dtype=int)
        assert pixels.shape[1] == 300 * count
        for panel in np.split(pixels, count, axis=1):
            assert (panel < 128).any()


@pytest.mark.chapter("F3.10")
def test_the_maps_differ_as_they_should(maps):
    found = maps["parameterizations"](maps["sheet"](2.0))
    energies = [psi.distortion.symmetric_dirichlet for psi in found]
    assert energies[4] == min(energies)
    assert energies[3] < min(energies[:3])
    square = np.abs(found[2].uv)
    assert square.max() < 1.1
    assert (square.min(axis=1) > 0.9).any()  # a corner
