"""Section 3.3.3: any weights, and any mass, define a Fourier transform (P57)."""

import numpy as np
import pytest

import dense_oracles as oracle
from beltrami.operators.laplacian import laplacian
from beltrami.operators.pair import INTRINSIC, MASSES, TUFTED
from beltrami.operators.weights import SYMMETRIC_WEIGHTS
from beltrami.spectrum.fourier_basis import fourier_basis
from meshes_of_the_errata import MESHES

pytestmark = pytest.mark.chapter("P57")

KINDS = (*SYMMETRIC_WEIGHTS, INTRINSIC, TUFTED)


@pytest.mark.parametrize("name", ["obt", "open", "bad"])
@pytest.mark.parametrize("kind", [*KINDS, lambda mesh: 1 + np.arange(len(mesh.edges)) % 5])
def test_the_transform_of_any_pair(name, kind):
    mesh = MESHES[name]()
    f, g = oracle.rough_functions(mesh, 2).T
    for mass in MASSES:
        pair = laplacian(mesh, kind, mass)
        basis = fourier_basis(pair, pair.n)
        hat = basis.forward(f)
        assert np.allclose(basis.inverse(hat), f, atol=1e-11)
        assert hat @ hat == pytest.approx(pair.inner(f, f), rel=1e-11)
        assert hat @ basis.forward(g) == pytest.approx(pair.inner(f, g), rel=1e-9, abs=1e-9)
        ones = basis.forward(np.ones(pair.n))
        assert abs(ones[0]) == pytest.approx(np.sqrt(pair.masses.sum()), rel=1e-12)
        assert np.abs(ones[1:]).max() < 1e-10 * ones[0]
        lf = np.linalg.solve(pair.mass.toarray(), pair.stiffness @ f)  # B⁻¹L f
        expected = basis.eigenvalues * hat
        assert np.allclose(basis.forward(lf), expected, atol=1e-10 * np.abs(expected).max())


def test_combinatorial_weights_know_the_topology_only():
    """So coder and decoder of a mesh can both make this basis; the others need the vertices."""
    mesh = MESHES["open"]()
    moved = mesh.with_vertices(mesh.vertices * [1, 2] + 0.1 * np.sin(mesh.vertices[:, ::-1]))
    for kind, same in (("combinatorial", True), ("distance", False), ("cotangent", False)):
        one, other = (fourier_basis(laplacian(m, kind, "degree"), 12) for m in (mesh, moved))
        assert np.allclose(one.eigenvalues, other.eigenvalues, rtol=1e-9) == same
        assert np.allclose(one.eigenvectors, other.eigenvectors, atol=1e-6) == same
    of_faces = fourier_basis(laplacian(mesh.topology), 12).eigenvectors
    of_mesh = fourier_basis(laplacian(mesh, "combinatorial"), 12).eigenvectors
    assert np.allclose(of_faces, of_mesh, atol=1e-6)


def test_the_transforms_differ():
    mesh = MESHES["cur"]()
    f = mesh.vertices[:, 2]
    hats = [
        np.abs(fourier_basis(laplacian(mesh, kind, "degree"), mesh.n_vertices).forward(f))
        for kind in ("combinatorial", "distance", "cotangent")
    ]
    for i in range(3):
        for j in range(i):
            assert np.abs(hats[i] - hats[j]).max() > 0.01 * hats[i].max()
