"""The figures of maps show what they say: no fold by positive weights, folds of flattenings."""

import runpy
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import beltrami as bt

EXAMPLE = Path(__file__).parents[1] / "examples" / "maps.py"


@pytest.fixture(scope="module")
def maps():
    return runpy.run_path(str(EXAMPLE))


@pytest.mark.chapter("F3.10", "F3.11")
def test_the_figures(maps, tmp_path):
    flipped, flattened = maps["main"](tmp_path)
    assert flipped == [0] * 8
    assert flattened[0] == 0
    assert min(flattened[1:]) > 20
    for name, count, rows in (("parameterizations", 4, 4), ("flattenings", 3, 2)):
        with Image.open(tmp_path / f"{name}.png") as picture:
            pixels = np.asarray(picture.convert("L"), dtype=int)
        assert pixels.shape[1] == 320 * count
        for row in np.array_split(pixels, rows):
            for panel in np.split(row, count, axis=1):
                assert (panel < 128).any()


@pytest.mark.chapter("F3.10")
def test_the_maps_differ_as_they_should(maps):
    found = maps["parameterizations"](maps["sheet"](2.0))
    energies = [psi.distortion.symmetric_dirichlet for psi in found]
    # a circle is the best boundary of a bump in its middle, up to where the iterations stop
    assert energies[7] == pytest.approx(energies[6], rel=1e-4)
    assert max(energies[6:]) < min(energies[:6])
    aside = maps["sheet"](2.0, (0.35, 0.15))
    circle, free = (bt.parameterize(aside, method) for method in ("auto", "free"))
    assert free.distortion.symmetric_dirichlet < 0.99 * circle.distortion.symmetric_dirichlet
    assert energies[4] < energies[3]  # positive weights, the same square
    square = np.abs(found[3].uv)
    assert square.max() < 1.1
    assert (square.min(axis=1) > 0.9).any()  # a corner


@pytest.mark.chapter("P74")
def test_the_colours_are_those_of_the_distortion(maps):
    psi = maps["parameterizations"](maps["sheet"](2.0))[3]
    colours = maps["stretch"](psi)
    assert colours.shape == (psi.mesh.n_vertices,)
    vertex = int(colours.argmax())
    around = psi.mesh.face_ring(vertex)
    energy = np.log10(psi.distortion.energy[around])
    assert energy.min() <= colours[vertex] <= energy.max()
