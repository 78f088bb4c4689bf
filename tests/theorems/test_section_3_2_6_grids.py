"""Section 3.2.6: Laplacians and gradients of grids in 1D and 2D (E41, E46, E47, E48)."""

import numpy as np
import pytest

from beltrami.grids.convolution import convolve
from beltrami.grids.grid import Grid


def wave(grid):
    return np.exp(np.sin(2 * np.pi * grid.coordinates[:, 0]))


def second_derivative(grid):
    x = 2 * np.pi * grid.coordinates[:, 0]
    return 4 * np.pi**2 * (np.cos(x) ** 2 - np.sin(x)) * np.exp(np.sin(x))


@pytest.mark.chapter("U21", "U22", "P36")
def test_the_kernel_is_minus_one_two_minus_one():
    """E47: with the printed (-1, 2, 1) constants do not vanish, and nothing converges."""
    grid = Grid(256)
    h = grid.spacing[0]
    assert np.array_equal(grid.laplacian_kernel("distance"), grid.kernel([-1, 2, -1]) / h**2)
    f, exact = wave(grid), -second_derivative(grid)
    L = grid.make_laplacian("distance", "unit").stiffness
    size = np.abs(exact).max()
    assert np.abs(L @ f - exact).max() / size < 3e-4
    assert np.abs(L @ f + exact).max() / size > 1.9  # L is minus the second derivative
    printed = grid.kernel([-1, 2, 1]) / h**2
    assert np.abs(convolve(f, printed) - exact).max() / size > 1000
    assert np.abs(convolve(np.ones(256), printed) * h**2).max() == pytest.approx(2)
    assert np.abs(L @ np.ones(256)).max() == 0
    assert f @ (L @ f) > 0


@pytest.mark.chapter("U24")
def test_the_five_point_kernel():
    grid = Grid((7, 10), spacing=0.1)
    five = grid.kernel([[0, -1, 0], [-1, 4, -1], [0, -1, 0]])
    assert np.allclose(grid.laplacian_kernel("distance"), five / 0.1**2, rtol=1e-14)
    f = np.random.default_rng(11).normal(size=grid.shape)
    L = grid.make_laplacian("distance").stiffness
    assert np.allclose(convolve(f, five / 0.01).ravel(), L @ f.ravel(), rtol=1e-12)


@pytest.mark.chapter("U21")
def test_the_weights_differ_by_the_square_of_the_step():
    """E46: L and G change, the averaging and the normalised Laplacian do not."""
    grid = Grid(256)
    h = grid.spacing[0]
    plain, scaled = (grid.make_laplacian(kind) for kind in ("combinatorial", "distance"))
    ratio = np.abs(plain.stiffness @ wave(grid)).max() / np.abs(second_derivative(grid)).max()
    assert ratio == pytest.approx(h**2, rel=1e-3) == 1.526e-05
    assert abs(plain.stiffness / h**2 - scaled.stiffness).max() == 0
    assert abs(plain.gradient / h - scaled.gradient).max() < 1e-12
    assert abs(plain.averaging - scaled.averaging).max() == 0
    assert abs(plain.normalized - scaled.normalized).max() < 1e-15


@pytest.mark.chapter("P31", "P37")
@pytest.mark.parametrize("scheme", ["forward", "backward"])
def test_the_transpose_is_minus_the_divergence(scheme):
    """E41: the numbers of the errata, n = 400."""
    grid = Grid(400)
    x = 2 * np.pi * grid.coordinates[:, 0]
    G = grid.gradient(scheme)
    middle = np.pi / 400 * (1 if scheme == "forward" else -1)  # between the two points
    v, slope = np.sin(x + middle), 2 * np.pi * np.cos(x)
    assert np.abs(G.T @ v - slope).max() == pytest.approx(12.57, abs=0.005)
    assert np.abs(-(G.T @ v) - slope).max() < 7e-5
    assert np.abs(grid.divergence(scheme) @ v - slope).max() < 7e-5
    f, exact = wave(grid), second_derivative(grid)
    twice = G.T @ (G @ f)
    size = np.abs(exact).max()
    assert np.abs(twice - exact).max() / size == pytest.approx(2, abs=0.001)
    assert np.abs(twice + exact).max() / size < 1e-4
    assert abs(G + G.T).max() * grid.spacing[0] == pytest.approx(2)  # not antisymmetric


@pytest.mark.chapter("P37")
def test_the_transpose_of_forward_is_minus_backward():
    grid = Grid((5, 4, 3), spacing=(0.5, 1.0, 0.3))
    n = grid.n_vertices
    schemes = ("forward", "backward", "centered")
    forward, backward, centered = (
        grid.gradient(scheme).toarray().reshape(3, n, n) for scheme in schemes
    )
    for a in range(3):
        assert np.array_equal(forward[a].T, -backward[a])
        assert np.array_equal(centered[a].T, -centered[a])
    assert np.allclose(centered, (forward + backward) / 2, rtol=1e-15)


@pytest.mark.chapter("U23", "P31")
def test_integration_by_parts():
    """E48: ∫f''g = -∫f'g', for integrals and, to rounding, for differences."""
    grid = Grid(512)
    x = 2 * np.pi * grid.coordinates[:, 0]
    f, g = np.exp(np.sin(x)), np.sin(x) + 0.3 * np.cos(2 * x)
    slope_f = 2 * np.pi * np.cos(x) * f
    slope_g = 2 * np.pi * (np.cos(x) - 0.6 * np.sin(2 * x))
    left = (second_derivative(grid) * g).mean()
    assert left == pytest.approx(-15.8807, abs=5e-5)
    assert -(slope_f * slope_g).mean() == pytest.approx(left, rel=1e-12)
    printed = -(-f * slope_g).mean()
    assert abs(printed - left) > 10
    pair = grid.make_laplacian("dirichlet")
    G = pair.gradient
    assert (pair.stiffness @ f) @ g == pytest.approx((G @ f) @ (G @ g), rel=1e-12)
    assert (pair.stiffness @ f) @ g == pytest.approx(-left, rel=1e-4)


@pytest.mark.chapter("P31", "U23")
@pytest.mark.parametrize("scheme", ["forward", "backward", "centered"])
@pytest.mark.parametrize("periodic", [True, False, (True, False)])
def test_gradient_and_divergence_are_adjoint(scheme, periodic):
    grid = Grid((6, 5), periodic, (0.3, 0.8))
    rng = np.random.default_rng(12)
    f, v = rng.normal(size=30), rng.normal(size=60)
    left, right = (grid.gradient(scheme) @ f) @ v, f @ (grid.divergence(scheme) @ v)
    assert left == pytest.approx(-right, rel=1e-12)
    L = -(grid.divergence(scheme) @ grid.gradient(scheme))
    same = abs(L - grid.make_laplacian("distance").stiffness).max() < 1e-12
    assert same == (scheme != "centered")
