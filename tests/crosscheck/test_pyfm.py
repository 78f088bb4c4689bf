"""Signatures, point maps and ZoomOut against pyFM (``pip install pyfmaps``), if it is there."""

import numpy as np
import pytest

import spectra
from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.correspondence import unit_eigenvalues, unit_vectors
from beltrami.spectrum.fourier_basis import fourier_basis
from beltrami.spectrum.functional_map import functional_map
from beltrami.spectrum.heat_kernel import heat_kernel_signature
from beltrami.spectrum.wave_kernel import wave_kernel_signature
from beltrami.spectrum.zoomout import zoomout

pytest.importorskip("pyFM", reason="pyFM is not installed")


def test_signatures():
    from pyFM.signatures.HKS_functions import HKS
    from pyFM.signatures.WKS_functions import WKS

    basis = spectra.basis_of("creature", 40)
    heat, wave = heat_kernel_signature(basis), wave_kernel_signature(basis)
    theirs = HKS(basis.eigenvalues, basis.eigenvectors, heat.at)
    np.testing.assert_allclose(heat.values, theirs, rtol=1e-9)
    sigma = 7 * (wave.at[1] - wave.at[0])
    theirs = WKS(basis.eigenvalues, basis.eigenvectors, wave.at, sigma, scaled=True)
    np.testing.assert_allclose(wave.values, theirs, rtol=1e-9)


def test_maps():
    from pyFM.optimize.base_functions import LB_commutation, descr_preservation
    from pyFM.refine.zoomout import zoomout_refine
    from pyFM.spectral import FM_to_p2p

    mesh = spectra.mesh_of("creature")
    thin = mesh.with_vertices(mesh.vertices * [1, 1, 0.9])
    source, target = spectra.basis_of("creature", 60), fourier_basis(laplacian(thin), 60)
    pairs = np.column_stack([np.arange(0, 700, 35)] * 2)
    start = functional_map(source, target, landmarks=pairs, k=20)
    phi, psi = unit_vectors(source, 60), unit_vectors(target, 60)
    assert np.array_equal(start.point_map, FM_to_p2p(start.matrix, phi, psi))
    fine = zoomout(start)
    area = target.mass / target.mass.sum()
    matrix, points = zoomout_refine(start.matrix, phi, psi, nit=40, A2=area, return_p2p=True)
    np.testing.assert_allclose(fine.matrix, matrix, atol=1e-12)
    assert np.array_equal(fine.point_map, points)

    A, B = phi[pairs[:, 0], :20].T, psi[pairs[:, 1], :20].T
    scale = 1 / np.hypot(np.linalg.norm(A, axis=0), np.linalg.norm(B, axis=0)) / np.sqrt(20)
    s, t = unit_eigenvalues(source)[:20], unit_eigenvalues(target)[:20]
    gap = 0.1 * ((s[None, :] - t[:, None]) / max(s.max(), t.max())) ** 2

    def energy(C):
        return descr_preservation(C, A * scale, B * scale) + LB_commutation(C, gap)

    rng = np.random.default_rng(0)
    for _ in range(10):
        other = start.matrix + 1e-3 * rng.normal(size=(20, 20))
        assert energy(start.matrix) < energy(other)
