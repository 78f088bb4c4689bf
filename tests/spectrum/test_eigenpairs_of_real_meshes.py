"""Eigenpairs of real meshes: residuals, orthogonality, and none missing."""

import os
from pathlib import Path

import numpy as np
import pytest

import beltrami as bt

pytestmark = pytest.mark.meshes

FOLDER = os.environ.get("BELTRAMI_MESHES")
NAMES = ["beetle.obj", "camel-head.off", "face.obj", "featuretype.STL", "torus.obj"]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("mass", ["voronoi", "consistent"])
def test_fifty_eigenpairs(name, mass):
    if not FOLDER or not (Path(FOLDER) / name).exists():
        pytest.skip("BELTRAMI_MESHES names no folder with this mesh")
    pair = bt.laplacian(bt.read_mesh(Path(FOLDER) / name), mass=mass)
    basis = bt.fourier_basis(pair, 50, certify=True)
    U, values = basis.eigenvectors, basis.eigenvalues
    force = pair.mass @ U * values
    ratio = np.linalg.norm(pair.stiffness @ U - force, axis=0)[1:]
    assert (ratio <= 1e-6 * np.linalg.norm(force, axis=0)[1:]).all()
    assert basis.orthogonality < 1e-9
    assert values[0] == 0 < values[1]
    assert basis.computation.precision == "float32"
    assert basis.computation.counted_within > 0.95 * values[-1]
