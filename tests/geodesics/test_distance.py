"""The door of geodesic_distance, and the paths of edges."""

import numpy as np
import pytest

from beltrami.errors import (
    BeltramiError,
    DegenerateFaceError,
    EmptyMeshError,
    MeshError,
    NonFiniteError,
    UnknownNameError,
    UnreferencedVertexError,
)
from beltrami.geodesics.distance import DISTANCE_METHODS, geodesic_distance
from beltrami.geodesics.heat_method import HeatMethod
from beltrami.mesh.mesh import Mesh
from meshes_of_the_errata import MESHES


@pytest.mark.parametrize("method", DISTANCE_METHODS)
def test_sources_are_one_vertex_several_or_a_mask(method):
    mesh = MESHES["closed"]()
    distance = lambda s: geodesic_distance(mesh, s, method=method)  # noqa: E731
    assert np.array_equal(distance(7), distance([7]))
    mask = np.zeros(300, bool)
    mask[[7, 90]] = True
    assert np.array_equal(distance(mask), distance(np.array([90, 7])))
    assert np.array_equal(distance([90, 7, 7]), distance(mask))
    assert distance(7).shape == (300,)
    assert distance(7)[7] == 0


@pytest.mark.parametrize("method", DISTANCE_METHODS)
def test_wrong_sources_are_named(method):
    mesh = MESHES["closed"]()
    for wrong, guilty in (([3, 300], [300]), ([-1, 4], [-1])):
        with pytest.raises(MeshError, match=r"sources outside 0\.\.299") as caught:
            geodesic_distance(mesh, wrong, method=method)
        assert caught.value.vertices.tolist() == guilty
    for none in ([], np.zeros(300, bool)):
        with pytest.raises(MeshError, match="at least one source"):
            geodesic_distance(mesh, none, method=method)
    with pytest.raises(MeshError, match="integers"):
        geodesic_distance(mesh, [0.5], method=method)


@pytest.mark.parametrize("method", DISTANCE_METHODS)
def test_defects_of_the_mesh_are_named(method):
    x = [[0, 0], [1, 0], [0, 1], [2, 0], [1, 1]]
    distance = lambda *mesh: geodesic_distance(Mesh(*mesh), 0, method=method)  # noqa: E731
    with pytest.raises(EmptyMeshError):
        distance(x, [])
    with pytest.raises(UnreferencedVertexError) as caught:
        distance(x, [[0, 1, 2]])
    assert caught.value.vertices.tolist() == [3, 4]
    with pytest.raises(DegenerateFaceError) as caught:
        distance(x, [[0, 1, 2], [0, 1, 3], [1, 4, 2]])
    assert caught.value.faces.tolist() == [1]
    with pytest.raises(NonFiniteError):
        distance([[0, 0], [1, 0], [np.nan, 1]], [[0, 1, 2]])


def test_options_belong_to_the_heat_method():
    mesh = MESHES["pl"]()
    for method in ("exact", "edges"):
        for option in ({"time": 1.0}, {"intrinsic": False}, {"boundary": "average"}):
            with pytest.raises(BeltramiError, match="belong to the heat method"):
                geodesic_distance(mesh, 0, method=method, **option)
    with pytest.raises(UnknownNameError, match="Did you mean 'exact'"):
        geodesic_distance(mesh, 0, method="exakt")


def test_heat_passes_its_options_on():
    mesh = MESHES["cur"]()
    options = {"time": 0.02, "intrinsic": False, "boundary": "average"}
    one = geodesic_distance(mesh, [3, 50], **options)
    assert np.array_equal(one, HeatMethod(mesh, **options).distance([3, 50]))
    for name in options:
        fewer = {key: value for key, value in options.items() if key != name}
        assert not np.allclose(geodesic_distance(mesh, [3, 50], **fewer), one, rtol=1e-3)


def test_edges_are_walked_along():
    mesh = MESHES["pl"]()  # diagonals go up to the right alone
    x, y = (mesh.vertices - mesh.vertices[0]).T
    d = geodesic_distance(mesh, 0, method="edges")
    assert np.allclose(d, np.sqrt(2) * np.minimum(x, y) + np.abs(x - y))
    both = geodesic_distance(mesh, [0, 55], method="edges")
    assert np.allclose(both, np.minimum(d, geodesic_distance(mesh, 55, method="edges")))
