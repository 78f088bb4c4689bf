import numpy as np
import pytest

import spectra
from beltrami.errors import MeshError, UnknownNameError
from beltrami.mesh.shapes import cylinder, icosphere
from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.fourier_basis import fourier_basis
from beltrami.spectrum.shape_dna import shape_dna


def test_each_normalization():
    basis = spectra.basis_of("two", 12)
    values = basis.eigenvalues
    zeros = np.arange(12) < 2
    area = spectra.mesh_of("two").area
    for name, scale in (("none", 1), ("area", area), ("first", 1 / values[2])):
        dna = shape_dna(basis, name)
        assert not dna[zeros].any()
        np.testing.assert_allclose(dna[2:], scale * values[2:], rtol=1e-12)
    assert np.array_equal(shape_dna(basis), shape_dna(basis, "area"))


@pytest.mark.parametrize("unit", [1e-9, 3.0, 1e9])
def test_units(unit):
    mesh = spectra.mesh_of("obt")
    basis = spectra.basis_of("obt", 20)
    large = fourier_basis(laplacian(mesh.with_vertices(unit * mesh.vertices)), 20)
    for name in ("area", "first"):
        np.testing.assert_allclose(shape_dna(large, name), shape_dna(basis, name), rtol=1e-8)
    np.testing.assert_allclose(
        shape_dna(large, "none") * unit**2, shape_dna(basis, "none"), rtol=1e-8
    )


def test_numbers_of_vertices_and_bending_do_not_matter():
    other, _ = spectra.permuted(spectra.mesh_of("cur"))
    np.testing.assert_allclose(
        shape_dna(fourier_basis(laplacian(other), 20)),
        shape_dna(spectra.basis_of("cur", 20)),
        rtol=1e-8,
    )
    one, two = (shape_dna(basis) for basis in spectra.sheet_and_scroll())
    np.testing.assert_allclose(two, one, rtol=1e-8)
    closed = shape_dna(fourier_basis(laplacian(cylinder(14, 9)), 30))
    assert np.abs(closed[1:] / one[1:] - 1).max() > 0.1


def test_on_the_sphere_it_is_known():
    dna = shape_dna(spectra.basis_of("sphere", 16))
    degree = np.repeat([0, 1, 2, 3], [1, 3, 5, 7])
    np.testing.assert_allclose(dna, 4 * np.pi * degree * (degree + 1), rtol=0.03)


def test_wrong_input():
    basis = spectra.basis_of("pl", 5)
    with pytest.raises(UnknownNameError, match="'area'"):
        shape_dna(basis, "aera")
    kernel = fourier_basis(laplacian(icosphere(1)), 1)
    with pytest.raises(MeshError, match="all zero"):
        shape_dna(kernel, "first")
    assert shape_dna(kernel, "none").tolist() == [0.0]
