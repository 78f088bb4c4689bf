import math

import numpy as np
import pytest

from beltrami.errors import DimensionError, MeshError, NonFiniteError, UnknownNameError
from beltrami.mesh.shapes import grid
from beltrami.operators.areas import AREA_KINDS, vertex_areas
from beltrami.operators.edge_areas import EDGE_AREA_KINDS, edge_areas
from beltrami.operators.integrals import integrate
from meshes_of_the_errata import MESHES, triangle

pytestmark = pytest.mark.chapter("U14")


def _ways():
    return [("vertex", k) for k in (None, *AREA_KINDS)] + [
        ("edge", k) for k in (None, *EDGE_AREA_KINDS)
    ]


@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize(("how", "areas"), _ways())
def test_of_one_it_is_the_area(name, how, areas):
    mesh = MESHES[name]()
    ones = np.ones(mesh.n_vertices)
    assert integrate(mesh, ones, how, areas) == pytest.approx(mesh.area, rel=1e-10)
    of_position = lambda x: np.ones((len(x), 2))  # noqa: E731
    assert integrate(mesh, of_position, how, areas) == pytest.approx([mesh.area] * 2, rel=1e-10)


@pytest.mark.parametrize("name", ["closed", "bad", "cur"])
def test_each_rule_against_its_sum(name):
    mesh = MESHES[name]()
    f = np.random.default_rng(5).normal(size=(mesh.n_vertices, 3))
    assert integrate(mesh, f) == pytest.approx(vertex_areas(mesh, "barycentric") @ f)
    assert isinstance(integrate(mesh, f[:, 0]), float)
    quadratic = lambda x: x[:, 0] ** 2 - x[:, 0] * x[:, 1]  # noqa: E731
    i, j = mesh.edges.T
    for kind in EDGE_AREA_KINDS:
        expected = edge_areas(mesh, kind) @ ((f[i] + f[j]) / 2)
        assert integrate(mesh, f, "edge", kind) == pytest.approx(expected)
        middle = (mesh.vertices[i] + mesh.vertices[j]) / 2
        at_middles = edge_areas(mesh, kind) @ quadratic(middle)
        assert integrate(mesh, quadratic, "edge", kind) == pytest.approx(at_middles)
    for kind in AREA_KINDS:
        expected = vertex_areas(mesh, kind) @ quadratic(mesh.vertices)
        assert integrate(mesh, quadratic, "vertex", kind) == pytest.approx(expected)


def test_edges_of_the_circumcentre_are_vertices_of_the_circumcentre():
    mesh = MESHES["bad"]()
    f = np.random.default_rng(6).normal(size=mesh.n_vertices)
    at_vertices = integrate(mesh, f, "vertex", "circumcentric")
    assert integrate(mesh, f, "edge") == pytest.approx(at_vertices, rel=1e-10)


def test_linear_functions():
    """∫x over the square is ½: barycentric areas are exact (E24)."""
    for name in ("open", "bad"):
        mesh = MESHES[name]()
        x = mesh.vertices[:, 0]
        assert integrate(mesh, x) == pytest.approx(0.5, abs=1e-13)
        assert integrate(mesh, x, "edge", "incenter") == pytest.approx(0.5, abs=5e-3)
        assert abs(integrate(mesh, x, "edge", "incenter") - 0.5) > 1e-6


def test_a_smooth_function_on_the_square():
    """E24: twice as much as printed (and four times, if each edge counts twice) would be wrong."""
    mesh = MESHES["open"]()
    exact = (np.e - 1) * np.sin(1)
    smooth = lambda x: np.exp(x[:, 0]) * np.cos(x[:, 1])  # noqa: E731
    for how, areas in _ways():
        assert integrate(mesh, smooth, how, areas) == pytest.approx(exact, rel=2e-3)
        values = smooth(mesh.vertices)
        assert integrate(mesh, values, how, areas) == pytest.approx(exact, rel=4e-3)


def test_errors():
    mesh = triangle(50, 60)
    with pytest.raises(UnknownNameError) as caught:
        integrate(mesh, np.ones(3), "face")
    assert caught.value.choices == ("vertex", "edge")
    with pytest.raises(UnknownNameError) as caught:  # areas of vertices are no areas of edges
        integrate(mesh, np.ones(3), "edge", "barycentric")
    assert caught.value.choices == EDGE_AREA_KINDS
    with pytest.raises(UnknownNameError):
        integrate(mesh, np.ones(3), "vertex", "incenter")
    for how in ("vertex", "edge"):
        with pytest.raises(DimensionError, match=r"\(3,\)"):
            integrate(mesh, np.ones(4), how)
        with pytest.raises(DimensionError, match="what the function returned"):
            integrate(mesh, lambda x: 1.0, how)
        with pytest.raises(NonFiniteError) as bad:
            integrate(mesh, [1, np.nan, 2], how)
        assert bad.value.vertices.tolist() == [1]
        with pytest.raises(NonFiniteError):
            integrate(mesh, lambda x: np.full(len(x), np.inf), how)


@pytest.mark.parametrize(
    "f", [lambda x, y: x, lambda x: math.exp(x[:, 0]), lambda x: 1.0 if x[0] > 0 else 0.0]
)
def test_a_function_of_single_positions_is_told_what_it_gets(f):
    mesh = grid(3, 3)
    for how in ("vertex", "edge"):
        with pytest.raises(MeshError, match=r"called with positions.*one array"):
            integrate(mesh, f, how)
