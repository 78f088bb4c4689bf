"""Where a face touches the front away from its gate: the rare events that cost bits."""

from __future__ import annotations

from typing import Any

from beltrami._jit import plain_kernel
from beltrami.compression.range_coder import DECODING, code_number, code_uniform
from beltrami.compression.tables import whole

_NEAR = 200  # nodes to look at on each side; farther ones are named by their number


@plain_kernel
def find_split(h: int, twins: Any, known: Any, node: Any) -> Any:
    """Return the node that the face of gate h touches, and the unknown faces on its later side.

    The face is left over the side from its tip to the start of the gate, and so on around the
    tip, until the next face is known: that side is a gate.
    """
    fan = 0
    side = h - h % 3 + (h + 2) % 3
    while not known[twins[side] // 3]:
        t = whole(twins[side])
        side = t - t % 3 + (t + 1) % 3
        fan += 1
    return whole(node[side]), fan


@plain_kernel
def code_split(x: int, fan: int, p: int, front: Any, models: Any, state: Any, buffer: Any) -> Any:
    """Write or read the node x that is touched, and the unknown faces on its later side.

    A node is named by its distance along the loop, 2 k forwards and 2 k - 1 backwards, plus one;
    0 stands for a far one, whose number follows. Returns (-1, 0) for what cannot be.
    """
    encoding = state[DECODING] == 0
    code = whole(0)
    if encoding:
        code = _distance(x, p, front)
    code = code_number(code, models[0], state, buffer)
    if code == 0:
        nodes = whole(front.top[front.top.size - 1])
        x = code_uniform(x, nodes, state, buffer)
    elif not encoding:
        x = _at_distance(code, p, front)
    if x < 0 or front.missing[x] < 3:
        return -1, 0
    fan = 1 + code_number(fan - 1, models[1], state, buffer)
    return x, fan


@plain_kernel
def _distance(x: int, p: int, front: Any) -> int:
    """Return the code of the way from p, or from the node after it, to x; 0 if it is long."""
    ahead, back = whole(front.after[p]), p
    for k in range(1, _NEAR):
        ahead, back = whole(front.after[ahead]), whole(front.before[back])
        if back == x:
            return 2 * k
        if ahead == x:
            return 2 * k + 1
    return 0


@plain_kernel
def _at_distance(code: int, p: int, front: Any) -> int:
    """Return the node at the end of a way, -1 if the way is too long."""
    if code < 2 or code >= 2 * _NEAR:
        return -1
    ahead, back = whole(front.after[p]), p
    for _ in range(code // 2):
        ahead, back = whole(front.after[ahead]), whole(front.before[back])
    return ahead if code % 2 else back
