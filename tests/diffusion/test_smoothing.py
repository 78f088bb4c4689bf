import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import csr_array

import dense_oracles as oracle
from beltrami.diffusion.smoothing import smooth
from beltrami.errors import (
    BeltramiError,
    DimensionError,
    MeshError,
    NegativeWeightError,
    NonFiniteError,
    StepTooLongError,
)
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import IRREGULAR, MESHES, flipped

KINDS = {  # a mesh with no negative weight of that kind
    "combinatorial": "bad",
    "distance": "bad",
    "cotangent": "closed",
}


def _step_matrix(W, step, held):
    n = len(W)
    S = (1 - step) * np.eye(n) + step * W / W.sum(axis=1)[:, None]
    S[held] = np.eye(n)[held]
    return S


@pytest.mark.chapter("R4", "P19")
@pytest.mark.parametrize("weights", KINDS)
@pytest.mark.parametrize("columns", [None, 0, 1, 2, 3, 4, 7])
@pytest.mark.parametrize("step", [1.0, 0.37])
def test_against_powers_of_the_matrix(weights, columns, step):
    mesh = MESHES[KINDS[weights]]()
    n = mesh.n_vertices
    W = oracle.weights(mesh, weights)
    rng = np.random.default_rng(137035999)
    f = rng.normal(size=n if columns is None else (n, columns))
    mask = rng.uniform(size=n) < 0.2
    pair = laplacian(mesh, weights)
    for held in (np.zeros(n, bool), mask):
        S = _step_matrix(W, step, held)
        expected = f
        for steps in range(42):
            if steps in (0, 1, 2, 19, 20, 21, 40, 41):  # 20 rounds pass between two looks
                result = smooth(pair, f, steps, step, hold=held)
                assert result.shape == f.shape
                assert np.allclose(result, expected, rtol=1e-9, atol=1e-12)
                assert np.array_equal(result[held], f[held])
            expected = S @ expected


@pytest.mark.parametrize("columns", [1, 3])
def test_a_graph_with_a_hub_and_with_lonely_vertices(columns):
    n = 120
    A = np.zeros((n, n))
    A[0, 1:100] = A[1:100, 0] = 1
    A[101, 102] = A[102, 101] = 1
    pair = laplacian(csr_array(A), "combinatorial", "unit")
    f = np.random.default_rng(667430).normal(size=(n, columns))
    expected = f.copy()
    linked = A.sum(axis=1) > 0
    S = A[linked] / A[linked].sum(axis=1)[:, None]
    for _ in range(5):
        expected[linked] = 0.4 * expected[linked] + 0.6 * (S @ expected)
    assert np.allclose(smooth(pair, f, 5, 0.6), expected, rtol=1e-12, atol=1e-14)


def test_held_vertices_as_indices_or_as_a_mask():
    mesh = MESHES["open"]()
    pair = laplacian(mesh, "combinatorial")
    mask = np.zeros(mesh.n_vertices, bool)
    mask[[3, 50, 7]] = True
    f = oracle.rough_functions(mesh, 3)
    expected = smooth(pair, f, 7, hold=mask)
    assert np.array_equal(smooth(pair, f, 7, hold=[7, 3, 50, 3]), expected)
    with pytest.raises(MeshError, match="held vertices outside") as caught:
        smooth(pair, f, 7, hold=[3, 192, -1])
    assert caught.value.vertices.tolist() == [192, -1]
    with pytest.raises(MeshError, match="held vertices must be"):
        smooth(pair, f, 7, hold=[0.5])
    with pytest.raises(MeshError, match="held vertices"):
        smooth(pair, f, 7, hold=mask[:-1])


@pytest.mark.parametrize("name", IRREGULAR)
def test_the_weighted_mean_is_kept_and_the_range_not_left(name):
    mesh = MESHES[name]()
    f = oracle.rough_functions(mesh, 2)
    for weights in ("combinatorial", "distance"):
        pair = laplacian(mesh, weights, "degree")
        result = smooth(pair, f, 25, 0.9)
        assert np.allclose(pair.mean(result), pair.mean(f), atol=1e-12)
        assert abs(result.mean() - f.mean()) > 1e-4  # the plain mean is not
        assert (result.max(axis=0) < f.max(axis=0)).all()
        assert (result.min(axis=0) > f.min(axis=0)).all()
        assert pair.dirichlet_energy(result) < pair.dirichlet_energy(f)


@pytest.mark.chapter("D9")
@settings(deadline=None, max_examples=25)
@given(st.integers(0, 2**40), st.floats(0, 1), st.integers(0, 30))
def test_maximum_principle(seed, step, steps):
    mesh = flipped(seed, n=15, aspect=0.3)
    f = np.random.default_rng(seed).normal(size=mesh.n_vertices)
    g = smooth(laplacian(mesh, "distance"), f, steps, step)
    assert f.min() - 1e-12 <= g.min()
    assert g.max() <= f.max() + 1e-12


def test_the_mass_of_the_pair_is_not_used():
    mesh = MESHES["bad"]()
    f = oracle.rough_functions(mesh, 3)
    results = [
        smooth(laplacian(mesh, "distance", mass), f, 9)
        for mass in ("degree", "voronoi", "consistent", "unit")
    ]
    for result in results[1:]:
        assert np.array_equal(result, results[0])


def test_columns_do_not_mix_and_the_input_is_not_changed():
    mesh = MESHES["bad"]()
    pair = laplacian(mesh, "combinatorial")
    f = oracle.rough_functions(mesh, 7)
    before = f.copy()
    together = smooth(pair, f, 21)
    for c in range(7):
        assert np.allclose(together[:, c], smooth(pair, f[:, c], 21), rtol=1e-13, atol=1e-15)
    assert np.allclose(together[:, :3], smooth(pair, f[:, :3], 21), rtol=1e-12, atol=1e-14)
    assert np.array_equal(f, before)
    assert smooth(pair, f, 0) is not f
    assert smooth(pair, f[:, 0] > 0, 1).dtype == np.float64


@pytest.mark.parametrize("name", ["obt", "open", "bad", "cur"])
def test_negative_weights_are_refused_by_name(name):
    mesh = MESHES[name]()
    W = oracle.weights(mesh, "cotangent")[tuple(mesh.edges.T)]
    with pytest.raises(NegativeWeightError, match="combinatorial") as caught:
        smooth(laplacian(mesh), mesh.vertices, 1)
    assert np.array_equal(caught.value.edges, mesh.edges[W < 0])


def test_steps_beyond_the_bound():
    tetrahedron = laplacian(csr_array(1.0 - np.eye(4)), mass="unit")
    f = np.array([1.0, -1, 0, 0])
    assert np.abs(smooth(tetrahedron, f, 400, 1.0)).max() < 1
    with pytest.raises(StepTooLongError) as caught:
        smooth(tetrahedron, f, 5, 1.01)  # of the graph, only λ <= 2 is known
    assert caught.value.longest == pytest.approx(1)
    mesh = MESHES["bad"]()
    pair = laplacian(mesh, "combinatorial")
    longest = 2 / pair.spectral_bound()
    assert 1 < longest < 2
    noise = oracle.rough_functions(mesh, 1)
    assert np.abs(smooth(pair, noise, 2000, longest)).max() < 20
    with pytest.raises(StepTooLongError) as beyond:
        smooth(pair, noise, 1, longest * 1.001)
    assert (beyond.value.step, beyond.value.longest) == (longest * 1.001, longest)


def test_what_is_refused():
    pair = laplacian(MESHES["open"]().topology)
    f = np.zeros(192)
    for steps, step in ((-1, 1.0), (1, -0.1), (1, np.nan)):
        with pytest.raises(BeltramiError, match=r"steps? must be"):
            smooth(pair, f, steps, step)
    with pytest.raises(StepTooLongError):
        smooth(pair, f, 1, np.inf)
    with pytest.raises(DimensionError, match=r"\(192,\)"):
        smooth(pair, f[1:], 1)
    with pytest.raises(NonFiniteError) as caught:
        smooth(pair, np.where(np.arange(192) == 17, np.nan, f), 1)
    assert caught.value.vertices.tolist() == [17]


def test_progress_is_told_every_twenty_rounds():
    pair = laplacian(MESHES["open"]().topology)
    seen = []
    smooth(pair, np.zeros(192), 45, progress=lambda done, total: seen.append((done, total)))
    assert seen == [(20, 45), (40, 45), (45, 45)]


def test_an_edge_of_weight_zero_gives_no_nan():
    """A vertex whose only edge has the weight zero has nothing to average with."""
    W = csr_array((np.array([0.0, 0.0, 1.0, 1.0]), ([0, 1, 1, 2], [1, 0, 2, 1])), shape=(3, 3))
    pair = laplacian(W, mass="unit")
    assert smooth(pair, [5.0, 1, 3], 1).tolist() == [5, 3, 1]


@pytest.mark.parametrize("steps", [2.5, "3"])
def test_a_number_of_steps_is_whole(steps):
    pair = laplacian(MESHES["open"]().topology)
    with pytest.raises((BeltramiError, TypeError)):
        smooth(pair, np.zeros(192), steps)
    assert smooth(pair, np.zeros(192), np.int64(3)).shape == (192,)
