"""Figures 3.3 and 3.5, and how the best time grows with the noise."""

import runpy
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

EXAMPLE = Path(__file__).parents[1] / "examples" / "stopping_times.py"


@pytest.fixture(scope="module")
def played(tmp_path_factory):
    folder = tmp_path_factory.mktemp("figures")
    return folder, runpy.run_path(str(EXAMPLE))["main"](folder)


@pytest.mark.chapter("F3.3")
def test_smoothing_takes_energy_round_after_round(played):
    folder, (energies, *_) = played
    assert np.all(np.diff(energies) < 0)
    with Image.open(folder / "smoothing.png") as picture:
        pixels = np.asarray(picture.convert("L"), dtype=float)
    rows = np.split(pixels, 2)
    drawn = [(panel < 235).mean() for row in rows for panel in np.split(row, 3, axis=1)]
    assert np.all(np.diff(drawn) < 0)  # and it gets thinner


@pytest.mark.chapter("F3.5", "P43")
def test_the_error_has_a_minimum_inside_and_the_blind_one_is_below(played):
    folder, (_, errors, blind, _) = played
    best = int(errors.argmin())
    assert 0 < best < len(errors) - 1
    assert np.all(np.diff(errors[: best + 1]) < 0)
    assert np.all(np.diff(errors[best:]) > 0)
    assert blind < 0.7 * errors[best]
    assert {path.name for path in folder.iterdir()} == {
        "smoothing.png", "denoising.png", "errors.png", "stopping_times.png"
    }  # fmt: skip


@pytest.mark.chapter("P44")
def test_the_best_time_is_proportional_to_the_noise_only_for_one_derivative(played):
    _, (*_, slopes) = played
    assert list(slopes.values()) == pytest.approx([2 / 3, 1, 4 / 3], abs=0.05)
