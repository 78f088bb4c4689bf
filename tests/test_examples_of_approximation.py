"""The figures of approximation show what they say: fast and slow decay; bytes for errors."""

import runpy
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

EXAMPLE = Path(__file__).parents[1] / "examples" / "approximation.py"


@pytest.mark.chapter("F3.8", "F3.9", "P60", "P66")
def test_the_figures(tmp_path):
    example = runpy.run_path(str(EXAMPLE))
    few, sizes, errors = example["main"](tmp_path, 900)
    (smooth, best_of_smooth), (jump, best_of_jump) = few.values()
    assert smooth < 0.15 * jump
    assert best_of_smooth <= smooth
    assert best_of_jump < jump
    assert (np.diff(sizes) > 0).all()
    assert (np.diff(errors) < 0).all()
    assert errors[0] > 0.05
    assert errors[-1] < 2e-3
    for name, width in (("spectra", 900), ("approximations", 3 * 520)):
        with Image.open(tmp_path / f"{name}.png") as picture:
            pixels = np.asarray(picture.convert("L"), dtype=int)
        assert pixels.shape[1] == width
        for panel in np.split(pixels, 3, axis=1):
            assert (panel < 128).any()
