"""Frames: energies between their bounds, and everything comes back."""

import numpy as np
import pytest

import beltrami as bt
from beltrami.errors import ApproximationError, BeltramiError, DimensionError
from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.fourier_basis import fourier_basis
from beltrami.spectrum.frames import Frame
from beltrami.spectrum.kernels import Heat, HighPass, LowPass
from beltrami.spectrum.wavelets import MexicanHat, MeyerBand, mexican_hat_frame, meyer_frame
from meshes_of_the_errata import MESHES

MAKERS = [meyer_frame, mexican_hat_frame]


def _energies(pair, parts):
    return sum(pair.norm(part) ** 2 for part in parts)


@pytest.mark.parametrize("scales", [1, 3, 6])
@pytest.mark.parametrize("make", MAKERS)
@pytest.mark.parametrize(("name", "mass"), [("closed", "voronoi"), ("bad", "consistent")])
def test_there_and_back(name, mass, make, scales):
    pair = laplacian(MESHES[name](), mass=mass)
    frame = make(pair.spectral_bound(), scales)
    rng = np.random.default_rng(1)
    for f in (rng.normal(size=pair.n), rng.normal(size=(pair.n, 3))):
        parts = frame.analyze(pair, f)
        assert parts.shape == (scales + 1, *f.shape)
        A, B = frame.bounds
        assert A * (1 - 1e-7) <= _energies(pair, parts) / pair.norm(f) ** 2 <= B * (1 + 1e-7)
        assert np.abs(frame.synthesize(pair, parts) - f).max() < 1e-6 * np.abs(f).max()


@pytest.mark.parametrize("make", MAKERS)
def test_the_basis_agrees_with_the_polynomials(make):
    pair = laplacian(MESHES["cur"]())
    basis = fourier_basis(pair, pair.n)
    frame = make(pair.spectral_bound(), 4)
    f = np.random.default_rng(1).normal(size=(pair.n, 2))
    exact = frame.analyze(basis, f)
    np.testing.assert_allclose(frame.analyze(pair, f), exact, atol=1e-7)
    np.testing.assert_allclose(frame.synthesize(basis, exact), f, atol=1e-10)
    noise = exact + np.random.default_rng(2).normal(size=exact.shape)
    np.testing.assert_allclose(
        frame.synthesize(pair, noise), frame.synthesize(basis, noise), atol=1e-6
    )


@pytest.mark.parametrize("scales", [1, 2, 5, 10])
def test_meyer_is_tight(scales):
    frame = meyer_frame(7.0, scales)
    x = np.linspace(0, 7, 5001)
    np.testing.assert_allclose(frame.power(x), 1, atol=1e-14)
    assert frame.bounds == pytest.approx((1, 1), abs=1e-14)
    values = np.array([g(x) for g in frame.kernels])
    assert ((values > 1e-9).sum(axis=0) <= 2).all()  # only neighbours overlap
    assert frame.kernels[0](0.0) == 1
    assert all(g(0.0) == 0 for g in frame.kernels[1:])


@pytest.mark.parametrize("scales", [1, 2, 5, 10])
def test_mexican_hats_lose_nothing(scales):
    frame = mexican_hat_frame(7.0, scales)
    A, B = frame.bounds
    x = np.linspace(0, 7, 70001)
    assert frame.power(x).min() == pytest.approx(A, rel=1e-6)
    assert frame.power(x).max() == pytest.approx(B, rel=1e-6)
    assert 0.9 < A < B < 3
    for hat in frame.kernels[1:]:
        assert (hat(0.0), hat(hat.peak)) == (0, 1)
        assert hat(x).max() <= 1


def test_a_plain_pair_of_kernels_is_a_frame():
    """The dual kernels divide by the sum of the squares: 1/2 would be wrong here."""
    pair = laplacian(MESHES["closed"]())
    high = pair.spectral_bound()
    frame = Frame((Heat(3 / high), 1 - Heat(3 / high)), high)
    assert frame.bounds[0] == pytest.approx(0.5, abs=1e-6)
    assert frame.bounds[1] == pytest.approx(1)
    f = np.random.default_rng(1).normal(size=pair.n)
    assert np.abs(frame.synthesize(pair, frame.analyze(pair, f)) - f).max() < 1e-6


def test_synthesis_finds_the_nearest_parts():
    """It is the pseudo-inverse of the analysis in the norm of the mass."""
    pair = laplacian(MESHES["leaves"]())
    basis = fourier_basis(pair, pair.n)
    frame = mexican_hat_frame(pair.spectral_bound(), 2)
    root = np.sqrt(pair.masses)
    analysis = np.concatenate(
        [root[:, None] * part for part in frame.analyze(basis, np.diag(1 / root))]
    )
    parts = np.random.default_rng(1).normal(size=(3, pair.n))
    found = root * frame.synthesize(basis, parts)
    np.testing.assert_allclose(found, np.linalg.pinv(analysis) @ (root * parts).ravel())


def test_what_is_refused():
    pair = laplacian(MESHES["closed"]())
    f = np.ones(pair.n)
    small = meyer_frame(pair.spectral_bound() / 100)
    with pytest.raises(BeltramiError, match="covers eigenvalues up to"):
        small.analyze(pair, f)
    with pytest.raises(BeltramiError, match="covers eigenvalues up to"):
        small.analyze(fourier_basis(pair, pair.n), f)
    frame = meyer_frame(pair.spectral_bound(), 2)
    with pytest.raises(DimensionError, match=r"\(3, n\)"):
        frame.synthesize(pair, np.ones((2, pair.n)))
    with pytest.raises(DimensionError):
        frame.synthesize(pair, np.ones((3, pair.n + 1)))
    with pytest.raises(BeltramiError, match="no way back"):
        Frame((HighPass(1.0, 0.5),), pair.spectral_bound()).synthesize(pair, np.ones((1, pair.n)))
    ideal = Frame((LowPass(1.0), HighPass(1.0)), pair.spectral_bound())
    with pytest.raises(ApproximationError, match="jumps"):
        ideal.analyze(pair, f)
    assert ideal.analyze(fourier_basis(pair, pair.n), f).shape == (2, pair.n)


@pytest.mark.parametrize(
    "make",
    [
        lambda: Frame((), 1.0),
        lambda: Frame((Heat(1.0), 2.0), 1.0),
        lambda: Frame((Heat(1.0),), 0.0),
        lambda: Frame((Heat(1.0),), np.inf),
        lambda: meyer_frame(1.0, 0),
        lambda: mexican_hat_frame(-1.0),
        lambda: MeyerBand(1.0, 1.5),
        lambda: MexicanHat(0.0),
    ],
)
def test_no_frames(make):
    with pytest.raises(BeltramiError):
        make()


def test_public_names():
    assert bt.meyer_frame(4.0) == meyer_frame(4.0)
    assert isinstance(bt.mexican_hat_frame(4.0), bt.Frame)
