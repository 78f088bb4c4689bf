"""averaging_limit: shapes and what is refused; its numbers are in theorems/test_theorem_05."""

import numpy as np
import pytest

from beltrami.errors import DimensionError, MeshError, NonFiniteError, UnknownNameError
from beltrami.grids.grid import Grid


@pytest.mark.chapter("T5")
@pytest.mark.parametrize("shape", [(4,), (5,)])
def test_columns_are_averaged_one_by_one(shape):
    f = np.random.default_rng(16).normal(size=(shape[0], 3))
    limit = Grid(shape).averaging_limit(f)
    for c in range(3):
        one = Grid(shape).averaging_limit(f[:, c])
        assert np.allclose(limit.even[:, c], one.even)
        assert np.allclose(limit.odd[:, c], one.odd)
    limit.even[0] = 7  # yours
    assert limit.odd[0, 0] != 7


def test_bad_input():
    with pytest.raises(DimensionError):
        Grid((2, 3)).averaging_limit(np.ones((2, 3)))
    with pytest.raises(NonFiniteError):
        Grid(2).averaging_limit([1, np.inf])
    with pytest.raises(UnknownNameError):
        Grid(2).averaging_limit([1, 2], "cotangent")
    with pytest.raises(MeshError):
        Grid(1).averaging_limit([1])
