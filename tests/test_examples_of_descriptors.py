"""The examples of descriptors and maps run, and show what they say."""

import runpy
from pathlib import Path

import numpy as np
from PIL import Image

EXAMPLES = Path(__file__).parents[1] / "examples"


def colours(path):
    with Image.open(path) as picture:
        return len(np.unique(np.asarray(picture.convert("RGB")).reshape(-1, 3), axis=0))


def test_descriptors(tmp_path):
    example = runpy.run_path(str(EXAMPLES / "descriptors.py"))
    assert example["main"](str(tmp_path / "d.png"), n_vertices=700) == 8
    assert colours(tmp_path / "d.png") > 1000


def test_correspondence(tmp_path):
    example = runpy.run_path(str(EXAMPLES / "correspondence.py"))
    before, after = example["main"](str(tmp_path / "c.png"), n_vertices=600)
    assert before > 0.03
    assert after < 0.7 * before
    assert colours(tmp_path / "c.png") > 1000
