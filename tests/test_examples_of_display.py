"""Figures 3.1 and 3.7: light that is interpolated or not, and modes with few regions."""

import runpy
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import beltrami as bt

EXAMPLES = Path(__file__).parents[1] / "examples"


@pytest.mark.chapter("F3.1")
def test_a_face_has_one_shade_unless_light_is_interpolated(tmp_path):
    display = runpy.run_path(str(EXAMPLES / "display.py"))
    flat, smooth = display["main"](tmp_path)
    assert smooth > 1.5 * flat
    corners = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
    tetrahedron = bt.Mesh(corners, [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])
    few, many = display["shades"](tetrahedron, zoom=1.0, focus=(0, 0, 0))
    assert 2 <= few <= 5  # at most four faces, and the background
    assert many > 20
    with Image.open(tmp_path / "display.png") as picture:
        whole, faces, light = np.split(np.asarray(picture.convert("L"), dtype=int), 3, axis=1)
    assert (faces[40:] < 60).sum() > 3 * (light[40:] < 60).sum()  # lines, below the captions
    assert 0.05 < (whole < 250).mean() < 0.4


@pytest.mark.chapter("F3.7", "P51")
def test_the_modes_keep_to_courants_theorem(tmp_path):
    figure = runpy.run_path(str(EXAMPLES / "eigenfunctions.py"))
    sphere, creature = figure["main"](tmp_path)
    assert tuple(creature) == figure["MODES"]
    assert all(count <= i + 1 for i, count in creature.items())  # all its eigenvalues are simple
    assert creature[1] == 2
    assert creature[100] > creature[10] > creature[2]
    for i, count in sphere.items():
        degree = int(i**0.5)  # λ = l (l + 1) comes 2 l + 1 times, from number l²
        assert 2 <= count <= (degree + 1) ** 2
    for name in ("sphere", "creature"):
        with Image.open(tmp_path / f"modes_{name}.png") as picture:
            pixels = np.asarray(picture.convert("RGB"), dtype=int)
        red_less_blue = pixels[..., 0] - pixels[..., 2]
        for panel in np.split(red_less_blue, 4, axis=1):
            assert panel.max() > 60
            assert panel.min() < -60
