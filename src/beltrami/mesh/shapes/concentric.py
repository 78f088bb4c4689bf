"""Concentric rings of vertices with different counts, stitched to triangles."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from beltrami._arrays import Floats, Integers


def ring_points(counts: Sequence[int], radii: Sequence[float]) -> Floats:
    """Place rings of evenly spaced points, each from the angle 0 on, counter-clockwise; (n, 2)."""
    rings = []
    for count, radius in zip(counts, radii, strict=True):
        angle = 2 * np.pi * np.arange(count) / count
        rings.append(radius * np.stack([np.cos(angle), np.sin(angle)], axis=1))
    return np.concatenate(rings)


def disk_faces(rings: Sequence[Integers]) -> Integers:
    """Fill a disk whose rings, from the one vertex in the middle outward, have these vertices.

    Examples
    --------
    >>> import numpy as np
    >>> disk_faces([np.array([0]), np.array([1, 2, 3])]).tolist()
    [[0, 1, 2], [0, 2, 3], [0, 3, 1]]
    """
    return np.concatenate([_stitch(rings[k], rings[k + 1]) for k in range(len(rings) - 1)])


def _stitch(inner: Integers, outer: Integers) -> Integers:
    """Go around once, each time one step on the ring whose next side has its middle first."""
    a, b = len(inner), len(outer)
    if a == 1:
        return np.stack([np.repeat(inner, b), outer, np.roll(outer, -1)], axis=1)
    # the middles (2i+1)/(2a) and (2j+1)/(2b), times 2ab: integers, so that ties are no accident
    middles = np.concatenate([(2 * np.arange(a) + 1) * b, (2 * np.arange(b) + 1) * a])
    on_inner = np.argsort(middles, kind="stable") < a
    i: Integers = np.cumsum(on_inner) - on_inner  # steps done before this one
    j: Integers = np.cumsum(~on_inner) - ~on_inner
    third = np.where(on_inner, inner[(i + 1) % a], outer[(j + 1) % b])
    return np.stack([inner[i % a], outer[j % b], third], axis=1)
