"""Positions on a grid: guess, blend, and code what is left, vertex after vertex."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltrami._jit import plain_kernel
from beltrami.compression.blending import CLASSES, MEANS, Blend, learn, new_blend, note, predict
from beltrami.compression.guesses import frame, guess
from beltrami.compression.patches import Patch, gather, new_patch
from beltrami.compression.range_coder import DECODING
from beltrami.compression.residuals import (
    LAPLACE,
    LOGISTIC,
    Opinions,
    code_near,
    new_opinions,
)
from beltrami.compression.tables import whole

_FIRST = 16  # the spread of a number of which nothing is known
DEAD_ZONE = 0.6  # numbers from the blend below that are 0
_ROOT = 1.4142135623730951


class Coder(NamedTuple):
    """All that the coding of positions knows and learns.

    Attributes
    ----------
    x : (n, 3) float64
        The positions, whole numbers, as far as they are known.
    truth : (n, 3) or (0, 3) float64
        With n rows, positions are not whole numbers but whole numbers from the slow blend: the
        nearest to these when writing. Without, they are the whole numbers themselves.
    most : (1,) float64
        How far off, squared, positions may become for the sake of residuals that are 0.
    known : (n,) bool
        Which they are.
    covariance : (2, 3, 3) float64
        Of the slow blend at a vertex: of its class, and of its surroundings.
    axes, mean : (3, 3), (3,) float64
        The frame at a vertex, and the mean of its known neighbours.
    """

    x: NDArray[np.float64]
    truth: NDArray[np.float64]
    most: NDArray[np.float64]
    known: NDArray[np.bool_]
    covariance: NDArray[np.float64]
    axes: NDArray[np.float64]
    mean: NDArray[np.float64]
    patch: Patch
    blend: Blend
    opinions: Opinions


def new_coder(n: int, solves: int, truth: NDArray[np.float64], most: float = np.inf) -> Coder:
    """Prepare to code n positions with so many solves for each."""
    return Coder(
        np.zeros((n, 3)),
        truth,
        np.array([most]),
        np.zeros(n, np.bool_),
        np.zeros((2, 3, 3)),
        np.zeros((3, 3)),
        np.zeros(3),
        new_patch(n),
        new_blend(n, solves),
        new_opinions(),
    )


@plain_kernel
def code_positions(
    numbers: Any, order: Any, first: int, last: int, solves: Any, near: Any, coder: Any,
    state: Any, buffer: Any,
) -> None:  # fmt: skip
    """Write or read ``numbers`` (n, 3) int64 at order[first:last]."""
    blend = coder.blend
    for i in range(first, last):
        v = whole(order[i])
        before = whole(order[i - 1]) if i else v
        count = guess(
            v, before, solves, near, coder.known, coder.patch, coder.x, blend.error[:, 2],
            coder.mean, blend.guesses,
        )  # fmt: skip
        c = min(count, CLASSES - 1)
        predict(c, blend)
        vertices = gather_known(v, c, near, coder)
        frame(v, near, coder.known, coder.x, blend.means[0], coder.mean, coder.axes)
        _spread(c, vertices, coder)
        _code_vertex(v, c, i, numbers, coder, state, buffer)
        learn(c, coder.x[v], blend)
        note(v, c, coder.x[v], coder.axes, blend)
        coder.known[v] = True


@plain_kernel
def _trust(j: int, u: int, c: int, coder: Any) -> float:
    """Return how much the errors at the place j of the patch say about its middle."""
    if j < coder.patch.ends[1]:
        return 1.0
    return 0.7 if coder.blend.level[u] == c else 0.35


@plain_kernel
def gather_known(v: int, c: int, near: Any, coder: Any) -> int:
    """Collect two rings around v, and write the scales of the predictions there."""
    blend, patch = coder.blend, coder.patch
    gather(v, 2, near, coder.known, patch)
    size = whole(patch.ends[2])
    for a in range(MEANS):
        s = total = 1.0
        for j in range(1, size):
            u = patch.vertices[j]
            if coder.known[u]:
                w = _trust(j, u, c, coder)
                s += w * blend.error[u, a] / blend.typical[a, blend.level[u]]
                total += w
        blend.scale[a] = blend.typical[a, c] * s / total
    return size


@plain_kernel
def _spread(c: int, size: int, coder: Any) -> None:
    """Write the covariances of the slow blend: of the class along the frame, and of the ring."""
    blend, C, axes = coder.blend, coder.covariance, coder.axes
    unit = blend.scale[0] * blend.scale[0] + 0.05
    for a in range(3):
        for b in range(3):
            z = 0.0
            for q in range(3):
                z += axes[q, a] * axes[q, b] * blend.variance[c, q]
            C[0, a, b] = C[1, a, b] = z * unit
    total = 1.0
    for j in range(1, size):
        u = coder.patch.vertices[j]
        if not coder.known[u]:
            continue
        w = _trust(j, u, c, coder)
        total += w
        ratio = blend.typical[0, c] / blend.typical[0, blend.level[u]]
        w *= ratio * ratio
        for a in range(3):
            for b in range(3):
                C[1, a, b] += w * blend.residual[u, a] * blend.residual[u, b]
    for a in range(3):
        for b in range(3):
            C[1, a, b] /= total
        C[0, a, a] += 0.1
        C[1, a, a] += 0.1


@plain_kernel
def _condition(h: int, q: int, e0: float, e1: float, C: Any) -> Any:
    """Return (shift, variance) of coordinate q when the errors of those before are known."""
    variance = C[h, q, q]
    shift = 0.0
    if q == 1:
        g = C[h, 1, 0] / C[h, 0, 0]
        shift, variance = g * e0, variance - g * C[h, 1, 0]
    elif q == 2:
        det = C[h, 0, 0] * C[h, 1, 1] - C[h, 0, 1] * C[h, 0, 1]
        c0, c1 = C[h, 2, 0], C[h, 2, 1]
        g0 = (c0 * C[h, 1, 1] - c1 * C[h, 0, 1]) / det
        g1 = (c1 * C[h, 0, 0] - c0 * C[h, 0, 1]) / det
        shift, variance = g0 * e0 + g1 * e1, variance - g0 * c0 - g1 * c1
    if not abs(shift) < 1e13:
        shift = 0.0
    if not 0.02 < variance < 1e26:
        variance = 0.02
    return shift, variance


@plain_kernel
def level(x: float) -> int:
    """Return 2 log2(1 + 4 x), rounded down and at most 15."""
    y, power, k = 1.0 + 4.0 * x, 1.0, 0
    while k < 15:
        following = power * _ROOT if k % 2 == 0 else power / _ROOT * 2.0
        if y < following:
            break
        power = following
        k += 1
    return k


@plain_kernel
def _write(e: int, middle: float, scale: float, shape: int, opinions: Any) -> None:
    opinions.middle[e], opinions.sharpness[e], opinions.shape[e] = middle, 1.0 / scale, shape


@plain_kernel
def _form_opinions(q: int, e0: float, e1: float, coder: Any) -> Any:
    """Write the distributions of coordinate q; return the middle and the scale to begin with."""
    blend, opinions = coder.blend, coder.opinions
    means, scale = blend.means, blend.scale
    for a in range(MEANS):
        _write(a, means[a, q], 0.25 + 0.9 * scale[a], LAPLACE, opinions)
    _write(3, means[3, q], 0.15 + 0.4 * scale[3], LAPLACE, opinions)
    middle = spread = 0.0
    for h in range(2):
        shift, variance = _condition(h, q, e0, e1, coder.covariance)
        deviation = np.sqrt(variance)
        middle, spread = means[0, q] + shift, deviation * 0.5 + 0.05
        _write(6 + h, middle, spread, LOGISTIC, opinions)
        _write(8 + h, middle, deviation * 0.6 + 0.05, LAPLACE, opinions)
    _write(10, 0.5 * (middle + means[1, q]), 0.2 + 0.8 * scale[1], LOGISTIC, opinions)
    k = opinions.context
    k[0], k[1] = level(spread), q
    k[5] = level(scale[2]) * 8
    k[6] = level(scale[3]) * 8 + _apart(means[3, q], middle)
    k[7] = _apart(means[0, q], means[2, q]) * 16 + level(scale[4])
    return middle, spread * 1.6


@plain_kernel
def _apart(a: float, b: float) -> int:
    """Return the distance of two predictions in half steps, at most 7."""
    return whole(min(abs(a - b) * 2.0, 7.0))


@plain_kernel
def _nearest(x: float, zone: float) -> int:
    """Round to a whole number, and what is nearer than ``zone`` to 0."""
    return whole(0) if abs(x) < zone else whole(np.floor(x + 0.5))


@plain_kernel
def _zone(v: int, coder: Any) -> float:
    """Return below what the residuals at v become 0: a little more than half costs less.

    Half, where v would be too far off otherwise.
    """
    total = 0.0
    for q in range(3):
        x = coder.truth[v, q] - coder.blend.means[0, q]
        away = x - _nearest(x, DEAD_ZONE)
        total += away * away
    return DEAD_ZONE if total <= coder.most[0] else 0.5


@plain_kernel
def _code_vertex(v: int, c: int, i: int, numbers: Any, coder: Any, state: Any, buffer: Any) -> None:
    """Write or read the three numbers of a vertex."""
    opinions = coder.opinions
    k = opinions.context
    k[2], k[3], k[4] = c, 0, 0
    e0 = e1 = 0.0
    writes = coder.truth.shape[0] > 0 and state[DECODING] == 0
    zone = _zone(v, coder) if writes else 0.5
    for q in range(3):
        middle, scale = _form_opinions(q, e0, e1, coder)
        base = 0.0
        if coder.truth.shape[0]:
            base = coder.blend.means[0, q]
            middle -= base
            for e in range(opinions.middle.size):
                opinions.middle[e] -= base
            if writes:
                numbers[v, q] = _nearest(coder.truth[v, q] - base, zone)
        if i < 3:
            scale = max(scale, float(1 << _FIRST))
        x = code_near(numbers[v, q], middle, scale, opinions, state, buffer)
        numbers[v, q] = x
        coder.x[v, q] = base + x
        nearest = whole(np.floor(middle + 0.5))
        away = abs(x - nearest)
        k[4] = k[3]
        k[3] = min(7, 2 * away // (1 + whole(scale)) if scale > 2.0 and q else away)
        e1 = coder.x[v, q] - coder.blend.means[0, q]
        if q == 0:
            e0 = e1
