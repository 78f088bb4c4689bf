"""Differences on grids: slopes under refinement (U22, U25, P24, P31)."""

import numpy as np
import pytest

from beltrami.grids.circle import decay_exponent
from beltrami.grids.grid import Grid

SIZES = (32, 64, 128)


def order(error):
    return -decay_exponent(SIZES, [error(p) for p in SIZES])


def phases(grid):
    return 2 * np.pi * grid.coordinates.T


@pytest.mark.chapter("U21", "U22", "P36")
def test_the_second_derivative_on_the_circle():
    def error(p, sign=1):
        grid = Grid(p)
        (x,) = phases(grid)
        f = np.exp(np.sin(x))
        exact = -4 * np.pi**2 * (np.cos(x) ** 2 - np.sin(x)) * f
        Lf = grid.make_laplacian("distance", "unit").apply(f)
        return np.abs(Lf - sign * exact).max()

    assert order(error) == pytest.approx(2, abs=0.05)
    assert order(lambda p: error(p, -1)) == pytest.approx(0, abs=0.05)


@pytest.mark.chapter("U24", "U25")
@pytest.mark.parametrize(("weights", "mass"), [("distance", "unit"), ("dirichlet", "voronoi")])
def test_the_laplacian_on_the_torus(weights, mass):
    def error(p):
        grid = Grid((p, 3 * p // 2), spacing=(1 / p, 2 / (3 * p)))
        x, y = phases(grid)
        f = np.sin(x) * np.sin(y)
        return np.abs(grid.make_laplacian(weights, mass).apply(f) - 8 * np.pi**2 * f).max()

    assert order(error) == pytest.approx(2, abs=0.02)


def test_between_ends_nothing_flows_out():
    """The points are the middles of cells: cosines of the interval are eigenfunctions."""

    def error(p):
        grid = Grid((p, 3 * p // 2), (False, True), (3 / p, 4 / (3 * p)))
        x, y = grid.coordinates.T
        f = np.exp(np.cos(np.pi * x / 3)) * np.cos(np.pi * y)
        c, s = np.cos(np.pi * x / 3), np.sin(np.pi * x / 3)
        exact = -(np.pi**2) * ((s**2 - c) / 9 - 1) * f
        return np.abs(grid.make_laplacian("dirichlet").apply(f) - exact).max()

    assert order(error) == pytest.approx(2, abs=0.05)


@pytest.mark.chapter("P24")
@pytest.mark.parametrize("mass", ["unit", "voronoi"])
def test_the_first_eigenvalue(mass):
    kind = "distance" if mass == "unit" else "dirichlet"
    first = lambda p, h: np.sort(Grid(p, spacing=h).eigenvalues(kind, mass))[1]  # noqa: E731
    right = order(lambda p: abs(first(p, 1 / p) - 4 * np.pi**2))
    assert right == pytest.approx(2, abs=0.01)
    both_ends = order(lambda p: abs(first(p, 1 / (p - 1)) - 4 * np.pi**2))
    assert both_ends == pytest.approx(1, abs=0.1)  # E31


@pytest.mark.chapter("P31", "P37")
@pytest.mark.parametrize(("scheme", "rate"), [("forward", 1), ("backward", 1), ("centered", 2)])
def test_gradient_and_divergence(scheme, rate):
    def errors(p):
        grid = Grid((p, p + 7))
        x, y = phases(grid)
        f = np.exp(np.sin(x)) * np.cos(y)
        G = grid.gradient(scheme) @ f
        exact = 2 * np.pi * np.concatenate([np.cos(x) * f, -np.exp(np.sin(x)) * np.sin(y)])
        v = np.concatenate([np.sin(x), np.cos(x + y)])
        div = 2 * np.pi * (np.cos(x) - np.sin(x + y))
        return np.abs(G - exact).max(), np.abs(grid.divergence(scheme) @ v - div).max()

    assert order(lambda p: errors(p)[0]) == pytest.approx(rate, abs=0.1)
    assert order(lambda p: errors(p)[1]) == pytest.approx(rate, abs=0.1)


@pytest.mark.chapter("U23")
def test_the_energy_of_dirichlet_weights():
    def error(p):
        grid = Grid((p, 2 * p), spacing=(1 / p, 1 / (2 * p)))
        x, y = phases(grid)
        energy = grid.make_laplacian("dirichlet").dirichlet_energy(np.sin(x) * np.cos(2 * y))
        return abs(energy - 5 * np.pi**2)

    assert order(error) == pytest.approx(2, abs=0.02)
