"""Theorem 14: averaging tends to the mean weighted by D, if connected and λ_n < 2 (E73, E63)."""

import numpy as np
import pytest
from scipy.sparse import csr_array

import dense_oracles as oracle
from beltrami.diffusion.smoothing import smooth
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import IRREGULAR, MESHES

pytestmark = pytest.mark.chapter("T14")


@pytest.mark.parametrize("name", IRREGULAR)
@pytest.mark.parametrize("kind", ["combinatorial", "distance"])
def test_the_limit_is_the_weighted_mean(name, kind):
    mesh = MESHES[name]()
    f = mesh.vertices[:, 0] + oracle.rough_functions(mesh, 1)[:, 0]
    pair = laplacian(mesh, kind, "degree")
    moduli = np.sort(np.abs(1 - np.linalg.eigvalsh(pair.normalized.toarray())))
    steps = int(np.ceil(np.log(1e-11) / np.log(moduli[-2])))
    limit = smooth(pair, f, steps)
    weighted = (pair.degrees @ f) / pair.degrees.sum()
    assert np.allclose(limit, weighted, atol=1e-9)
    assert pair.mean(f) == pytest.approx(weighted)
    assert abs(f.mean() - weighted) > 1e-3  # printed


def test_with_cotangents():
    mesh = MESHES["closed"]()
    pair = laplacian(mesh, "cotangent", "degree")
    f = oracle.rough_functions(mesh, 1)[:, 0]
    limit = smooth(pair, f, 20_000)
    assert np.allclose(limit, pair.mean(f), atol=1e-9)
    assert abs(f.mean() - pair.mean(f)) > 1e-3


def test_a_regular_mesh_cannot_tell_the_two_means():
    mesh = MESHES["tor"]()
    pair = laplacian(mesh, "combinatorial")
    f = oracle.rough_functions(mesh, 1)[:, 0]
    assert pair.mean(f) == pytest.approx(f.mean())


@pytest.mark.parametrize("name", IRREGULAR)
def test_the_rate_is_the_second_largest_modulus(name):
    mesh = MESHES[name]()
    pair = laplacian(mesh, "combinatorial")
    moduli = np.sort(np.abs(1 - np.linalg.eigvalsh(pair.normalized.toarray())))
    f = oracle.rough_functions(mesh, 1)[:, 0]
    far = [pair.norm(smooth(pair, f, k) - pair.mean(f)) for k in (400, 440)]
    assert (far[1] / far[0]) ** (1 / 40) == pytest.approx(moduli[-2], abs=2e-3)


def test_where_cotangents_vanish_it_jumps_for_ever():
    """λ_n = 2 on the grid of right triangles, which is not two-colourable (E63)."""
    mesh = MESHES["pl"]()
    f = oracle.rough_functions(mesh, 1)[:, 0]
    pair = laplacian(mesh, "cotangent", "degree")
    one, two, three = (smooth(pair, f, 4000 + k) for k in range(3))
    assert np.abs(two - one).max() > 0.01
    assert np.allclose(three, one, atol=1e-9)
    lazy = smooth(pair, f, 4000, 0.5)
    assert np.allclose(lazy, pair.mean(f), atol=1e-9)
    plain = laplacian(mesh, "combinatorial")
    assert np.ptp(smooth(plain, f, 4000)) < 1e-9


@pytest.mark.chapter("R4", "P49")
def test_an_even_cycle_alternates_between_the_means_of_its_two_classes():
    """Remark 4 and theorem 5: bounded at δ = 1, but not convergent (E37, E53)."""
    n = 16
    A = np.eye(n, k=1) + np.eye(n, k=-1)
    A[0, -1] = A[-1, 0] = 1
    pair = laplacian(csr_array(A))
    f = np.random.default_rng(8987551).normal(size=n)
    even, odd = f[::2].mean(), f[1::2].mean()
    limit = smooth(pair, f, 4000)
    assert np.allclose(limit[::2], even, atol=1e-9)
    assert np.allclose(limit[1::2], odd, atol=1e-9)
    assert np.allclose(smooth(pair, f, 4001)[::2], odd, atol=1e-9)
    assert max(np.abs(smooth(pair, f, k)).max() for k in range(50)) <= np.abs(f).max()
    without = f - (even - odd) / 2 * (-1.0) ** np.arange(n)
    assert np.allclose(smooth(pair, without, 4000), f.mean(), atol=1e-9)
    assert np.allclose(smooth(pair, f, 4000, 0.5), f.mean(), atol=1e-9)
