"""Boundary loops: the boundary edges in order, each loop once."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Integers, read_only
from beltrami._jit import kernel
from beltrami.errors import NotManifoldError


def order_boundary(
    faces: Integers, twins: NDArray[np.int32], fan_of_corner: NDArray[np.int32]
) -> tuple[Integers, ...]:
    """Return the vertices of each boundary loop in order, the longest loop first.

    A loop runs in the direction of its first face (so that an oriented surface lies on its left)
    and starts at its smallest vertex. Where several loops meet in one vertex, each keeps to its
    fan of faces. Cost: O(m).

    Chapter items: P10.

    Raises
    ------
    NotManifoldError
        If the boundary runs into an edge of more than two faces: it has no loops then.
    """
    vertices, starts, broken = _walk(faces, twins, fan_of_corner)
    if len(broken):
        raise NotManifoldError(
            "the boundary ends in edges with more than two faces, so it has no loops",
            vertices=np.unique(broken),
            remedy="Split them with repair(mesh, split_non_manifold=True).",
        )
    loops = [
        np.roll(loop, -int(loop.argmin())) for loop in np.split(vertices, starts[1:]) if len(loop)
    ]
    loops.sort(key=lambda loop: (-len(loop), int(loop[0])))
    return tuple(read_only(loop) for loop in loops)


@kernel
def _walk(faces: Any, twins: Any, fan_of_corner: Any) -> Any:
    """Follow the boundary: the next side is the other open end of the fan at the far vertex."""
    m = faces.shape[0]
    ends = np.full((3 * m, 2), -1, np.int32)  # the boundary sides that end each fan
    total = 0
    for f in range(m):
        for c in range(3):
            h = 3 * f + c
            if twins[f, c] == -1 and fan_of_corner[h] >= 0:
                total += 1
                for end in range(1, 3):
                    fan = fan_of_corner[3 * f + (c + end) % 3]
                    ends[fan, 1 if ends[fan, 0] >= 0 else 0] = h
    vertices = np.empty(total, np.int64)
    starts = np.empty(total + 1, np.int64)
    broken = np.empty(total, np.int64)
    done = np.zeros(3 * m, np.bool_)
    placed = loops = failures = 0
    for first in range(3 * m):
        f, c = first // 3, first % 3
        if twins[f, c] != -1 or fan_of_corner[first] < 0 or done[first]:
            continue
        starts[loops] = placed
        loops += 1
        h, at = first, (c + 1) % 3  # the corner of side h where we stand
        while not done[h]:
            done[h] = True
            g, d = h // 3, h % 3
            vertices[placed] = faces[g, at]
            placed += 1
            far = 3 - d - at  # the other end of side h
            fan = fan_of_corner[3 * g + far]
            follower = ends[fan, 0] if ends[fan, 1] == h else ends[fan, 1]
            if follower < 0:
                broken[failures] = faces[g, far]
                failures += 1
                break
            v = faces[g, far]
            g, d = follower // 3, follower % 3
            at = (d + 1) % 3 if faces[g, (d + 1) % 3] == v else (d + 2) % 3
            h = follower
    return vertices[:placed], starts[:loops], broken[:failures]
