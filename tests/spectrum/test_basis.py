import numpy as np

import beltrami as bt


def test_full_basis_loses_nothing():
    mesh = bt.shapes.icosphere(2)
    basis = bt.fourier_basis(bt.laplacian(mesh), mesh.n_vertices)
    f = np.random.default_rng(0).standard_normal((mesh.n_vertices, 2))
    assert np.allclose(basis.inverse(basis.forward(f)), f, atol=1e-12)
