"""Symmetric positive definite matrices of every shape that has ever broken a sparse solver."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from hypothesis import strategies as st
from scipy.sparse import (
    block_diag,
    csc_array,
    csr_array,
    diags_array,
    eye_array,
    kron,
    random_array,
)

from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import MESHES


def path(n: int) -> csr_array:
    return csr_array(
        diags_array([np.full(n, 2.0), -np.ones(n - 1), -np.ones(n - 1)], offsets=[0, 1, -1])
    )


def grid(rows: int, columns: int) -> csr_array:
    """The five-point Laplacian with values held at zero around, plus a little mass."""
    one, two = eye_array(rows), eye_array(columns)
    return csr_array(
        kron(path(rows), two) + kron(one, path(columns)) + 0.01 * eye_array(rows * columns)
    )


def arrow(n: int) -> csr_array:
    """Everybody is a neighbour of the first only."""
    A = np.eye(n) * 2.0
    A[0, :] = A[:, 0] = 1.0
    A[0, 0] = 2.0 * n
    return csr_array(A)


def dense(rng: np.random.Generator, n: int) -> csr_array:
    X = rng.normal(size=(n, n))
    return csr_array(X @ X.T + n * np.eye(n))


def scattered(rng: np.random.Generator, n: int) -> csr_array:
    """Random neighbours, dominant diagonal."""
    X = random_array((n, n), density=min(1.0, 3 / n), rng=rng)
    S = csr_array(X + X.T)
    return csr_array(S + diags_array(np.asarray(abs(S).sum(axis=1)) + 0.1))


def pieces(rng: np.random.Generator, n: int) -> csr_array:
    """Several components of different sizes, some of one unknown, shuffled."""
    parts = [grid(5, 9), path(40), arrow(11), eye_array(7) * 3, dense(rng, 6), path(1)]
    A = csr_array(block_diag(parts))
    order = rng.permutation(A.shape[0])
    return csr_array(A[order][:, order])


def rescaled(rng: np.random.Generator, n: int) -> csr_array:
    """Entries from 1e-12 to 1e12, by units that differ."""
    units = diags_array(10.0 ** rng.uniform(-6, 6, n))
    A = scattered(rng, n)
    return csr_array(units @ A @ units)


def mesh_pair(name: str, shift: float) -> csr_array:
    pair = laplacian(MESHES[name](), mass="degree")
    return csr_array(pair.stiffness + shift * pair.mass)


NAMED: dict[str, Callable[[], csr_array]] = {
    "one": lambda: csr_array([[3.0]]),
    "two": lambda: csr_array([[2.0, 1.0], [1.0, 2.0]]),
    "three": lambda: csr_array([[4.0, 1, 0], [1, 3, 1], [0, 1, 5]]),
    "path": lambda: path(500),
    "grid": lambda: grid(23, 31),
    "strip": lambda: grid(2, 400),
    "arrow": lambda: arrow(150),
    "dense": lambda: dense(np.random.default_rng(1729), 120),
    "identity": lambda: csr_array(eye_array(200)),
    "pieces": lambda: pieces(np.random.default_rng(24601), 0),
    "scattered": lambda: scattered(np.random.default_rng(8675309), 300),
    "units": lambda: rescaled(np.random.default_rng(602214), 200),
    "nearly singular": lambda: mesh_pair("closed", 1e-10),
    "bad": lambda: mesh_pair("bad", 0.1),
    "obt": lambda: mesh_pair("obt", 1.0),
    "tor": lambda: mesh_pair("tor", 1e-3),
}


@st.composite
def definite_matrices(draw: st.DrawFn) -> csr_array:
    """Draw a matrix of 1 to 90 unknowns, shuffled."""
    rng = np.random.default_rng(draw(st.integers(0, 2**63 - 1)))
    n = draw(st.integers(1, 90))
    kind = draw(st.sampled_from(("scattered", "dense", "arrow", "grid", "units", "identity")))
    A = {
        "scattered": lambda: scattered(rng, n),
        "dense": lambda: dense(rng, n),
        "arrow": lambda: arrow(n),
        "grid": lambda: grid(1 + n % 9, 1 + n // 9),
        "units": lambda: rescaled(rng, n),
        "identity": lambda: csr_array(eye_array(n)),
    }[kind]()
    order = rng.permutation(A.shape[0])
    return csr_array(csr_array(A)[order][:, order])


def as_columns(A: csr_array) -> csc_array:
    matrix = csc_array(A, dtype=np.float64)
    matrix.sum_duplicates()
    return matrix
