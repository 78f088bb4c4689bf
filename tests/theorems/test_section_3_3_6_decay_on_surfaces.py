"""Coefficients of smooth functions decay with the eigenvalue (l. 644): E84, E85."""

import numpy as np
import pytest

from beltrami.errors import BeltramiError
from beltrami.grids.circle import decay_exponent
from beltrami.mesh.shapes import grid, icosphere
from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.decay import decay_bound
from beltrami.spectrum.fourier_basis import fourier_basis
from beltrami.spectrum.operator import as_operator
from meshes_of_the_errata import IRREGULAR, MESHES

pytestmark = pytest.mark.chapter("U37")


def _moved_back(pair, basis, f, k, sign):
    """Return sign^k λ^-k <Δ^k f, φ>_B, with Δ = -B⁻¹L: the coefficients, if the sign is -1."""
    apply = as_operator(pair)
    for _ in range(k):
        f = -apply(f)
    return sign**k * basis.eigenvalues[1:] ** -float(k) * basis.forward(f)[1:]


@pytest.mark.parametrize("mass", ["voronoi", "degree", "consistent"])
@pytest.mark.parametrize("name", IRREGULAR)
def test_the_operator_moves_over_to_the_eigenvector(name, mass):
    pair = laplacian(MESHES[name](), mass=mass)
    basis = fourier_basis(pair, pair.n)
    f = np.random.default_rng(1).normal(size=pair.n)
    truth = basis.forward(f)[1:]
    for k in (1, 2):
        reached = 1e-13 * (basis.eigenvalues[-1] / basis.eigenvalues[1]) ** k * pair.norm(f)
        np.testing.assert_allclose(_moved_back(pair, basis, f, k, -1), truth, atol=reached)
    assert np.abs(_moved_back(pair, basis, f, 1, 1) - truth).max() > 1e-1 * pair.norm(f) / 10


def test_printed_it_lacks_a_root_of_the_area():
    """E84 on the sphere, f = z: 2.0467 > 1, the printed bound; with √(4π), 3.5449."""
    mesh = icosphere(3)
    pair = laplacian(mesh)
    z = mesh.vertices[:, 2]
    basis = fourier_basis(pair, 16)
    coefficient = np.linalg.norm(basis.forward(z)[1:4])  # z may lie between three of them
    assert coefficient == pytest.approx(2.0467, rel=5e-3)
    printed = np.abs(as_operator(pair)(z)).max() / basis.eigenvalues[1]
    assert printed == pytest.approx(1, rel=0.05)
    assert coefficient > 1.9 * printed
    area = pair.masses.sum()
    assert coefficient <= np.sqrt(area) * printed == pytest.approx(3.5449, rel=0.05)
    assert coefficient <= decay_bound(pair, z, basis.eigenvalues[1:2], 1)[0] * (1 + 1e-3)


@pytest.mark.chapter("P63")
@pytest.mark.parametrize("k", [0, 1, 2])
@pytest.mark.parametrize("name", IRREGULAR)
def test_the_bounds_hold_on_every_mesh(name, k):
    """For each coefficient, and for the error of m terms; attained by eigenvectors."""
    pair = laplacian(MESHES[name]())
    basis = fourier_basis(pair, pair.n)
    values = basis.eigenvalues[1:]
    rng = np.random.default_rng(1)
    f = np.stack([rng.normal(size=pair.n), np.sin(3 * pair.domain.vertices[:, 0])], axis=1)
    bound = decay_bound(pair, f, values, k)
    assert bound.shape == (len(values), 2)
    assert (np.abs(basis.forward(f)[1:]) <= bound * (1 + 1e-9)).all()
    assert (basis.error_decay(f)[1:-1] <= bound * (1 + 1e-9)).all()
    one = basis.eigenvectors[:, 40]
    assert decay_bound(pair, one, values[39:40], k) == pytest.approx(1, rel=1e-6)


def test_a_boundary_stops_the_decay_of_the_smoothest_function():
    """E85: x on a square bends at its ends, so ‖(B⁻¹L)x‖ grows as the mesh is refined."""
    sizes = np.array([8, 16, 32])
    meshes = [grid(n, n) for n in sizes]
    pairs = [laplacian(mesh) for mesh in meshes]
    xs = [mesh.vertices[:, 0] for mesh in meshes]
    growth = {
        name: [
            float(decay_bound(pair, f(x), [1.0], 1)[0]) for pair, x in zip(pairs, xs, strict=True)
        ]
        for name, f in {"x": lambda x: x, "cos": lambda x: np.cos(np.pi * x)}.items()
    }
    assert decay_exponent(sizes, growth["x"]) == pytest.approx(0.5, abs=0.05)
    assert growth["cos"] == pytest.approx([np.pi**2 / np.sqrt(2)] * 3, rel=0.02)
    basis = fourier_basis(pairs[2], 60)
    spaces = np.concatenate([[0], np.cumsum(np.diff(basis.eigenvalues) > 1e-3)])
    energy = np.bincount(spaces, basis.energy(xs[2]))  # waves along x and y are mixed at will
    values = np.bincount(spaces, basis.eigenvalues) / np.bincount(spaces)
    modes = np.flatnonzero(np.sqrt(energy) > 1e-3)[1:]  # those along x, 1, 3, 5 ...
    slope = decay_exponent(values[modes], np.sqrt(energy[modes]))
    assert slope == pytest.approx(-1, abs=0.05)  # λ^-1 = ω^-2, and no better


def test_what_is_refused():
    pair = laplacian(MESHES["closed"]())
    f = np.ones(pair.n)
    assert decay_bound(pair, f, [0.0, 1.0], 1).tolist()[0] == np.inf
    for power in (-1, 0.5, 21):
        with pytest.raises(BeltramiError, match="power"):
            decay_bound(pair, f, [1.0], power)
    for values in ([-1.0], [np.nan], 3.0):
        with pytest.raises(BeltramiError, match="eigenvalues"):
            decay_bound(pair, f, values, 1)
