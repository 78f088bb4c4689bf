"""Norms of the rows of powers: against dense matrices."""

import numpy as np
import pytest
from scipy.sparse import csr_array

from beltrami.diffusion.power_norms import power_norms


@pytest.mark.parametrize("density", [0.02, 0.1, 0.6, 1.0])
@pytest.mark.parametrize("most", [1, 2, 3, 4])
def test_against_dense_powers(density, most):
    random = np.random.default_rng(3)
    K = random.standard_normal((40, 40)) * (random.random((40, 40)) < density)
    K[7] = 0  # an empty row
    expected = [np.linalg.norm(np.linalg.matrix_power(K, k), axis=1) for k in range(1, most + 1)]
    assert power_norms(csr_array(K), most) == pytest.approx(np.array(expected), rel=1e-12)
