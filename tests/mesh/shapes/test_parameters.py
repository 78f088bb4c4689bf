import numpy as np
import pytest

from beltrami.errors import MeshError
from beltrami.mesh.shapes.parameters import flat, positive, whole


def test_whole_takes_numpy_integers_and_refuses_fractions():
    assert whole("n", np.int32(5), least=5) == 5
    assert whole("n", 7, least=5, most=7) == 7
    for bad in (4, 5.0, "5", None, 10**30):
        with pytest.raises(MeshError, match="n is"):
            whole("n", bad, least=5)


@pytest.mark.parametrize("bad", [0, -1.0, np.nan, np.inf, None, "a", [1.0], 1j])
def test_positive_refuses(bad):
    with pytest.raises(MeshError, match="width is"):
        positive("width", bad)


def test_flat_refuses_other_dimensions():
    with pytest.raises(MeshError, match="dimension"):
        flat(np.zeros((1, 2)), 1)
