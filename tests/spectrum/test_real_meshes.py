"""Real meshes: eigenpairs next to a shift, their rate, their nodal domains, their files."""

import os
from pathlib import Path

import numpy as np
import pytest

import beltrami as bt

FOLDER = os.environ.get("BELTRAMI_MESHES")
NAMES = [
    "spot_triangulated.obj", "fertility.off", "halftunnel.off", "camel-head.off",
    "beetle.obj", "face.obj", "pial_left.gii.gz", "armadillo.obj",
]  # fmt: skip

pytestmark = [
    pytest.mark.meshes,
    pytest.mark.skipif(FOLDER is None, reason="BELTRAMI_MESHES names no folder of meshes"),
]


@pytest.mark.parametrize("name", NAMES)
def test_next_to_a_shift(name, tmp_path):
    path = next(iter(Path(FOLDER).rglob(name)), None)
    if path is None:
        pytest.skip(f"no {name} in the folder")
    mesh = bt.read_mesh(path)
    pair = bt.laplacian(mesh)
    shift = 10.3 * 4 * np.pi / mesh.area  # near the tenth eigenvalue, by Weyl's law
    found = bt.inverse_iteration(pair, shift, max_iterations=1000)
    assert found.residual < 1e-9
    assert found.rate == pytest.approx(found.predicted_rate, abs=0.01)
    assert 0.2 * shift < found.eigenvalue < 4 * shift
    domains = bt.nodal_domains(mesh, found.eigenvector)
    assert 2 <= domains.count <= 30
    residual = np.array([found.residual])
    basis = bt.FourierBasis(
        np.array([found.eigenvalue]), found.eigenvector[:, None].copy(), pair.mass, residual
    )
    basis.save(tmp_path / "one.npz")
    assert bt.load_basis(tmp_path / "one.npz", pair).k == 1
