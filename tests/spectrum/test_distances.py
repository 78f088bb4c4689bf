"""Spectral distances: metrics, and equal to direct solves with all modes."""

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.spatial.distance import pdist, squareform

import spectra
from beltrami.errors import BeltramiError, MeshError, UnknownNameError
from beltrami.mesh.shapes import icosphere
from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.distances import SPECTRAL_DISTANCES, spectral_distance, spectral_embedding
from beltrami.spectrum.fourier_basis import fourier_basis

NAMES = ["closed", "obt", "open", "bad", "cur"]
MASSES = ["voronoi", "consistent", "degree"]


def options(kind, basis):
    return {"kind": kind, "time": 1 / basis.eigenvalues[4] if kind == "diffusion" else None}


def _squares(G):
    """(n, n) values of G_xx + G_yy - 2 G_xy."""
    return G.diagonal()[:, None] + G.diagonal()[None, :] - 2 * G


@pytest.mark.parametrize("mass", MASSES)
@pytest.mark.parametrize("name", NAMES)
def test_commute_time_is_the_pseudo_inverse(name, mass):
    """Its square is the resistance, which knows no mass."""
    resistance = _squares(np.linalg.pinv(spectra.pair_of(name).stiffness.toarray(), rcond=1e-11))
    for x in (0, 100):
        found = spectral_distance(spectra.basis_of(name, None, mass), x, "commute_time")
        np.testing.assert_allclose(found**2, resistance[x], rtol=1e-6, atol=1e-9)


@pytest.mark.parametrize("mass", MASSES)
@pytest.mark.parametrize("name", NAMES)
def test_biharmonic_is_the_square_of_a_green_function(name, mass):
    pair = spectra.pair_of(name, mass)
    B, L = pair.mass.toarray(), pair.stiffness.toarray()
    G = np.linalg.pinv(L, rcond=1e-11)
    one = np.ones(pair.n)
    off = np.eye(pair.n) - np.outer(one, B @ one) / (one @ B @ one)  # mean zero, for B
    green = off @ G @ off.T
    squares = _squares(green @ B @ green)
    for x in (0, 100):
        found = spectral_distance(spectra.basis_of(name, None, mass), x)
        np.testing.assert_allclose(found**2, squares[x], rtol=1e-6, atol=1e-9 * squares.max())


@pytest.mark.parametrize("mass", MASSES)
@pytest.mark.parametrize("name", NAMES)
def test_diffusion_is_the_distance_of_heat_kernels(name, mass):
    pair = spectra.pair_of(name, mass)
    B = pair.mass.toarray()
    basis = spectra.basis_of(name, None, mass)
    time = 1 / basis.eigenvalues[4]
    kernel = expm(-time * np.linalg.solve(B, pair.stiffness.toarray())) @ np.linalg.inv(B)
    for x in (0, 100):
        difference = kernel - kernel[:, [x]]
        squares = np.einsum("zx,zx->x", difference, B @ difference)
        found = spectral_distance(basis, x, "diffusion", time=time)
        np.testing.assert_allclose(found**2, squares, rtol=1e-6, atol=1e-9 * squares.max())


@pytest.mark.parametrize("kind", SPECTRAL_DISTANCES)
@pytest.mark.parametrize("name", ["closed", "obt", "open", "tor"])
def test_they_are_metrics(name, kind):
    basis = spectra.basis_of(name)
    points = spectral_embedding(basis, **options(kind, basis))
    D = squareform(pdist(points))
    n = basis.n
    for x in (0, n // 2):
        found = spectral_distance(basis, x, **options(kind, basis))
        np.testing.assert_allclose(found, D[x], rtol=1e-7, atol=1e-12 * D.max())
        assert found[x] == 0
        assert (np.delete(found, x) > 1e-6 * D.max()).all()  # zero if equal, and only then
    for z in range(0, n, 17):
        assert (D[:, [z]] + D[[z], :] + 1e-9 * D.max() >= D).all()


def test_a_short_basis_may_not_tell_points_apart():
    basis = spectra.basis_of("pl", 2)
    d = spectral_distance(basis, 0)
    assert np.sort(d)[6] < 1e-9 * d.max()  # a whole side of the rectangle


@pytest.mark.parametrize("kind", SPECTRAL_DISTANCES)
@pytest.mark.parametrize("name", ["closed", "obt", "open"])
def test_what_is_left_out_is_bounded(name, kind):
    whole = spectra.basis_of(name)
    how = options(kind, whole)
    exact = spectral_distance(whole, 5, **how)
    masses = whole.mass.diagonal()
    for k in (4, 30, 150):
        short = spectra.basis_of(name, k)
        part = spectral_distance(short, 5, **how)
        assert (part <= exact * (1 + 1e-9)).all()
        last = short.eigenvalues[-1]
        weight = {
            "biharmonic": last**-2,
            "commute_time": 1 / last,
            "diffusion": np.exp(-2 * last * (how["time"] or 0)),
        }[kind]
        seen = ((short.eigenvectors - short.eigenvectors[5]) ** 2).sum(axis=1)
        bound = weight * np.maximum(1 / masses + 1 / masses[5] - seen, 0)
        others = np.arange(whole.n) != 5
        assert (exact**2 <= (part**2 + bound) * (1 + 1e-9))[others].all()


@pytest.mark.parametrize("kind", SPECTRAL_DISTANCES)
def test_what_must_not_matter(kind):
    mesh = spectra.mesh_of("cur")
    basis = spectra.basis_of("cur", 40)
    how = options(kind, basis)
    d = spectral_distance(basis, 3, **how)
    other, order = spectra.permuted(mesh)
    again = fourier_basis(laplacian(other), 40)
    at = int(np.flatnonzero(order == 3)[0])
    np.testing.assert_allclose(
        spectral_distance(again, at, **how), d[order], rtol=1e-6, atol=1e-9 * d.max()
    )
    one, two = (spectral_distance(b, 3, **how) for b in spectra.sheet_and_scroll())
    np.testing.assert_allclose(one, two, rtol=1e-6, atol=1e-9 * one.max())
    torus = spectra.flat_torus()
    how = options(kind, torus)
    one, two = (spectral_distance(b, 3, **how) for b in (torus, spectra.turned(torus)))
    np.testing.assert_allclose(one, two, rtol=1e-6, atol=1e-9 * d.max())


@pytest.mark.parametrize("unit", [1e-9, 1e9])
@pytest.mark.parametrize(
    ("kind", "power"), [("biharmonic", 1), ("commute_time", 0), ("diffusion", -1)]
)
def test_units(unit, kind, power):
    mesh = spectra.mesh_of("obt")
    basis = spectra.basis_of("obt", 30)
    large = fourier_basis(laplacian(mesh.with_vertices(unit * mesh.vertices)), 30)
    how = options(kind, basis)
    d = spectral_distance(basis, 0, **how)
    if kind == "diffusion":
        how["time"] *= unit**2
    other = spectral_distance(large, 0, **how)
    np.testing.assert_allclose(other, unit**power * d, rtol=1e-6)


@pytest.mark.parametrize("kind", SPECTRAL_DISTANCES)
def test_other_components(kind):
    basis = spectra.basis_of("two")
    how = options(kind, basis)
    d = spectral_distance(basis, 4, **how)
    if kind == "diffusion":
        assert np.isfinite(d).all()
        assert d[162:].min() > 0
    else:
        assert np.isinf(d[162:]).all()
        sphere = icosphere(2)
        alone = spectral_distance(fourier_basis(laplacian(sphere), 162), 4, **how)
        np.testing.assert_allclose(d[:162], alone, rtol=1e-6, atol=1e-9 * alone.max())
    both = spectral_distance(basis, [4, 170], **how)
    np.testing.assert_array_equal(both, np.minimum(d, spectral_distance(basis, 170, **how)))
    mask = np.zeros(basis.n, bool)
    mask[[4, 170]] = True
    assert np.array_equal(spectral_distance(basis, mask, **how), both)


def test_after_a_long_time_only_components_are_told_apart():
    d = spectral_distance(spectra.basis_of("two", 9), 0, "diffusion", time=1e308)
    assert np.abs(d[:162]).max() < 1e-6 < 0.1 < d[162:].min()


def test_on_the_sphere_they_grow_with_the_angle():
    sphere = spectra.mesh_of("sphere")
    angle = np.arccos(np.clip(sphere.vertices @ sphere.vertices[0], -1, 1))
    basis = spectra.basis_of("sphere")
    for kind in SPECTRAL_DISTANCES:
        d = spectral_distance(basis, 0, **options(kind, basis))
        assert d.argmax() == angle.argmax()
        assert np.corrcoef(d, angle)[0, 1] > 0.7
    l = np.arange(1, 400)  # noqa: E741
    exact = np.sqrt((2 * l + 1) / (l * (l + 1)) ** 2 * 2 * (l % 2) / (2 * np.pi)).astype(float)
    farthest = np.sqrt((exact**2).sum())
    biharmonic = spectral_distance(basis, 0)
    assert biharmonic.max() == pytest.approx(farthest, rel=0.02)


def test_wrong_input():
    basis = spectra.basis_of("pl", 10)
    with pytest.raises(UnknownNameError, match="biharmonic"):
        spectral_distance(basis, 0, "biharmonik")
    for kind, time in (("diffusion", None), ("biharmonic", 1.0), ("commute_time", 0.0)):
        with pytest.raises(BeltramiError, match="time belongs to the diffusion"):
            spectral_distance(basis, 0, kind, time=time)
    for time in (-1.0, np.nan, np.inf):
        with pytest.raises(BeltramiError, match="finite and >= 0"):
            spectral_distance(basis, 0, "diffusion", time=time)
    with pytest.raises(MeshError, match="at least one source"):
        spectral_distance(basis, [])
    with pytest.raises(MeshError) as caught:
        spectral_distance(basis, [0, 999])
    assert caught.value.vertices.tolist() == [999]
    with pytest.raises(MeshError, match="all zero"):
        spectral_distance(fourier_basis(laplacian(icosphere(1)), 1), 0)
