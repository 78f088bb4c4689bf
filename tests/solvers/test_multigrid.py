"""Smoothed aggregation by pyamg as a preconditioner."""

import sys

import numpy as np
import pytest

from beltrami.errors import MissingExtraError
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import icosphere
from beltrami.operators.laplacian import laplacian
from beltrami.solvers.conjugate_gradients import conjugate_gradients
from beltrami.solvers.minres import minres
from definite_matrices import grid, path
from meshes_of_the_errata import MESHES


def _relative(A, x, b):
    return np.linalg.norm(b - A @ x) / np.linalg.norm(b)


def test_its_iterations_hardly_grow():
    pytest.importorskip("pyamg")
    jacobi, multigrid = [], []
    for level in (3, 5):
        pair = laplacian(icosphere(level))
        b = pair.stiffness @ np.random.default_rng(level).normal(size=pair.n)
        jacobi.append(conjugate_gradients(pair.stiffness, b).iterations)
        multigrid.append(
            conjugate_gradients(pair.stiffness, b, preconditioner="multigrid").iterations
        )
    assert jacobi[1] > 2.5 * jacobi[0]
    assert multigrid[1] < 1.7 * multigrid[0]
    assert multigrid[1] < 25


@pytest.mark.parametrize("solve", [conjugate_gradients, minres])
@pytest.mark.parametrize("name", ["closed", "obt", "open", "bad"])
def test_singular_and_irregular(solve, name):
    pytest.importorskip("pyamg")
    L = laplacian(MESHES[name]()).stiffness
    b = L @ np.random.default_rng(137).normal(size=L.shape[0])
    found = solve(L, b, preconditioner="multigrid")
    assert found.preconditioner == "multigrid"
    assert _relative(L, found.solution, b) <= 1.001e-10
    assert abs(found.solution.mean()) < 1e-13


def test_several_components_units_and_a_kernel_of_ones():
    pytest.importorskip("pyamg")
    one = icosphere(2)
    mesh = Mesh(
        np.concatenate([1e-6 * one.vertices, 1e6 * one.vertices + 5e6]),
        np.concatenate([one.faces, one.faces + one.n_vertices]),
    )
    pair = laplacian(mesh)
    f = np.random.default_rng(5).normal(size=pair.n)
    for matrix in (pair.stiffness, pair.stiffness * 1e-100):
        found = conjugate_gradients(matrix, matrix @ f, preconditioner="multigrid")
        halves = found.solution.reshape(2, -1)
        expected = f.reshape(2, -1) - f.reshape(2, -1).mean(axis=1, keepdims=True)
        assert np.allclose(halves, expected, atol=1e-7)
    told = conjugate_gradients(
        laplacian(one).stiffness,
        laplacian(one).stiffness @ f[: one.n_vertices],
        preconditioner="multigrid",
        kernel=np.ones(one.n_vertices),
    )
    assert told.iterations < 20


def test_the_same_bits_and_the_random_numbers_of_others_stay():
    pytest.importorskip("pyamg")
    A, b = grid(40, 30), np.ones(1200)
    results = []
    for seed in (1, 2):
        np.random.seed(seed)  # noqa: NPY002
        expected = np.random.random(3)  # noqa: NPY002
        np.random.seed(seed)  # noqa: NPY002
        results.append(conjugate_gradients(A, b, preconditioner="multigrid").solution)
        assert np.array_equal(np.random.random(3), expected)  # noqa: NPY002
    assert results[0].tobytes() == results[1].tobytes()


def test_without_pyamg(monkeypatch):
    monkeypatch.setitem(sys.modules, "pyamg", None)
    with pytest.raises(MissingExtraError, match=r"beltrami\[fast\]"):
        conjugate_gradients(path(5), np.ones(5), preconditioner="multigrid")
