import pickle

import numpy as np
import pytest

from beltrami.errors import (
    DimensionError,
    MeshError,
    MissingExtraError,
    NonFiniteError,
    UnknownNameError,
)
from beltrami.mesh.shapes import icosphere
from beltrami.operators import tufted
from beltrami.operators.laplacian import laplacian
from beltrami.operators.neighbours import GRAPH_WEIGHTS, knn_graph
from beltrami.operators.point_cloud import PointCloud

pytestmark = pytest.mark.chapter("P4", "P7")


@pytest.mark.parametrize("weights", [None, *GRAPH_WEIGHTS])
def test_the_graph_of_its_neighbours(weights):
    points = np.random.default_rng(4).normal(size=(60, 3))
    cloud = PointCloud(points, n_neighbors=7)
    pair = laplacian(cloud, weights)
    expected = laplacian(knn_graph(points, 7, weights or "combinatorial"))
    assert abs(pair.stiffness - expected.stiffness).max() == 0
    assert pair.weight_kind == (weights or "combinatorial")
    assert pair.mass_kind == "degree"
    assert laplacian(cloud, weights, "unit").masses.tolist() == [1] * 60
    told = pair.properties
    assert told.needs_positions is (pair.weight_kind != "combinatorial")
    assert not told.needs_faces
    assert told.spectral_bound == pytest.approx(2)


def test_an_object_like_the_others():
    points = icosphere(1).vertices.copy()
    cloud = PointCloud(points, 5)
    points[:] = 0
    assert np.array_equal(cloud.points, icosphere(1).vertices)
    assert not cloud.points.flags.writeable
    with pytest.raises(AttributeError, match="frozen"):
        cloud.n_neighbors = 3
    copy = pickle.loads(pickle.dumps(cloud))  # noqa: S301
    assert repr(copy) == repr(cloud) == "<PointCloud: 42 points in 3 coordinates, 5 neighbours>"
    assert PointCloud(icosphere(1).vertices).n_neighbors == 30


def test_what_is_refused():
    points = np.random.default_rng(4).normal(size=(10, 3))
    for k in (0, 10, 30, np.nan):
        with pytest.raises(MeshError, match=r"1\.\.9"):
            PointCloud(points, k)
    with pytest.raises(DimensionError):
        PointCloud(np.zeros(7), 3)
    with pytest.raises(NonFiniteError):
        PointCloud(points * np.nan, 3)
    cloud = PointCloud(points, 4)
    with pytest.raises(UnknownNameError) as weights:
        laplacian(cloud, "cotangent")
    assert weights.value.choices == ("combinatorial", "distance", "gaussian", "tufted")
    with pytest.raises(UnknownNameError) as mass:
        laplacian(cloud, mass="voronoi")
    assert mass.value.choices == ("degree", "unit")
    with pytest.raises(DimensionError, match="callable"):
        laplacian(cloud, lambda c: np.ones(3))
    twice = PointCloud(np.repeat(points, 2, axis=0), 4)
    with pytest.raises(MeshError, match="coincide") as caught:
        laplacian(twice, "tufted")
    assert caught.value.vertices.tolist() == list(range(20))


def test_without_the_extra(monkeypatch):
    missing = lambda *a: (_ for _ in ()).throw(MissingExtraError(*a))  # noqa: E731
    monkeypatch.setattr(tufted, "require", missing)
    cloud = PointCloud(np.random.default_rng(4).normal(size=(10, 3)), 4)
    with pytest.raises(MissingExtraError, match=r"pip install 'beltrami\[robust\]'") as caught:
        laplacian(cloud, "tufted")
    assert caught.value.extra == "robust"
    laplacian(cloud)  # the graph needs nothing
