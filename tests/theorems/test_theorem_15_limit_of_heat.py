"""Theorem 15: heat tends to the mean of the mass, at the rate exp(-λ_2 t) (E12, E74)."""

import numpy as np
import pytest
from scipy.linalg import eigh

import dense_oracles as oracle
from beltrami.diffusion.heat import heat
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import IRREGULAR, MESHES


def _plain(pair, f):
    return f.mean()


def _by_degree(pair, f):
    return pair.degrees @ f / pair.degrees.sum()


def _by_area(pair, f):
    mesh = pair.domain
    share = np.repeat(oracle.double_areas(mesh)[:, None] / 6, 3, axis=1)
    areas = np.bincount(mesh.faces.ravel(), share.ravel(), pair.n)
    return areas @ f / areas.sum()


def _check_limit(pair, mean):
    """F_t is constant for a long time, and the constant is this mean."""
    f = pair.domain.vertices[:, 0] + oracle.rough_functions(pair.domain, 1)[:, 0] / 2
    far = heat(pair, f, 1e7 if pair.mass_kind == "degree" else 1e4, steps=4)
    assert np.allclose(far, mean(pair, f), atol=1e-4 * np.ptp(f))


CASES = {
    ("combinatorial", "degree"): (_by_degree, (_plain,)),
    ("distance", "degree"): (_by_degree, (_plain, _by_area)),
    ("cotangent", "degree"): (_by_degree, (_plain, _by_area)),
    ("cotangent", "barycentric"): (_by_area, (_plain, _by_degree)),
    ("cotangent", "consistent"): (_by_area, (_plain, _by_degree)),
    ("cotangent", "unit"): (_plain, (_by_degree, _by_area)),
}


@pytest.mark.chapter("T15", "D6")
@pytest.mark.parametrize("case", CASES, ids="-".join)
@pytest.mark.parametrize("name", IRREGULAR)
def test_the_limit_is_the_mean_of_the_mass_and_no_other(name, case):
    pair = laplacian(MESHES[name](), *case)
    right, wrong = CASES[case]
    _check_limit(pair, right)
    _check_limit(pair, lambda pair, f: pair.mean(f))
    for mean in wrong:
        with pytest.raises(AssertionError):
            _check_limit(pair, mean)


@pytest.mark.chapter("T15")
def test_on_a_regular_mesh_the_printed_mean_passes():
    pair = laplacian(MESHES["tor"](), "combinatorial")
    for mean in (_plain, _by_degree):
        _check_limit(pair, mean)


@pytest.mark.chapter("T15", "D17")
@pytest.mark.parametrize("mass", ["degree", "voronoi", "consistent"])
@pytest.mark.parametrize("name", IRREGULAR)
def test_the_rate_is_the_second_eigenvalue(name, mass):
    pair = laplacian(MESHES[name](), "cotangent", mass)
    values, vectors = eigh(pair.stiffness.toarray(), pair.mass.toarray())

    def check(rate):
        second = vectors[:, 1]
        time, steps = 1 / values[1], 500
        left = heat(pair, 3 + second, time, steps=steps) - 3
        assert np.allclose(left, np.exp(-rate * time) * second, atol=2e-3 * np.abs(second).max())

    check(values[1])
    for wrong in (values[2] * 1.05, values[1] / 2, 2 * values[1], -values[1]):
        with pytest.raises(AssertionError):
            check(wrong)


@pytest.mark.chapter("T15", "D17")
@pytest.mark.parametrize("mass", ["degree", "voronoi", "barycentric", "consistent"])
@pytest.mark.parametrize("name", IRREGULAR)
def test_the_integral_is_kept_and_the_energy_falls(name, mass):
    pair = laplacian(MESHES[name](), "cotangent", mass)
    f = oracle.rough_functions(MESHES[name](), 1)[:, 0]
    step = 1 / pair.spectral_bound()
    integrals, energies = [], []
    for k in range(1, 6):
        for method in ("implicit", "explicit"):
            after = heat(pair, f, k * step, method, k)
            integrals.append(pair.masses @ after)
            energies.append((method, k, pair.dirichlet_energy(after)))
            assert abs(after.sum() - f.sum()) > 1e-6 * np.abs(f).sum()  # the plain sum is not
    assert np.allclose(integrals, pair.masses @ f, atol=1e-10 * (pair.masses @ np.abs(f)))
    for method in ("implicit", "explicit"):
        fall = [e for m, _, e in energies if m == method]
        assert (np.diff([pair.dirichlet_energy(f), *fall]) < 0).all()


@pytest.mark.chapter("D17")
@pytest.mark.parametrize("method", ["implicit", "explicit"])
@pytest.mark.parametrize("name", IRREGULAR)
def test_times_add_up(name, method):
    """F_{s+t} from F_s: exact for steps of one length."""
    pair = laplacian(MESHES[name](), "cotangent", "degree")
    f = oracle.rough_functions(MESHES[name](), 1)[:, 0]
    first = heat(pair, f, 0.6, method, 3)
    assert np.allclose(heat(pair, first, 1.0, method, 5), heat(pair, f, 1.6, method, 8), atol=1e-12)
    assert np.array_equal(heat(pair, f, 0.0, method), f)
