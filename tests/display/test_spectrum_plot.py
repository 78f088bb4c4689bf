import dataclasses
import sys

import numpy as np
import pytest
from PIL import Image

import beltrami as bt
from beltrami.display.spectrum_plot import band_means, plot_spectrum


@pytest.fixture(scope="module")
def basis():
    return bt.fourier_basis(bt.laplacian(bt.shapes.icosphere(3)), 200)


@pytest.fixture(scope="module")
def functions():
    x, y, z = bt.shapes.icosphere(3).vertices.T
    return {"smooth": np.exp(x + y / 2 + z / 5), "a step": np.sign(x + 0.3 * y - z / 2 + 0.1)}


def test_every_function_has_its_color_and_the_file_is_the_picture(basis, functions, tmp_path):
    image = plot_spectrum(basis, functions, tmp_path / "s.png", size=(400, 300))
    assert image.shape == (300, 400, 3)
    assert image.dtype == np.uint8
    np.testing.assert_array_equal(np.asarray(Image.open(tmp_path / "s.png")), image)
    one = plot_spectrum(basis, {"smooth": functions["smooth"]}, size=(400, 300))
    blue, orange = (0, 114, 178), (213, 94, 0)
    assert (image == blue).all(axis=2).any()
    assert (image == orange).all(axis=2).any()
    assert (one == blue).all(axis=2).any()
    assert not (one == orange).all(axis=2).any()


@pytest.mark.chapter("F3.8")
def test_the_smooth_function_decays_faster(basis, functions):
    slopes = []
    for f in functions.values():
        at, mean = band_means(basis.eigenvalues[1:], np.abs(basis.forward(f))[1:])
        slopes.append(np.polyfit(np.log(at), np.log(mean), 1)[0])
    smooth, step = slopes
    assert smooth < -2.5
    assert -0.9 < step < -0.6  # the error of M terms falls like the root of M: λ^(-3/4) each


def test_bands_do_not_depend_on_the_basis_of_an_eigenspace(functions):
    values = np.array([2.0, 2, 2, 6, 6, 6, 6, 6])
    coefficients = np.arange(1.0, 9)
    turned = coefficients.copy()
    turned[:3] = np.linalg.norm(coefficients[:3]), 0, 0
    np.testing.assert_allclose(band_means(values, coefficients)[1], band_means(values, turned)[1])


def test_columns_count_together(basis):
    random = np.random.default_rng(0)
    f = random.standard_normal((basis.n, 3))
    turn = np.linalg.qr(random.standard_normal((3, 3)))[0]
    one, turned, other = (plot_spectrum(basis, {"f": g}) for g in (f, f @ turn, f[:, 0]))
    assert (one != turned).mean() < 1e-3 < (one != other).mean()


def test_what_cannot_be_plotted(basis, functions, monkeypatch):
    with pytest.raises(bt.errors.BeltramiError, match="at least one function"):
        plot_spectrum(basis, {})
    with pytest.raises(bt.errors.DimensionError, match="the function 'f'"):
        plot_spectrum(basis, {"f": [1.0, 2.0]})
    with pytest.raises(bt.errors.UnknownNameError):
        plot_spectrum(basis, functions, "a.tiff")
    alone = dataclasses.replace(
        basis,
        eigenvalues=np.zeros(1),
        eigenvectors=basis.eigenvectors[:, :1],
        residuals=basis.residuals[:1],
    )
    with pytest.raises(bt.errors.BeltramiError, match="beyond zero"):
        plot_spectrum(alone, {"f": np.ones(alone.n)})
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)
    with pytest.raises(bt.errors.MissingExtraError, match=r"beltrami\[plot\]"):
        plot_spectrum(basis, functions)


def test_a_constant_is_drawn_at_the_floor(basis):
    assert plot_spectrum(basis, {"nothing": np.zeros(basis.n)}).std() > 0


@pytest.mark.parametrize("value", [1e-3, 1000 / 3])
@pytest.mark.parametrize("apart", [0, 1, 3])
def test_eigenvalues_that_are_alike_but_for_rounding(value, apart):
    mesh = bt.shapes.tetrahedron()
    basis = bt.fourier_basis(bt.laplacian(mesh, "combinatorial", "unit"), 4)
    alike = np.array([0, value, value, value + apart * np.spacing(value)])
    image = plot_spectrum(dataclasses.replace(basis, eigenvalues=alike), {"f": mesh.vertices[:, 0]})
    assert (image == (0, 114, 178)).all(axis=2).any()
