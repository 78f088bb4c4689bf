"""Integrals at the middles of the edges are of second order, as those at the vertices are."""

import numpy as np
import pytest

from beltrami.mesh.shapes import icosphere
from beltrami.mesh.shapes.subdivide import subdivide
from beltrami.operators.areas import AREA_KINDS
from beltrami.operators.edge_areas import EDGE_AREA_KINDS
from beltrami.operators.integrals import integrate
from meshes_of_the_errata import MESHES

WAYS = [("vertex", k) for k in AREA_KINDS] + [("edge", k) for k in EDGE_AREA_KINDS]


def _slope(errors):
    sizes = 2.0 ** -np.arange(len(errors))
    return np.polyfit(np.log(sizes), np.log(np.abs(errors)), 1)[0]


@pytest.mark.chapter("U14", "P21")
@pytest.mark.parametrize(("how", "areas"), WAYS)
@pytest.mark.parametrize("name", ["open", "bad"])
def test_on_the_square(name, how, areas):
    """Delaunay or not, obtuse or not: each face of an irregular mesh is cut in four."""
    exact = (np.e - 1) * np.sin(1)
    smooth = lambda x: np.exp(x[:, 0]) * np.cos(x[:, 1])  # noqa: E731
    meshes = [subdivide(MESHES[name](), steps) for steps in (1, 2, 3)]
    errors = [integrate(mesh, smooth, how, areas) - exact for mesh in meshes]
    assert _slope(errors) == pytest.approx(2, abs=0.3)
    twice = [2 * integrate(mesh, smooth, how, areas) - exact for mesh in meshes]
    assert abs(_slope(twice)) < 0.05  # theorem 3 as printed converges to twice as much (E24)


@pytest.mark.chapter("U14")
@pytest.mark.parametrize(("how", "areas"), WAYS)
def test_on_the_sphere(how, areas):
    """∫z² = 4π/3, at the middles of chords inside the sphere."""
    errors = []
    for s in (2, 3, 4):
        mesh = icosphere(s)
        errors.append(integrate(mesh, lambda x: x[:, 2] ** 2, how, areas) - 4 * np.pi / 3)
    assert _slope(errors) == pytest.approx(2, abs=0.1)
