"""Eigenvalues in closed form or from ordinary differential equations, and meshes for them."""

from __future__ import annotations

import numpy as np
import scipy.linalg
from scipy.special import jn_zeros, jnp_zeros

from beltrami.mesh.mesh import Mesh
from beltrami.operators.pair import Laplacian
from beltrami.spectrum.fourier_basis import fourier_basis


def smallest_pairs(
    pair: Laplacian, k: int, hold: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """The k smallest eigenvalues and B-orthonormal eigenvectors, 0 where the mask ``hold`` is."""
    basis = fourier_basis(pair, k, hold=() if hold is None else hold)
    return basis.eigenvalues, basis.eigenvectors


def smallest(pair: Laplacian, k: int, hold: np.ndarray | None = None) -> np.ndarray:
    """The k smallest eigenvalues."""
    return smallest_pairs(pair, k, hold)[0]


# ------------------------------------------------------------------------------ truths


def sphere(k: int) -> np.ndarray:
    """l (l + 1), 2 l + 1 times, of the unit sphere."""
    return np.repeat([d * (d + 1.0) for d in range(k)], [2 * d + 1 for d in range(k)])[:k]


def disk(k: int, boundary: str) -> np.ndarray:
    """Squares of zeros of J_m (Dirichlet), or of J_m' and 0 (Neumann), twice for m >= 1."""
    zeros = jn_zeros if boundary == "dirichlet" else jnp_zeros
    found = [0.0] if boundary == "neumann" else []
    for m in range(k):
        found += list(zeros(m, k) ** 2) * (2 if m else 1)
    return np.sort(found)[:k]


def sums(k: int, one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """The k smallest sums: the spectrum of a product of two."""
    return np.sort(np.add.outer(one, other), axis=None)[:k]


def interval(length: float, left: str, right: str, count: int = 40) -> np.ndarray:
    """(π (i + s) / length)² with s = 0, ½ or 1: Neumann, mixed, Dirichlet ends."""
    held = (left == "dirichlet") + (right == "dirichlet")
    return (np.pi * (np.arange(count) + held / 2) / length) ** 2


def circle(length: float, count: int = 40) -> np.ndarray:
    """(2π i / length)², i = 0, ±1, ±2, ..."""
    return (2 * np.pi * (np.arange(-count, count + 1)) / length) ** 2


def torus_of_revolution(k: int, major: float, minor: float, points: int = 65) -> np.ndarray:
    """By separation: for each m, -(a g')' / (r² a) + m² g / a² = λ g with a = R + r cos v.

    Solved with trigonometric polynomials, exact to rounding for smooth a. Twice for m >= 1.
    """
    v = 2 * np.pi * np.arange(points) / points
    a = major + minor * np.cos(v)
    i = np.arange(points)
    with np.errstate(divide="ignore"):  # differentiation of trigonometric polynomials, odd count
        turn = i[:, None] - i[None, :]
        G = np.where(turn == 0, 0.0, 0.5 * (-1.0) ** turn / np.sin(np.pi * turn / points))
    stiffness, mass = G.T @ np.diag(a) @ G / minor**2, np.diag(a)
    found: list[float] = []
    for m in range(k):
        values = scipy.linalg.eigh(stiffness + m**2 * np.diag(1 / a), mass, eigvals_only=True)
        found += list(values[:k]) * (2 if m else 1)
    return np.sort(found)[:k]


# ------------------------------------------------------------------------------ meshes


def sheared_rectangle(k: int, width: float = 1.0) -> Mesh:
    """The rectangle [0, width] x [0, 1] by (k+1)² vertices at irregular places, exact sides."""
    i, j = np.meshgrid(np.arange(k + 1), np.arange(k + 1))
    x, y = i.ravel() / k, j.ravel() / k
    bulge = 0.1 * np.sin(np.pi * x) * np.sin(np.pi * y)
    at = (j * (k + 1) + i)[:-1, :-1].ravel()
    quads = np.stack([at, at + 1, at + k + 2, at + k + 1], axis=1)
    faces = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return Mesh(np.stack([width * (x + bulge), y - 0.7 * bulge], axis=1), faces)


def sides(mesh: Mesh, width: float = 1.0) -> list[np.ndarray]:
    """Masks of the vertices left, right, below and above on the rectangle [0, width] x [0, 1]."""
    x, y = mesh.vertices.T
    return [x < 1e-9, x > width - 1e-9, y < 1e-9, y > 1 - 1e-9]


def order(errors: list[float], sizes: tuple[float, ...] = (4, 2, 1)) -> float:
    """The slope of the errors against the sizes of the faces, both in logarithms."""
    return float(np.polyfit(np.log(sizes), np.log(errors), 1)[0])
