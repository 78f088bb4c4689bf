import numpy as np
import pytest

from beltrami.errors import DimensionError, MeshError, NonFiniteError, UnknownNameError
from beltrami.operators.laplacian import laplacian
from beltrami.operators.neighbours import GRAPH_WEIGHTS, knn_graph
from beltrami.operators.point_cloud import PointCloud
from meshes_of_the_errata import MESHES

pytestmark = pytest.mark.chapter("P4", "P7", "X3")


def _dense(points, k, weights, scale, join):
    """By sorting all distances."""
    n = len(points)
    distance = np.linalg.norm(points[:, None] - points, axis=2)
    near = np.zeros((n, n), bool)
    for i in range(n):
        others = np.delete(np.arange(n), i)
        near[i, others[np.argsort(distance[i, others])[:k]]] = True
    near = near | near.T if join == "either" else near & near.T
    scale = distance[near].mean() if scale is None else scale
    with np.errstate(divide="ignore"):
        values = {
            "combinatorial": np.ones((n, n)),
            "distance": 1 / distance**2,
            "gaussian": np.exp(-(distance**2) / (2 * scale**2)),
        }[weights]
    return np.where(near, values, 0)


@pytest.mark.parametrize("join", ["either", "both"])
@pytest.mark.parametrize("weights", GRAPH_WEIGHTS)
@pytest.mark.parametrize(("d", "k"), [(1, 1), (2, 4), (3, 7), (6, 3), (3, 39)])
def test_against_all_distances(weights, join, d, k):
    points = np.random.default_rng(9).normal(size=(40, d))
    for scale in (None, 0.5) if weights == "gaussian" else (None,):
        W = knn_graph(points, k, weights, scale=scale, join=join)
        assert np.allclose(W.toarray(), _dense(points, k, weights, scale, join), rtol=1e-12)
        assert W.has_sorted_indices


def test_a_pair_of_it():
    W = knn_graph(MESHES["closed"]().vertices, 6, "gaussian")
    pair = laplacian(W)
    assert (pair.weight_kind, pair.mass_kind) == ("given", "degree")
    assert pair.properties.maximum_principle
    assert np.abs(pair.stiffness @ np.ones(pair.n)).max() < 1e-14


def test_points_that_coincide():
    points = np.repeat(np.random.default_rng(1).normal(size=(3, 2)), 4, axis=0)
    for k in (1, 2, 3, 7):
        W = knn_graph(points, k)
        assert not W.diagonal().any()
        assert (np.diff(W.indptr) >= k).all()
    with pytest.raises(MeshError, match="coincide") as caught:
        knn_graph(points, 3, "distance")
    i, j = caught.value.edges.T
    assert (points[i] == points[j]).all()
    with pytest.raises(MeshError, match="positive length"):
        knn_graph(points, 3, "gaussian")  # all edges have length 0, and so has their mean
    assert knn_graph(points, 3, "gaussian", scale=1.0).data.min() == 1


def test_mutual_neighbours_may_leave_a_point_alone():
    points = [[0.0], [1.0], [3.0], [10.0]]
    with pytest.raises(MeshError, match="no positive degree") as caught:
        laplacian(knn_graph(points, 1, join="both"))
    assert caught.value.vertices.tolist() == [2, 3]


def test_what_is_refused():
    points = np.random.default_rng(2).normal(size=(6, 3))
    for k in (0, 6, -1, 2.5, np.nan):
        with pytest.raises(MeshError, match=r"1\.\.5"):
            knn_graph(points, k)
    for wrong in (np.zeros(5), np.zeros((0, 3)), np.zeros((2, 2, 2)), [[1], [2, 3]]):
        with pytest.raises(DimensionError):
            knn_graph(wrong, 1)
    points[[1, 4], 2] = np.nan, np.inf
    with pytest.raises(NonFiniteError) as caught:
        knn_graph(points, 2)
    assert caught.value.vertices.tolist() == [1, 4]
    good = np.random.default_rng(2).normal(size=(6, 3))
    with pytest.raises(UnknownNameError, match="Did you mean 'gaussian'"):
        knn_graph(good, 2, "gauss")
    with pytest.raises(UnknownNameError) as name:
        knn_graph(good, 2, join="any")
    assert name.value.choices == ("either", "both")
    for scale in (0, -1.0, np.inf, np.nan):
        with pytest.raises(MeshError, match="positive length"):
            knn_graph(good, 2, "gaussian", scale=scale)
    with pytest.raises(MeshError, match="only gaussian"):
        knn_graph(good, 2, scale=1.0)


@pytest.mark.parametrize("k", ["2", None, [2], 2.5, np.nan, 0, 42])
def test_a_number_of_neighbours_is_an_integer(k):
    points = np.random.default_rng(0).normal(size=(42, 3))
    for make in (knn_graph, PointCloud):
        with pytest.raises(MeshError, match="neighbours among 42 points"):
            make(points, k)
    assert PointCloud(points, 2.0).n_neighbors == 2


def test_distances_whose_squares_are_no_numbers():
    points = np.random.default_rng(0).normal(size=(20, 3))
    for unit in (1e-200, 1e155, 1e300):
        with pytest.raises(MeshError, match="Choose another unit"):
            knn_graph(points * unit, 3)
    near = np.array([[0.0, 0], [1, 0], [1, 1e-160]])
    with pytest.raises(MeshError, match="coincide") as caught:
        knn_graph(near, 1, "distance")
    assert caught.value.edges.tolist() == [[1, 2]]
    assert (knn_graph(points, 3, "gaussian", scale=1e-300).data == 0).all()
    with pytest.raises(MeshError, match="positive length"):
        knn_graph(points, 3, "gaussian", scale="wide")
