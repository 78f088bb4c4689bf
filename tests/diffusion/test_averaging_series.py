"""Series of averages: against dense matrices, and several at once against one by one."""

import numpy as np
import pytest
from numpy.polynomial.chebyshev import chebval

from beltrami.diffusion.averaging_series import filter_rows, filter_rows_by
from beltrami.diffusion.linear_filters import equal_rows
from beltrami.mesh import shapes
from beltrami.mesh.mesh import Mesh

LENGTHS = (1, 2, 3, 4, 21, 22, 23, 42, 45)


def sphere_and_stray():
    sphere = shapes.icosphere(2)
    return Mesh(np.concatenate([sphere.vertices, [[3.0, 4, 5]]]), sphere.faces)


@pytest.mark.parametrize("d", [1, 3, 4])
@pytest.mark.parametrize("order", [1, -1])
def test_several_series_are_the_polynomials(d, order):
    mesh = sphere_and_stray()
    A = mesh.topology.adjacency.toarray()
    A[-1, -1] = 1  # a vertex without neighbours keeps its value
    W = A / A.sum(axis=1, keepdims=True)
    values, vectors = np.linalg.eig(W)
    random = np.random.default_rng(1)
    x = random.standard_normal((mesh.n_vertices, d))
    series = [random.standard_normal(k) for k in LENGTHS][::order]
    rows = equal_rows(mesh)
    for c, found in zip(series, filter_rows_by(rows, x, series), strict=True):
        expected = (vectors * chebval(values, c)) @ np.linalg.solve(vectors, x)
        assert found == pytest.approx(expected.real, abs=1e-9)
        assert np.array_equal(found, filter_rows(rows, x, c))


def test_values_of_more_than_one_block():
    """Those are added block by block."""
    mesh = shapes.grid(40, 30, dimension=3)
    A = mesh.topology.adjacency
    x = np.random.default_rng(2).standard_normal((mesh.n_vertices, 3))
    W = A.toarray() / A.sum(axis=1)[:, None]
    expected = 2 * x + 3 * (W @ x) + 5 * (2 * W @ (W @ x) - x)
    short, long = filter_rows_by(equal_rows(mesh), x, [np.ones(2), np.array([2.0, 3.0, 5.0])])
    assert long == pytest.approx(expected, abs=1e-12)
    assert short == pytest.approx(x + W @ x, abs=1e-12)


def test_progress_is_told():
    mesh, told = shapes.icosphere(1), []
    filter_rows(equal_rows(mesh), mesh.vertices, np.ones(47), lambda *at: told.append(at))
    assert told == [(20, 45), (40, 45), (45, 45)]
