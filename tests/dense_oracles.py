"""Short dense numpy versions of what the library computes, written from the definitions.

Nothing here shares code with the library: cotangents come from angles, energies from gradients.
"""

from __future__ import annotations

import numpy as np

from beltrami.mesh.mesh import Mesh


def angles(mesh: Mesh) -> np.ndarray:
    """(m, 3) angles at the corners, by the arc cosine."""
    p = mesh.vertices[mesh.faces]
    out = []
    for c in range(3):
        u, v = p[:, (c + 1) % 3] - p[:, c], p[:, (c + 2) % 3] - p[:, c]
        cosine = (u * v).sum(1) / np.linalg.norm(u, axis=1) / np.linalg.norm(v, axis=1)
        out.append(np.arccos(cosine))
    return np.stack(out, axis=1)


def double_areas(mesh: Mesh) -> np.ndarray:
    """(m,) twice the areas, by Heron's formula."""
    p = mesh.vertices[mesh.faces]
    a, b, c = (np.linalg.norm(p[:, (k + 1) % 3] - p[:, (k + 2) % 3], axis=1) for k in range(3))
    s = (a + b + c) / 2
    return 2 * np.sqrt(s * (s - a) * (s - b) * (s - c))


def weights(mesh: Mesh, kind: str, apex: str = "opposite") -> np.ndarray:
    """Dense W; ``apex="printed"`` takes the cotangent at x_j instead of opposite (E17)."""
    n = mesh.n_vertices
    W = np.zeros((n, n))
    cot = 1 / np.tan(angles(mesh))
    for f, face in enumerate(mesh.faces):
        for c in range(3):
            i, j = face[(c + 1) % 3], face[(c + 2) % 3]
            if kind == "cotangent" and apex == "opposite":
                W[i, j] += cot[f, c] / 2
                W[j, i] += cot[f, c] / 2
            elif kind == "cotangent":
                W[i, j] += cot[f, (c + 2) % 3] / 2
                W[j, i] += cot[f, (c + 1) % 3] / 2
            else:
                squared = ((mesh.vertices[i] - mesh.vertices[j]) ** 2).sum()
                W[i, j] = W[j, i] = 1.0 if kind == "combinatorial" else 1 / squared
    return W


def masses(mesh: Mesh, kind: str, W: np.ndarray) -> np.ndarray:
    """Dense B."""
    n = mesh.n_vertices
    if kind == "degree":
        return np.diag(W.sum(axis=1))
    if kind == "unit":
        return np.eye(n)
    B = np.zeros((n, n))
    area, at = double_areas(mesh) / 2, angles(mesh)
    p = mesh.vertices[mesh.faces]
    for f, face in enumerate(mesh.faces):
        if kind == "consistent":
            B[np.ix_(face, face)] += area[f] / 12 * (1 + np.eye(3))
            continue
        for c in range(3):
            obtuse = at[f].max() > np.pi / 2
            if kind == "barycentric":
                share = area[f] / 3
            elif kind == "voronoi" and obtuse:
                share = area[f] / (2 if at[f, c] > np.pi / 2 else 4)
            else:  # the signed triangles between corner, middle of a side and circumcentre
                share = 0.0
                for d in ((c + 1) % 3, (c + 2) % 3):
                    third = 3 - c - d
                    side = ((p[f, c] - p[f, d]) ** 2).sum()
                    share += side / np.tan(at[f, third]) / 8
            B[face[c], face[c]] += share
    return B


def stiffness(W: np.ndarray) -> np.ndarray:
    return np.diag(W.sum(axis=1)) - W


def dirichlet_energy(mesh: Mesh, f: np.ndarray) -> float:
    """∫|∇f|² of the linear interpolant, face by face: area times d' Gram⁻¹ d."""
    total = 0.0
    for face, double in zip(mesh.faces, double_areas(mesh), strict=True):
        x, values = mesh.vertices[face], f[face]
        sides, d = x[1:] - x[0], values[1:] - values[0]
        total += double / 2 * d @ np.linalg.solve(sides @ sides.T, d)
    return float(total)


def spectrum(L: np.ndarray, B: np.ndarray) -> np.ndarray:
    """Ascending eigenvalues of the pair."""
    root = np.linalg.cholesky(B)
    half = np.linalg.solve(root, L)
    return np.linalg.eigvalsh(np.linalg.solve(root, half.T))


def rough_functions(mesh: Mesh, c: int = 3) -> np.ndarray:
    """(n, c) rough functions, the same at each call."""
    return np.random.default_rng(271828182).normal(size=(mesh.n_vertices, c))
