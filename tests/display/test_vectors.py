import numpy as np
import pytest

from beltrami.display.vectors import as_vector, unit_vector
from beltrami.errors import DimensionError, NonFiniteError


def test_a_vector_is_copied_and_frozen():
    mine = np.ones(3)
    theirs = as_vector(mine, "it")
    mine[0] = 7
    assert theirs.tolist() == [1, 1, 1]
    assert not theirs.flags.writeable


@pytest.mark.parametrize(
    ("vector", "error"),
    [((1, 2), DimensionError), (np.eye(3), DimensionError), ((1, 2, np.inf), NonFiniteError)],
)
def test_what_is_no_vector_is_refused(vector, error):
    with pytest.raises(error, match="the eye"):
        as_vector(vector, "the eye")


@pytest.mark.parametrize("scale", [1e-300, 1.0, 1e300])
def test_unit_length_in_any_unit(scale):
    assert np.allclose(unit_vector(scale * np.array([2.0, -1, 2])), np.array([2, -1, 2]) / 3)


def test_zero_stays_zero():
    assert unit_vector(np.zeros(3)).tolist() == [0, 0, 0]
