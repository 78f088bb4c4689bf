"""Blending of guesses: weights that follow what would have been right, by recursive least squares.

There is a slow and a fast memory, and one set of weights for each class of vertices.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltrami._jit import plain_kernel

MEANS = 6  # slow blend, fast blend, parallelogram, trusted one, last Laplacian, first parallelogram
CLASSES = 4
_SLOW, _FAST = 0.9998, 0.995
_START = 0.3
_FARTHEST = 1e13


class Blend(NamedTuple):
    """What is known of vertices, and learned from them.

    Attributes
    ----------
    error : (n, MEANS) float64
        Mean error of each prediction at each vertex.
    residual : (n, 3) float64
        The error of the slow blend, with its direction.
    level : (n,) int8
        The class of each vertex, -1 before it is known.
    typical : (MEANS, CLASSES) float64
        Mean error of each prediction in each class.
    variance : (CLASSES, 3) float64
        Variance along the frame, relative to the local scale.
    weights, inverse : (2, CLASSES, k), (2, CLASSES, k, k) float64
        Of the least squares.
    guesses, steps : (k + 1, 3), (3, k) float64
        The guesses at a vertex, and how far they are from the first one.
    gain : (k,) float64
        Scratch of the least squares.
    means : (MEANS, 3) float64
        The predictions at a vertex.
    scale : (MEANS,) float64
        How wrong each of them may be there.
    """

    error: NDArray[np.float64]
    residual: NDArray[np.float64]
    level: NDArray[np.int8]
    typical: NDArray[np.float64]
    variance: NDArray[np.float64]
    weights: NDArray[np.float64]
    inverse: NDArray[np.float64]
    guesses: NDArray[np.float64]
    steps: NDArray[np.float64]
    gain: NDArray[np.float64]
    means: NDArray[np.float64]
    scale: NDArray[np.float64]


def new_blend(n: int, solves: int) -> Blend:
    """Know nothing of n vertices, of which ``solves`` + 2 guesses will be made."""
    k = solves + 1
    blend = Blend(
        np.zeros((n, MEANS)),
        np.zeros((n, 3)),
        np.full(n, -1, np.int8),
        np.full((MEANS, CLASSES), 4.0),
        np.ones((CLASSES, 3)),
        np.zeros((2, CLASSES, k)),
        np.zeros((2, CLASSES, k, k)),
        np.zeros((k + 1, 3)),
        np.zeros((3, k)),
        np.zeros(k),
        np.zeros((MEANS, 3)),
        np.zeros(MEANS),
    )
    for a in range(2):
        for c in range(CLASSES):
            forget(a, c, blend)
    return blend


@plain_kernel
def forget(a: int, c: int, blend: Any) -> None:
    """Begin the least squares of one memory and class anew."""
    k = blend.weights.shape[2]
    blend.weights[a, c] = 0.0
    blend.weights[a, c, k - 1] += 0.5
    blend.weights[a, c, min(1, k - 1)] += 0.5
    blend.inverse[a, c] = 0.0
    for i in range(k):
        blend.inverse[a, c, i, i] = _START


@plain_kernel
def predict(c: int, blend: Any) -> None:
    """Blend the guesses for a vertex of class c: fill ``steps`` and ``means``."""
    f, means = blend.guesses, blend.means
    k = f.shape[0] - 1
    for q in range(3):
        for z in range(k):
            blend.steps[q, z] = f[z + 1, q] - f[0, q]
        for a in range(2):
            s = f[0, q]
            for z in range(k):
                s += blend.weights[a, c, z] * blend.steps[q, z]
            means[a, q] = s
        means[2, q], means[3, q] = f[0, q], f[1, q]
        means[4, q], means[5, q] = f[min(5, k), q], f[2, q]
        for a in range(MEANS):
            if not abs(means[a, q]) < _FARTHEST:
                means[a, q] = 0.0


@plain_kernel
def learn(c: int, x: Any, blend: Any) -> None:
    """Learn from the true position of a vertex of class c."""
    weight = 1.0 / (blend.scale[0] * blend.scale[0] + 0.3)
    for a in range(2):
        memory = _SLOW if a == 0 else _FAST
        for q in range(3):
            _recurse(a, c, q, weight, memory if q == 0 else 1.0, x[q], blend)
        trace = 0.0
        for z in range(blend.weights.shape[2]):
            trace += blend.inverse[a, c, z, z]
        if not 0.0 <= trace < 1e6:
            forget(a, c, blend)
        elif trace > 50.0:
            _halve(blend.inverse[a, c])


@plain_kernel
def _halve(P: Any) -> None:
    for z in range(P.shape[0]):
        for y in range(P.shape[1]):
            P[z, y] *= 0.5


@plain_kernel
def _recurse(
    a: int, c: int, q: int, weight: float, memory: float, truth: float, blend: Any
) -> None:
    """One step of recursive least squares, for one coordinate."""
    w, P, d = blend.weights[a, c], blend.inverse[a, c], blend.steps[q]
    g, k = blend.gain, d.size
    error = truth - blend.guesses[0, q]
    energy = 0.0
    for z in range(k):
        error -= w[z] * d[z]
        s = 0.0
        for y in range(k):
            s += P[z, y] * d[y]
        g[z] = s
    for z in range(k):
        energy += d[z] * g[z]
    share = memory + weight * energy
    for z in range(k):
        w[z] += weight * g[z] / share * error
        if not abs(w[z]) < 1e6:
            w[z] = 0.0
    for z in range(k):
        for y in range(k):
            P[z, y] = (P[z, y] - weight * g[z] * g[y] / share) / memory


@plain_kernel
def note(v: int, c: int, x: Any, axes: Any, blend: Any) -> None:
    """Note how wrong the predictions were at v."""
    blend.level[v] = c
    for a in range(MEANS):
        s = 0.0
        for q in range(3):
            s += abs(x[q] - blend.means[a, q])
        blend.error[v, a] = s / 3
        typical = blend.typical[a, c]
        blend.typical[a, c] = max(typical + (s / 3 - typical) * 0.02, 0.02)
    unit = blend.scale[0] * blend.scale[0] + 0.05
    for q in range(3):
        blend.residual[v, q] = x[q] - blend.means[0, q]
    for a in range(3):
        z = 0.0
        for q in range(3):
            z += axes[a, q] * blend.residual[v, q]
        blend.variance[c, a] += (min(z * z / unit, 30.0) - blend.variance[c, a]) * 0.01
