"""The consistent pair against LaPy's, where it is installed."""

import numpy as np
import pytest

from beltrami.mesh.shapes import blob
from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.fourier_basis import fourier_basis
from meshes_of_the_errata import MESHES

lapy = pytest.importorskip("lapy")


@pytest.mark.chapter("Q3.3", "P35")
@pytest.mark.parametrize("name", ["closed", "obt", "cur", "tor"])
def test_stiffness_and_masses(name):
    mesh = MESHES[name]()
    theirs = lapy.Solver(lapy.TriaMesh(np.array(mesh.vertices), np.array(mesh.faces)))
    pair = laplacian(mesh, mass="consistent")
    assert abs(pair.stiffness - theirs.stiffness).max() < 1e-9 * abs(pair.stiffness).max()
    assert abs(pair.mass - theirs.mass).max() < 1e-9 * abs(pair.mass).max()
    lumped = lapy.Solver(lapy.TriaMesh(np.array(mesh.vertices), np.array(mesh.faces)), lump=True)
    barycentric = laplacian(mesh, mass="barycentric")
    assert abs(barycentric.mass - lumped.mass).max() < 1e-9 * abs(pair.mass).max()


@pytest.mark.chapter("P35")
def test_small_eigenvalues():
    mesh = MESHES["closed"]()
    theirs = lapy.Solver(lapy.TriaMesh(np.array(mesh.vertices), np.array(mesh.faces)))
    values, _ = theirs.eigs(k=10)
    pair = laplacian(mesh, mass="consistent")
    L, B = pair.stiffness.toarray(), pair.mass.toarray()
    root = np.linalg.cholesky(B)
    half = np.linalg.solve(root, np.linalg.solve(root, L).T)
    ours = np.linalg.eigvalsh((half + half.T) / 2)[:10]
    assert np.allclose(ours, values, rtol=1e-5, atol=1e-5)  # theirs are of single precision


@pytest.mark.chapter("P53")
@pytest.mark.parametrize("lump", [True, False])
def test_eigenpairs_of_a_larger_mesh(lump):
    mesh = blob(1500)
    solver = lapy.Solver(lapy.TriaMesh(np.array(mesh.vertices), np.array(mesh.faces)), lump=lump)
    values, vectors = solver.eigs(k=20)
    basis = fourier_basis(laplacian(mesh, mass="barycentric" if lump else "consistent"), 20)
    assert np.allclose(basis.eigenvalues, values, rtol=1e-8, atol=1e-6)
    together = abs(np.asarray(vectors).T @ (basis.mass @ basis.eigenvectors))
    assert np.allclose(np.diag(together), 1, atol=1e-6)  # no two eigenvalues are equal here
