"""Connectivity: faces are conquered one by one, valences and rare splits are all that is coded.

After Touma and Gotsman (1998), with the pivot of Alliez and Desbrun (2001): the front turns about
the vertex that lacks the fewest faces. The next face there has a new vertex, whose valence is
coded, or closes the fan, which is known from the valence; else it touches the front elsewhere.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltrami._jit import plain_kernel
from beltrami.compression.front import Front, add, drop, link, lower, new_front, pivot
from beltrami.compression.range_coder import DECODING, ran_dry
from beltrami.compression.splits import code_split, find_split
from beltrami.compression.tables import whole
from beltrami.compression.valences import Valences, code_is_new, code_valence, new_valences

# How a conquest ends.
DONE, TOO_MANY_FACES, TOO_MANY_VERTICES, NOT_CLOSED, BAD_SPLIT, ENDS_EARLY = range(6)


class Surface(NamedTuple):
    """What is conquered; the encoder knows all of it, the decoder fills it.

    Attributes
    ----------
    faces : (m, 3) int32
        The faces, in the order of the encoder's mesh.
    twins : (3m,) int32
        The half-edge on the other side of each; only the encoder's.
    known : (m,) uint8
        Whether a face is conquered; only the encoder's.
    number : (n,) int32
        The new number of each vertex, -1 before; only the encoder's.
    node : (3m,) int32
        The node at the start of each half-edge that is a gate; only the encoder's.
    conquered : (m, 3) int32
        The faces in the new order, with the new numbers.
    source : (m,) int32
        The old number of each of them; only the encoder's.
    """

    faces: NDArray[np.int32]
    twins: NDArray[np.int32]
    known: NDArray[np.uint8]
    number: NDArray[np.int32]
    node: NDArray[np.int32]
    conquered: NDArray[np.int32]
    source: NDArray[np.int32]


class Conquest(NamedTuple):
    """The state of a conquest.

    ``counts`` are the numbers of faces and of vertices so far, ``start`` is scratch.
    """

    front: Front
    valences: Valences
    counts: NDArray[np.int64]
    splits: NDArray[np.int64]
    start: NDArray[np.int64]


def new_conquest(faces: int, vertices: int) -> Conquest:
    """Prepare to conquer so many faces with so many vertices."""
    return Conquest(
        new_front(vertices + faces),
        new_valences(vertices),
        np.zeros(2, np.int64),
        np.full((2, 128), 1 << 15, np.int64),
        np.zeros((2, 3), np.int64),
    )


@plain_kernel
def conquer(surface: Any, conquest: Any, valence: Any, state: Any, buffer: Any) -> int:
    """Write the connectivity of ``surface``, or read it; return how it ended.

    ``valence`` (n,) are the encoder's numbers of faces around each vertex, by old numbers.
    """
    m = surface.conquered.shape[0]
    counts = conquest.counts
    seed = 0
    while counts[0] < m:
        if state[DECODING] == 0:
            while surface.known[seed]:
                seed += 1
        status = _start(seed, surface, conquest, valence, state, buffer)
        while status == DONE:
            p = pivot(conquest.front)
            if p < 0:
                break
            if counts[0] == m:
                return TOO_MANY_FACES
            if ran_dry(state, buffer):
                return ENDS_EARLY
            if conquest.front.missing[p] == 1:
                status = _close(p, surface, conquest)
            else:
                status = _advance(p, surface, conquest, valence, state, buffer)
        if status != DONE:
            return status
    return DONE


@plain_kernel
def _new_vertex(
    old: int, p: int, surface: Any, conquest: Any, valence: Any, state: Any, buffer: Any
) -> int:
    """Give a vertex a number, and code its valence; return the number, -1 if none is left."""
    v = conquest.counts[1]
    if v == conquest.valences.known.size:
        return -1
    conquest.counts[1] = v + 1
    value = whole(0)
    if state[DECODING] == 0:
        surface.number[old] = v
        value = whole(valence[old])
    conquest.valences.known[v] = code_valence(
        value, p, conquest.front, conquest.valences, state, buffer
    )
    return v


@plain_kernel
def _start(f: int, surface: Any, conquest: Any, valence: Any, state: Any, buffer: Any) -> int:
    """Begin a component with the face f of three new vertices."""
    front = conquest.front
    encoding = state[DECODING] == 0
    made, nodes = conquest.start[0], conquest.start[1]
    for c in range(3):
        old = whole(surface.faces[f, c]) if encoding else 0
        made[c] = _new_vertex(old, -1, surface, conquest, valence, state, buffer)
        if made[c] < 0:
            return TOO_MANY_VERTICES
    for c in range(3):
        missing = conquest.valences.known[made[c]] - 1
        gate = whole(surface.twins[3 * f + (c + 1) % 3]) if encoding else 0
        nodes[c] = add(front, made[c], missing, gate, made[(c + 1) % 3])
        if encoding:
            surface.node[gate] = nodes[c]
    for c in range(3):
        link(front, nodes[c], nodes[(c + 2) % 3])
    _note(f, made[0], made[1], made[2], surface, conquest)
    return DONE


@plain_kernel
def _note(f: int, a: int, b: int, c: int, surface: Any, conquest: Any) -> None:
    """Write down a conquered face."""
    i = conquest.counts[0]
    conquest.counts[0] = i + 1
    surface.conquered[i, 0], surface.conquered[i, 1], surface.conquered[i, 2] = a, b, c
    if surface.known.size:
        surface.known[f], surface.source[i] = 1, f


@plain_kernel
def _side(h: int, k: int) -> int:
    """Return the side that comes k sides after the half-edge h in its face."""
    return h - h % 3 + (h + k) % 3


@plain_kernel
def _close(p: int, surface: Any, conquest: Any) -> int:
    """Conquer the last face at a node: it has the two neighbours of the node."""
    front = conquest.front
    q, b = whole(front.before[p]), whole(front.after[p])
    h = whole(front.gate[p])
    if q == b:
        return NOT_CLOSED
    three = front.after[b] == q  # nodes in the loop
    all_three = three and front.missing[q] == 1 and front.missing[b] == 1
    if not all_three and (front.missing[q] < 2 or front.missing[b] < 2):
        return NOT_CLOSED
    _note(h // 3, front.vertex[q], front.vertex[p], front.vertex[b], surface, conquest)
    drop(front, p)
    if all_three:
        drop(front, q)
        drop(front, b)
        return DONE
    lower(front, q, front.missing[q] - 1)
    lower(front, b, front.missing[b] - 1)
    front.behind[q] = front.vertex[p]
    link(front, q, b)
    if surface.known.size:
        _set_gate(q, surface.twins[_side(h, 1)], surface, conquest)
    return DONE


@plain_kernel
def _set_gate(x: int, gate: int, surface: Any, conquest: Any) -> None:
    conquest.front.gate[x] = gate
    surface.node[gate] = x


@plain_kernel
def _advance(p: int, surface: Any, conquest: Any, valence: Any, state: Any, buffer: Any) -> int:
    """Conquer the face at the side after a node: its tip is new, or elsewhere on the front."""
    front = conquest.front
    encoding = state[DECODING] == 0
    h = whole(front.gate[p])
    tip = whole(surface.faces[h // 3, h % 3]) if encoding else 0
    is_new = 1 if encoding and surface.number[tip] < 0 else 0
    is_new = code_is_new(is_new, p, front, conquest.valences, state, buffer)
    if not is_new:
        return _split(p, surface, conquest, state, buffer)
    v = _new_vertex(tip, p, surface, conquest, valence, state, buffer)
    if v < 0:
        return TOO_MANY_VERTICES
    b = whole(front.after[p])
    if front.missing[b] < 2:
        return NOT_CLOSED
    _note(h // 3, v, front.vertex[p], front.vertex[b], surface, conquest)
    x = add(front, v, conquest.valences.known[v] - 1, 0, front.vertex[p])
    link(front, p, x)
    link(front, x, b)
    _lower_ends(p, b, conquest.front)
    if encoding:
        _set_gate(x, surface.twins[_side(h, 1)], surface, conquest)
        _set_gate(p, surface.twins[_side(h, 2)], surface, conquest)
    return DONE


@plain_kernel
def _lower_ends(p: int, b: int, front: Any) -> None:
    """Count the face that was conquered between p and b, and say what is behind p now."""
    front.behind[p] = front.vertex[b]
    lower(front, b, front.missing[b] - 1)
    lower(front, p, front.missing[p] - 1)


@plain_kernel
def _split(p: int, surface: Any, conquest: Any, state: Any, buffer: Any) -> int:
    """Conquer a face whose tip is elsewhere: a loop is cut in two, or two become one."""
    front = conquest.front
    encoding = state[DECODING] == 0
    h = whole(front.gate[p])
    b = whole(front.after[p])
    x = fan = whole(0)
    if encoding:
        x, fan = find_split(h, surface.twins, surface.known, surface.node)
    x, fan = code_split(x, fan, p, front, conquest.splits, state, buffer)
    if x < 0:
        return BAD_SPLIT
    v = whole(front.vertex[x])
    rest = front.missing[x] - 1 - fan
    if rest < 1 or front.missing[b] < 2 or v == front.vertex[p] or v == front.vertex[b]:
        return BAD_SPLIT
    if front.top[front.top.size - 1] == front.after.size:
        return TOO_MANY_VERTICES
    _note(h // 3, v, front.vertex[p], front.vertex[b], surface, conquest)
    y = add(front, v, rest, 0, front.vertex[p])
    link(front, front.before[x], y)
    link(front, y, b)
    link(front, p, x)
    lower(front, x, fan)
    _lower_ends(p, b, conquest.front)
    if encoding:
        _set_gate(y, surface.twins[_side(h, 1)], surface, conquest)
        _set_gate(p, surface.twins[_side(h, 2)], surface, conquest)
    return DONE


def surface_to_fill(faces: int) -> Surface:
    """Make what the decoder fills: so many faces."""
    nothing = np.zeros(0, np.int32)
    return Surface(
        np.zeros((0, 3), np.int32),
        nothing,
        np.zeros(0, np.uint8),
        nothing,
        nothing,
        np.zeros((faces, 3), np.int32),
        nothing,
    )


def surface_to_conquer(faces: NDArray[np.int64], twins: NDArray[np.int64], n: int) -> Surface:
    """Make what the encoder works on: closed oriented manifold faces with n vertices."""
    m = len(faces)
    return Surface(
        faces.astype(np.int32),
        twins.astype(np.int32),
        np.zeros(m, np.uint8),
        np.full(n, -1, np.int32),
        np.zeros(3 * m, np.int32),
        np.zeros((m, 3), np.int32),
        np.zeros(m, np.int32),
    )
