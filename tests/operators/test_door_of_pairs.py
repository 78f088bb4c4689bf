"""Whatever is no Laplacian where one is needed is refused in one line."""

import numpy as np
import pytest

import beltrami as bt

MESH = bt.shapes.icosphere(1)
Z = MESH.vertices[:, 2]
CALLS = {
    "smooth": lambda pair: bt.smooth(pair, Z, 1),
    "heat": lambda pair: bt.heat(pair, Z, 0.1),
    "wave": lambda pair: next(iter(bt.wave(pair, Z, None, [0.1]))),
    "poisson": lambda pair: bt.poisson(pair, Z),
    "regularize": lambda pair: bt.regularize(pair, Z, 0.1),
    "interpolate": lambda pair: bt.interpolate(pair, [0], [1.0]),
    "denoise_function": lambda pair: bt.denoise_function(pair, Z),
    "fourier_basis": lambda pair: bt.fourier_basis(pair, 3),
    "inverse_iteration": lambda pair: bt.inverse_iteration(pair, 1.0),
    "filter": lambda pair: bt.filter(pair, Z, np.exp),
    "project": lambda pair: bt.project(pair, Z, MESH.vertices),
}


@pytest.mark.parametrize("wrong", [None, MESH, (1, 2), "mesh", np.eye(42)], ids=str)
@pytest.mark.parametrize("name", CALLS)
def test_what_is_no_pair(name, wrong):
    with pytest.raises(
        bt.errors.DimensionError, match=r"a Laplacian is needed for .*Make one"
    ) as e:
        CALLS[name](wrong)
    assert "\n" not in str(e.value)
