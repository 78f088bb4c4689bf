"""Texture coordinates of corners: a surface cut along the seams, whose vertices have them.

The corners at a vertex that have the same coordinates are a wedge. Which corner belongs to which
is told first; then wedges are vertices of faces like any, and their coordinates are predicted.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats, Integers
from beltrami._jit import kernel
from beltrami.compression.numbers import surroundings
from beltrami.compression.predicted import decode_predicted, encode_exactly, encode_within
from beltrami.compression.range_coder import (
    DECODING,
    POSITION,
    code_number,
    finished,
    new_decoder,
    new_encoder,
    new_number_model,
    ran_dry,
    readable,
)
from beltrami.compression.tables import whole
from beltrami.compression.varint import Reader, to_varints

_LONGEST = 64  # wedges that are looked through


def keys_of(uv: Floats) -> Integers:
    """Return a number for the coordinates of each corner, the same for the same bits, (3m,)."""
    bits = np.ascontiguousarray(uv.reshape(-1, 2)).view(np.int64)
    return np.unique(bits, axis=0, return_inverse=True)[1].ravel().astype(np.int64)


def encode_uv(
    faces: Integers, n: int, uv: Floats, max_error: float | None, effort: str
) -> tuple[bytes | None, Floats]:
    """Write (m, 3, 2) coordinates, exactly or within a bound; and what they become."""
    size = 8 * faces.size + 1024
    while True:
        state, buffer = new_encoder(), np.zeros(size, np.uint8)
        corners, wedge = faces.ravel(), np.zeros(faces.size, np.int64)
        keys, most = keys_of(uv), faces.size
        count = code_wedges(corners, n, keys, wedge, most, _models(), state, buffer)
        coded = finished(state, buffer)
        if coded is not None:
            break
        size = int(state[POSITION]) + 1024
    values = np.empty((count, 2))
    values[wedge] = uv.reshape(-1, 2)
    wedges = wedge.reshape(-1, 3)
    near = surroundings(wedges, len(values))
    body: bytes | None
    if max_error is None:
        body, found = encode_exactly("uv", values, near, effort), values
    else:
        body, found = encode_within("uv", values, max_error, near, effort)
    if body is None:
        return None, uv
    return to_varints([len(values), len(coded)]) + coded + body, found[wedges]


def decode_uv(reader: Reader, faces: Integers, n: int) -> Floats:
    """Read (m, 3, 2) coordinates."""
    count = reader.varint(3 * len(faces), "texture coordinates")
    buffer = readable(reader.take(reader.varint()))
    state, wedges = new_decoder(buffer), np.zeros(faces.size, np.int64)
    keys = np.zeros(count + 1, np.int64)
    found = code_wedges(faces.ravel(), n, keys, wedges, count, _models(), state, buffer)
    if found != count or ran_dry(state, buffer):
        raise reader.fault(f"expected {count} texture coordinates, found others")
    corners = wedges.reshape(-1, 3)
    _, values = decode_predicted(reader, count, surroundings(corners, count))
    if values.shape != (count, 2) or values.dtype != np.float64:
        raise reader.fault("texture coordinates of a wrong shape")
    return np.asarray(values[corners])


def _models() -> NDArray[np.int64]:
    return np.stack([new_number_model() for _ in range(2)])


@kernel
def code_wedges(
    corners: Any, n: int, keys: Any, wedges: Any, most: int, models: Any, state: Any, buffer: Any
) -> int:
    """Write or read the wedge of each corner; return how many there are, at most ``most`` + 1.

    For each corner at a vertex that has wedges a number: the place of its wedge in the list of
    them, the newest first, or the length of the list (at most 64) for a new one. ``keys`` (3m,)
    tell the writer which corners are alike.
    """
    newest, before = np.full(n, -1, np.int64), np.full(most + 1, -1, np.int64)
    first = np.zeros(most + 1, np.int64)  # the corner that a wedge began with
    count, last = whole(0), whole(0)
    for i in range(corners.size):
        wedge = newest[corners[i]]
        if wedge >= 0:
            place, w = whole(0), wedge
            if state[DECODING] == 0:
                while w >= 0 and place < _LONGEST and keys[first[w]] != keys[i]:
                    place, w = place + 1, before[w]
            place = code_number(place, models[last], state, buffer)
            last = min(place, 1)
            for _ in range(min(place, _LONGEST)):
                wedge = before[wedge] if wedge >= 0 else wedge
            wedge = -1 if place >= _LONGEST else wedge
        if wedge < 0:
            if count == most or ran_dry(state, buffer):
                return most + 1
            wedge = count
            before[count], newest[corners[i]], first[count] = newest[corners[i]], count, i
            count += 1
        wedges[i] = wedge
    return count
