"""The inner loops, against a line of numpy each."""

import numpy as np
import pytest
from scipy.sparse import csc_array

from beltrami.solvers.vectors import blend, descend, dot, multiply, recur, turn
from definite_matrices import NAMED


def _three(n, seed=20231):
    return np.random.default_rng(seed).normal(size=(5, n))


@pytest.mark.parametrize("count", [0, 1, 2, 3, 4])
@pytest.mark.parametrize("kind", [np.int32, np.int64])
def test_products(count, kind):
    A = csc_array(NAMED["scattered"]())
    A.indices, A.indptr = A.indices.astype(kind), A.indptr.astype(kind)
    p = np.random.default_rng(1).normal(size=(count, A.shape[0]))
    q = np.full_like(p, np.nan)
    multiply(A, list(p), list(q))
    assert np.allclose(q, p @ A.toarray(), rtol=1e-13, atol=1e-13)


@pytest.mark.parametrize("n", [1, 2, 7, 64, 1001])
def test_updates(n):
    x, r, p, q, z = _three(n)
    assert dot(x, r) == pytest.approx(x @ r, abs=1e-12)

    moved, left = x.copy(), r.copy()
    size = descend(moved, left, p, q, 0.7)
    assert np.allclose(moved, x + 0.7 * p)
    assert np.allclose(left, r - 0.7 * q)
    assert size == pytest.approx(left @ left)

    turned = p.copy()
    turn(turned, z, -0.3)
    assert np.allclose(turned, z - 0.3 * p)

    older = p.copy()
    recur(older, r, q, 0.4, 1.3, 2.5)
    assert np.allclose(older, (q - 0.4 * r - 1.3 * p) / 2.5)

    mixed = r.copy()
    size = blend(mixed, z, 0.2, -1.1)
    assert np.allclose(mixed, 0.2 * r - 1.1 * z)
    assert size == pytest.approx(mixed @ mixed)
