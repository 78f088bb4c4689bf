"""Domain: an object of one's own makes the pair through one method."""

import numpy as np
import pytest
from scipy.sparse import csr_array

from beltrami.errors import DimensionError
from beltrami.mesh.shapes import icosphere
from beltrami.operators.laplacian import laplacian
from beltrami.operators.projection import project


class Path:
    """A path of three vertices."""

    def make_laplacian(self, weights, mass):
        assert (weights, mass) == ("combinatorial", None)
        return laplacian(csr_array([[0, 1, 0], [1, 0, 1], [0, 1, 0]]))


def test_an_object_with_the_one_method_is_a_domain():
    assert laplacian(Path(), "combinatorial").degrees.tolist() == [1, 2, 1]


@pytest.mark.parametrize(
    "thing", [None, "cotangent", np.eye(3), icosphere(1), icosphere(1).topology]
)
def test_whatever_is_no_pair_is_refused_in_one_line(thing):
    f = np.ones(42)
    with pytest.raises(DimensionError, match=f"a Laplacian is needed.*{type(thing).__name__}"):
        project(thing, f, f)
