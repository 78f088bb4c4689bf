"""convolve: the two methods against the matrix, and when each is taken."""

import time

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes

import beltrami as bt
from beltrami.errors import BeltramiError, DimensionError, NonFiniteError, UnknownNameError
from beltrami.grids import convolution
from beltrami.grids.convolution import cheaper_method, convolve, convolve_repeatedly, symbol
from beltrami.grids.grid import Grid
from beltrami.grids.transform import dft
from beltrami.grids.transform_cost import transform_cost


def matrix_of(w):
    """W(i, k) = w(i - k) modulo p, row by row."""
    points = list(np.ndindex(w.shape))
    rows = [[w[tuple(np.subtract(i, k) % w.shape)] for k in points] for i in points]
    return np.array(rows)


@st.composite
def pairs(draw):
    shape = draw(array_shapes(min_dims=1, max_dims=3, max_side=5))
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    f, w = rng.normal(size=(2, *shape))
    if draw(st.booleans()):
        w = w * (rng.random(shape) < 0.3)
    if draw(st.booleans()):
        w = w + 1j * rng.normal(size=shape)
    if draw(st.booleans()):
        f = f + 1j * rng.normal(size=shape)
    return f, w


@pytest.mark.chapter("U16", "P25", "P26", "P28", "T4")
@given(pairs(), st.integers(0, 4))
def test_convolution_is_the_product_with_the_matrix(pair, k):
    f, w = pair
    W = matrix_of(w)
    expected = (W @ f.ravel()).reshape(f.shape)
    for method in ("direct", "fft", "auto"):
        found = convolve(f, w, method)
        assert np.abs(found - expected).max() < 1e-12
        assert np.iscomplexobj(found) == (np.iscomplexobj(f) or np.iscomplexobj(w))
    power = (np.linalg.matrix_power(W, k) @ f.ravel()).reshape(f.shape)
    size = np.linalg.norm(f) * (1 + np.abs(w).sum()) ** k
    assert np.abs(convolve_repeatedly(f, w, k) - power).max() < 1e-13 * size
    there = [convolve(mode.reshape(f.shape), w).ravel() for mode in np.eye(f.size)]
    assert np.abs(np.stack(there, axis=1) - W).max() < 1e-12
    waves = np.stack([dft(row.reshape(f.shape)).ravel() for row in np.eye(f.size)], axis=1)
    diagonal = waves @ W @ waves.conj().T
    assert np.abs(diagonal - np.diag(symbol(w).ravel())).max() < 1e-11


@pytest.mark.chapter("P28")
def test_the_cheaper_method_is_taken(monkeypatch):
    taken = []
    for name in ("_direct", "_by_fft"):
        real = getattr(convolution, name)
        spy = lambda *args, name=name, real=real: taken.append(name) or real(*args)  # noqa: E731
        monkeypatch.setattr(convolution, name, spy)
    grid = Grid((64, 64))
    f = np.random.default_rng(7).normal(size=grid.shape)
    convolve(f, grid.laplacian_kernel())
    convolve(f, f)
    assert taken == ["_direct", "_by_fft"]
    assert cheaper_method((1024, 1024), 11) == "direct"
    assert cheaper_method((1024, 1024), 12) == "fft"
    assert cheaper_method((4, 4), 3) == "fft"  # calls cost more than moving what there is


@pytest.mark.chapter("P28")
@pytest.mark.parametrize(
    ("shape", "passes"),
    [((1,), 0), ((2,), 2), ((64,), 12), ((30, 30), 20), ((7, 11), 19.8), ((2**13,), 65)],
)
def test_transforms_cost_the_sum_of_the_prime_factors(shape, passes):
    assert transform_cost(shape) == pytest.approx(passes)


def test_large_prime_factors_cost_a_detour_of_twice_the_length():
    assert transform_cost((61,)) == pytest.approx(67.1)  # 1.1 times 61: no detour
    assert transform_cost((1021,)) < 1021 / 4
    assert transform_cost((1021,)) > 4 * transform_cost((1024,))
    assert transform_cost((1021, 8)) == transform_cost((8, 1021))


@pytest.mark.chapter("P28")
def test_the_cheaper_method_is_the_faster_one_far_from_the_crossover():
    """Ratios of 3 and more are expected; only their direction is asked for."""

    def fastest(f, w, method):
        spans = []
        for _ in range(5):
            start = time.perf_counter()
            convolve(f, w, method)
            spans.append(time.perf_counter() - start)
        return min(spans)

    grid = Grid((1021, 1021))  # primes
    f = np.random.default_rng(8).normal(size=grid.shape)
    stencil = grid.laplacian_kernel()
    assert fastest(f, stencil, "direct") < fastest(f, stencil, "fft")
    f = f[:32, :32]
    assert fastest(f, f, "fft") < fastest(f, f, "direct")


def test_bad_input():
    with pytest.raises(DimensionError, match=r"\(3,\), and the function \(4,\)"):
        convolve(np.ones(4), np.ones(3))
    with pytest.raises(DimensionError):
        convolve(np.ones(4), np.ones((4, 1)))
    with pytest.raises(UnknownNameError):
        convolve([1.0], [1.0], "FFT")
    with pytest.raises(NonFiniteError, match="kernel"):
        convolve([1.0, 2.0], [np.nan, 1.0])
    for method in ("direct", "fft"):
        with pytest.raises(NonFiniteError, match="scale it down"):
            convolve(np.full(4, 1e200), np.full(4, 1e200), method)
    for times in (-1, 2.5, True, np.nan, "2"):
        with pytest.raises(BeltramiError, match="whole number"):
            convolve_repeatedly([1.0], [1.0], times)
    assert bt.convolve is convolve


@pytest.mark.chapter("U16", "X4")
def test_stencils_are_written_around_zero():
    assert Grid(5).kernel([1, 2, 4]).tolist() == [2, 4, 0, 0, 1]
    assert Grid(2).kernel([1, 2, 4]).tolist() == [2, 5]
    assert Grid(1).kernel([1, 2, 4]).tolist() == [7]
    assert Grid(3).kernel([1, 2, 4, 8, 16]).tolist() == [4, 8 + 1, 2 + 16]
    square = Grid((3, 4)).kernel([[0, 1, 0], [2, 3, 4], [0, 5, 0]])
    assert square.tolist() == [[3, 4, 0, 2], [5, 0, 0, 0], [1, 0, 0, 0]]
    assert Grid(3).kernel([0, 1j, 0]).tolist() == [1j, 0, 0]


def test_stencils_that_have_no_place():
    with pytest.raises(DimensionError, match="no middle"):
        Grid(5).kernel([1, 2])
    with pytest.raises(DimensionError, match="2 axes"):
        Grid((5, 5)).kernel([1, 2, 1])
    for make in (Grid.averaging_kernel, Grid.laplacian_kernel, lambda g: g.kernel([[1]])):
        with pytest.raises(BeltramiError, match=r"axes \[1\] have ends"):
            make(Grid((4, 5), (True, False)))


@pytest.mark.chapter("U21", "U24", "X4")
@pytest.mark.parametrize("shape", [(1, 4), (2, 3), (2, 2), (3,), (5, 6), (1, 2, 3), (3, 3, 3)])
@pytest.mark.parametrize("kind", ["combinatorial", "distance", "dirichlet"])
def test_kernels_are_first_columns_of_the_matrices(shape, kind):
    grid = Grid(shape, spacing=[0.5, 2.0, 3.0][: len(shape)])
    pair = grid.make_laplacian(kind)
    columns = {"averaging": pair.averaging, "laplacian": pair.stiffness}
    for name, matrix in columns.items():
        kernel = getattr(grid, f"{name}_kernel")(kind)
        assert np.allclose(kernel.ravel(), matrix[:, [0]].toarray().ravel(), rtol=1e-14)
        f = np.random.default_rng(9).normal(size=grid.n_vertices)
        assert np.allclose(convolve(f.reshape(shape), kernel).ravel(), matrix @ f, atol=1e-12)


@pytest.mark.parametrize("shape", [(1,), (2,), (7,), (8,), (5, 4), (1, 6), (3, 4, 5)])
@pytest.mark.parametrize("complex_kernel", [False, True])
def test_shifts_of_any_length_go_round(shape, complex_kernel):
    """Dense kernels, so that every shift from 0 to p - 1 is made along each axis."""
    rng = np.random.default_rng(16)
    f, w = rng.normal(size=(2, *shape))
    w = w * (1 + 2j) if complex_kernel else w
    wanted = sum(w[k] * np.roll(f, k, range(f.ndim)) for k in np.ndindex(shape))
    np.testing.assert_allclose(convolve(f, w, "direct"), wanted, rtol=1e-12, atol=1e-12)
    one = np.where(np.arange(f.size).reshape(shape) == f.size - 1, w, 0)  # a kernel of one value
    last = tuple(p - 1 for p in shape)
    wanted = w[last] * np.roll(f, last, range(f.ndim))
    assert np.array_equal(convolve(f, one, "direct"), wanted)
    assert not convolve(f, 0 * w, "direct").any()
