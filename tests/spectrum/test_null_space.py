"""Zero eigenvalues are told from small ones."""

import numpy as np
import pytest
from scipy.sparse import csr_array

import spectra
from beltrami.errors import BeltramiError, MeshError
from beltrami.mesh.shapes import icosphere
from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.basis import FourierBasis
from beltrami.spectrum.fourier_basis import fourier_basis
from beltrami.spectrum.null_space import apart, kernel_size, positive_modes, true_zeros


def made(values, residuals=None):
    k = len(values)
    return FourierBasis(
        np.array(values, float),
        np.eye(k),
        csr_array(np.eye(k)),
        np.zeros(k) if residuals is None else np.array(residuals, float),
    )


@pytest.mark.parametrize("k", [5, None])
@pytest.mark.parametrize("name", ["closed", "obt", "open", "bad", "cur", "tor", "creature"])
def test_one_zero_on_a_connected_surface(name, k):
    basis = spectra.basis_of(name, k)
    assert kernel_size(basis) == 1
    assert true_zeros(basis)[0] == 0
    assert np.array_equal(true_zeros(basis)[1:], basis.eigenvalues[1:])


@pytest.mark.parametrize("unit", [1e-9, 1e9])
def test_in_any_unit(unit):
    sphere = icosphere(2)
    basis = fourier_basis(laplacian(sphere.with_vertices(unit * sphere.vertices)), 5)
    assert kernel_size(basis) == 1


@pytest.mark.chapter("T7")
def test_one_for_each_component():
    mesh = spectra.beside(spectra.mesh_of("two"), icosphere(1))
    basis = fourier_basis(laplacian(mesh), 9)
    assert kernel_size(basis) == 3
    far = apart(basis, 0)
    assert np.array_equal(np.flatnonzero(~far), np.arange(162))
    assert np.array_equal(np.flatnonzero(~apart(basis, 200)), 162 + np.arange(160))


def test_a_basis_of_nothing_but_the_kernel():
    basis = fourier_basis(spectra.pair_of("two"), 2)
    assert kernel_size(basis) == 2
    with pytest.raises(MeshError, match="more eigenpairs than there are components"):
        positive_modes(basis, "a distance")
    assert kernel_size(made([0.0, 0.0])) == 2  # told without residuals where it is exact


def test_the_tolerance_decides():
    basis = made([0, 1e-10, 1e-8, 1])
    assert [kernel_size(basis, t) for t in (0, 1e-9, 1e-7)] == [1, 2, 3]
    assert kernel_size(made([-1e-12, 1e-12, 1])) == 2


def test_what_is_refused():
    with pytest.raises(MeshError, match=r"negative eigenvalue, -0\.5"):
        kernel_size(made([-0.5, 0, 1]))
    with pytest.raises(MeshError, match="empty"):
        kernel_size(made([]))
    for tolerance in (-1e-9, 1, np.nan):
        with pytest.raises(BeltramiError, match="tolerance"):
            kernel_size(made([0, 1]), tolerance)
