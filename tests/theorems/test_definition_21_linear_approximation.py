"""Definition 21 and the decay of its error (l. 609 to 617): E78, E79, E86."""

import numpy as np
import pytest

from beltrami.grids.circle import decay_exponent
from beltrami.mesh.shapes import icosphere
from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.fourier_basis import fourier_basis
from meshes_of_the_errata import IRREGULAR, MESHES


def _relative_error(pair, approximate, f):
    return pair.norm(f - approximate(f)) / pair.norm(f)


@pytest.fixture(scope="module")
def closed():
    pair = laplacian(MESHES["closed"](), "combinatorial")
    return pair, fourier_basis(pair, pair.n)


def _printed(pair, m):
    """Expand on the eigenvectors of the normalised Laplacian, with plain inner products."""
    U = np.linalg.eigh(pair.normalized.toarray())[1][:, :m]
    return lambda f: U @ (U.T @ f)


@pytest.mark.chapter("D21")
@pytest.mark.parametrize("name", IRREGULAR)
@pytest.mark.parametrize("mass", ["degree", "voronoi", "consistent"])
def test_it_is_a_nested_projection(name, mass):
    pair = laplacian(MESHES[name](), mass=mass)
    basis = fourier_basis(pair, pair.n)
    f = np.random.default_rng(2).normal(size=pair.n)
    np.testing.assert_allclose(basis.truncate(f, pair.n), f, atol=1e-10)
    twelve = basis.truncate(f, 12)
    np.testing.assert_allclose(basis.truncate(twelve, 12), twelve, atol=1e-11)
    np.testing.assert_allclose(basis.truncate(twelve, 40), twelve, atol=1e-11)
    np.testing.assert_allclose(basis.truncate(basis.truncate(f, 40), 12), twelve, atol=1e-11)
    assert pair.inner(f - twelve, twelve) == pytest.approx(0, abs=1e-10 * pair.norm(f) ** 2)
    other = basis.inverse(np.where(np.arange(pair.n) < 12, 1.1 * basis.forward(f), 0))
    assert pair.norm(f - twelve) < pair.norm(f - other)


@pytest.mark.chapter("D21")
def test_as_printed_constants_are_lost(closed):
    """E78: about 0.108 of a constant is missing after 1, 10 or 50 of 300 terms."""
    pair, basis = closed
    one = np.ones(pair.n)
    for m in (1, 10, 50):
        assert _relative_error(pair, lambda f, m=m: basis.truncate(f, m), one) < 1e-12
        left = one - _printed(pair, m)(one)
        assert np.linalg.norm(left) / np.linalg.norm(one) == pytest.approx(0.108, abs=2e-3)


@pytest.mark.chapter("D21")
def test_as_printed_a_mesh_must_stay_where_it_is(closed):
    """E78: moved by (10, 10, 10), the same mesh has an error fifteen times as large."""
    pair, basis = closed
    x = pair.domain.vertices
    ours = [np.linalg.norm(y - basis.truncate(y, 30)) for y in (x, x + 10)]
    printed = [np.linalg.norm(y - _printed(pair, 30)(y)) for y in (x, x + 10)]
    assert ours[1] == pytest.approx(ours[0])
    assert printed[0] > 1.5 * ours[0]
    assert printed[1] > 14 * printed[0]


@pytest.mark.chapter("D21", "P66")
def test_it_removes_high_frequencies_and_not_small_coefficients(closed):
    """E86: the largest 60 coefficients are others than the first 60, and do better."""
    pair, basis = closed
    bump = np.exp(-8 * ((pair.domain.vertices - [0, 0, 1]) ** 2).sum(axis=1))
    c = basis.forward(bump)
    linear = pair.norm(bump - basis.truncate(bump, 60))
    best = np.argsort(-np.abs(c))[:60]
    kept = np.isin(np.arange(pair.n), best)
    expected = basis.inverse(np.where(kept, c, 0))
    np.testing.assert_allclose(basis.truncate(bump, 60, largest=True), expected, atol=1e-12)
    assert linear > 1.2 * pair.norm(bump - expected)
    assert (best >= 60).sum() > 5


@pytest.mark.chapter("U35", "P66")
@pytest.mark.parametrize("mass", ["degree", "voronoi", "consistent"])
def test_the_largest_terms_are_the_best_ones(mass):
    """Of any m terms, for each column; every other choice has a larger error."""
    rng = np.random.default_rng(5)
    pair = laplacian(MESHES["closed"](), mass=mass)
    basis = fourier_basis(pair, 120)
    f = np.column_stack([rng.normal(size=pair.n), pair.domain.vertices[:, 0] ** 3])
    decay, linear = basis.error_decay(f, largest=True), basis.error_decay(f)
    assert (decay <= linear * (1 + 1e-12)).all()
    np.testing.assert_allclose(decay[[0, -1]], linear[[0, -1]], rtol=1e-10)
    for m in (0, 1, 7, 50, 120):
        best = basis.truncate(f, m, largest=True)
        for column in range(2):
            error = pair.norm(f[:, column] - best[:, column])
            assert error == pytest.approx(decay[m, column], rel=1e-9)
            c = basis.forward(f[:, column])
            c[rng.permutation(120)[m:]] = 0
            assert error <= pair.norm(f[:, column] - basis.inverse(c)) * (1 + 1e-12)


@pytest.mark.chapter("U35")
@pytest.mark.parametrize("name", IRREGULAR)
@pytest.mark.parametrize("mass", ["degree", "voronoi", "consistent"])
def test_the_error_is_that_of_the_coefficients_left_out(name, mass):
    pair = laplacian(MESHES[name](), mass=mass)
    basis = fourier_basis(pair, pair.n)
    f = np.random.default_rng(2).normal(size=pair.n)
    energy, decay = basis.energy(f), basis.error_decay(f)
    norm = pair.norm(f)
    for m in (0, 1, 17, pair.n - 1):
        direct = pair.norm(f - basis.truncate(f, m)) ** 2
        assert direct == pytest.approx(energy[m:].sum(), rel=1e-11)
        assert decay[m] ** 2 == pytest.approx(direct, rel=1e-11)
        plain = ((f - basis.truncate(f, m)) ** 2).sum()
        assert plain != pytest.approx(energy[m:].sum(), rel=1e-3)  # another norm
    assert decay[0] == pytest.approx(norm)
    assert decay[-1] < 1e-11 * norm
    assert (np.diff(decay) <= 0).all()


@pytest.mark.chapter("P61", "P63")
def test_smooth_functions_decay_fast_and_jumps_slowly():
    """On a surface λ_m ~ m: a jump across a curve gives E ~ m^-½, a crease m^-3/2."""
    mesh = icosphere(3)
    pair = laplacian(mesh)
    basis = fourier_basis(pair, 150)
    height = mesh.vertices @ [0.12, -0.37, 0.92]
    m = np.arange(4, 13) ** 2  # whole degrees of harmonics
    decay = {
        name: basis.error_decay(f)[m] ** 2
        for name, f in {
            "jump": np.sign(height - 0.2),
            "crease": np.abs(height - 0.2),
            "smooth": np.exp(height),
        }.items()
    }
    assert decay_exponent(m, decay["jump"]) == pytest.approx(-0.5, abs=0.12)
    assert decay_exponent(m, decay["crease"]) == pytest.approx(-1.5, abs=0.2)
    assert (decay["smooth"][3:] < 1e-4 * decay["crease"][3:]).all()


@pytest.mark.chapter("P61")
def test_decay_of_the_error_does_not_tell_the_decay_of_the_coefficients(closed):
    """E79: 2^-k at 2^k only: E ~ m^-2 would say m^-3/2 for the coefficients; they are m^-1."""
    pair, basis = closed
    c = np.zeros(pair.n)
    places = 2 ** np.arange(9)
    c[places - 1] = 1.0 / places
    decay = basis.error_decay(basis.inverse(c)) ** 2
    m = places[2:7] - 1
    slope = decay_exponent(m + 1, decay[m])
    assert slope == pytest.approx(-2, abs=0.1)
    promised = (slope - 1) / 2
    assert promised == pytest.approx(-1.5, abs=0.05)
    assert np.abs(c[255]) > 10 * 256.0**promised
    dense = basis.inverse(np.arange(1.0, pair.n + 1) ** -1.5)  # and the direction that holds
    decay = basis.error_decay(dense) ** 2
    m = np.array([8, 16, 32, 64])
    assert decay_exponent(m, decay[m]) == pytest.approx(-2, abs=0.25)  # E ~ m^(1 - 2s)
