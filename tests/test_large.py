"""Two million vertices go through everything, in linear memory."""

import sys

import numpy as np
import pytest

import beltrami as bt

GIB = 2**30


@pytest.mark.heavy
def test_two_million_vertices(tmp_path):
    mesh = bt.shapes.blob(2_000_000)
    n = mesh.n_vertices
    assert n > 1_900_000
    diagnosis = bt.diagnose(mesh)
    assert diagnosis.is_clean
    assert diagnosis.genus == 0
    pair = bt.laplacian(mesh)
    assert pair.masses.sum() == pytest.approx(mesh.area, rel=1e-10)
    assert pair.dirichlet_energy(mesh.vertices) == pytest.approx(2 * mesh.area, rel=1e-9)
    assert np.abs(pair.stiffness @ np.ones(n)).max() < 1e-9
    combinatorial = bt.laplacian(mesh, "combinatorial")
    energy = [
        combinatorial.dirichlet_energy(bt.smooth(combinatorial, mesh.vertices, steps))
        for steps in (0, 5, 50)
    ]
    assert energy[0] > energy[1] > energy[2]
    warm = bt.filter(pair, mesh.vertices, bt.kernels.Heat(1e-5 * mesh.area))
    assert np.allclose(pair.mean(warm), pair.mean(mesh.vertices), atol=1e-7)
    assert 0.5 < pair.dirichlet_energy(warm) / pair.dirichlet_energy(mesh.vertices) < 1
    for suffix in (".ply", ".obj", ".off"):
        path = tmp_path / f"large{suffix}"
        bt.write_mesh(path, mesh)
        back = bt.read_mesh(path)
        assert np.array_equal(back.vertices, mesh.vertices), suffix
        assert np.array_equal(back.faces, mesh.faces), suffix
    assert bt.render(mesh, size=(400, 300)).shape == (300, 400, 3)
    if sys.platform == "linux":  # elsewhere the unit is another, or there is no such module
        import resource

        assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 < 5 * GIB
