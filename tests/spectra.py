"""Bases for the tests of the spectrum, made once, and what must not matter to their users."""

from __future__ import annotations

from functools import cache

import numpy as np

from beltrami.grids.grid import Grid
from beltrami.mesh import shapes
from beltrami.mesh.mesh import Mesh
from beltrami.operators.laplacian import laplacian
from beltrami.operators.pair import Laplacian
from beltrami.spectrum.basis import FourierBasis
from beltrami.spectrum.fourier_basis import fourier_basis
from meshes_of_the_errata import MESHES


@cache
def pair_of(name: str, mass: str = "voronoi") -> Laplacian:
    return laplacian(mesh_of(name), "cotangent", mass)


@cache
def basis_of(name: str, k: int | None = None, mass: str = "voronoi") -> FourierBasis:
    pair = pair_of(name, mass)
    return fourier_basis(pair, pair.n if k is None else k)


@cache
def mesh_of(name: str) -> Mesh:
    """A mesh of the errata, or ``sphere``, ``creature``, ``two`` (a sphere and a torus)."""
    if name == "sphere":
        return shapes.icosphere(3)
    if name == "creature":
        return shapes.blob(700)
    if name == "two":
        return beside(shapes.icosphere(2), shapes.torus(16, 10))
    return MESHES[name]()


@cache
def flat_torus() -> FourierBasis:
    """All modes of an 8 x 6 periodic grid: every vertex is like every other."""
    pair = laplacian(Grid((8, 6)), "dirichlet")
    return fourier_basis(pair, pair.n)


def beside(one: Mesh, two: Mesh) -> Mesh:
    return Mesh(
        np.concatenate([one.vertices, two.vertices + np.array([9, 0, 0])]),
        np.concatenate([one.faces, two.faces + one.n_vertices]),
    )


@cache
def sheet_and_scroll() -> tuple[FourierBasis, FourierBasis]:
    """A flat grid, and the same faces rolled up: an isometry of polyhedra."""
    flat = shapes.grid(9, 14, 2.0, 14 * 2 * np.sin(0.1))
    x, y = flat.vertices.T[:2]
    turn = (y - y.min()) / (2 * np.sin(0.1)) * 0.2  # chords of 0.2 of the unit circle
    scroll = flat.with_vertices(np.column_stack([x, np.cos(turn), np.sin(turn)]))
    return fourier_basis(laplacian(flat), 30), fourier_basis(laplacian(scroll), 30)


def permuted(mesh: Mesh, seed: int = 7) -> tuple[Mesh, np.ndarray]:
    """The same surface with other numbers; new vertex i was vertex order[i]."""
    order = np.random.default_rng(seed).permutation(mesh.n_vertices)
    return Mesh(mesh.vertices[order], np.argsort(order)[mesh.faces]), order


def turned(basis: FourierBasis, seed: int = 5) -> FourierBasis:
    """Other eigenvectors of the same eigenspaces: each is rotated at random, or its sign."""
    rng = np.random.default_rng(seed)
    vectors = basis.eigenvectors.copy()
    values = basis.eigenvalues
    ends = np.flatnonzero(np.diff(values) > 1e-7 * values[-1]) + 1
    for columns in np.split(np.arange(basis.k), ends):
        rotation = np.linalg.qr(rng.normal(size=(len(columns), len(columns))))[0]
        vectors[:, columns] = vectors[:, columns] @ (rotation * rng.choice([-1, 1]))
    return FourierBasis(values.copy(), vectors, basis.mass.copy(), basis.residuals.copy())
