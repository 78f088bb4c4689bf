"""The lines of an OBJ file: one pass over its bytes."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._jit import kernel
from beltrami.io.lanes import plain_faces, plain_vertices
from beltrami.io.numbers import next_line, read_integer, read_number, skip_blanks

# Where the pass stands, in an array that it leaves behind and takes up again.
POSITION, VERTICES, TEXTURES, FACES, COLOURS, TEXTURED, FAULT = range(7)

# How a pass ends.
DONE, MORE_VERTICES, MORE_TEXTURES, MORE_FACES = range(4)
NOT_FINITE, NOT_INTEGER, NO_VERTEX, NO_TEXTURE, TOO_FEW, COLUMNS = range(4, 10)

_NEWLINE, _HASH, _SLASH, _BACKSLASH, _F = 10, 35, 47, 92, 102


@kernel
def scan(
    b: Any, state: Any, limits: Any, x: Any, rgba: Any, uv: Any, faces: Any, turns: Any
) -> int:
    """Read lines until the end, a full array or a fault; return how it ended.

    ``x`` (n, 3), ``rgba`` (n, 4), ``uv`` (t, 2), ``faces`` and ``turns`` (m, 3) are filled;
    ``turns`` holds the texture index of each corner, -1 without. Indices must stay below
    ``limits``: (vertices, texture coordinates).
    """
    end = b.size
    p = state[POSITION]
    while p < end:
        if state[COLOURS] == 0:
            p, state[VERTICES] = plain_vertices(b, p, end, x, state[VERTICES])
        if state[TEXTURED] == 0:
            p, state[FACES] = plain_faces(b, p, _F, 1, limits[0], faces, state[FACES])
        p = skip_blanks(b, p, end)
        state[POSITION] = p
        status = DONE
        if p + 1 < end and b[p] == 118 and b[p + 1] <= 32:
            p, status = _vertex(b, p + 1, end, state, x, rgba)
        elif p + 1 < end and b[p] == 102 and b[p + 1] <= 32:
            p, status = _face(b, p + 1, end, state, limits, faces, turns)
        elif p + 2 < end and b[p] == 118 and b[p + 1] == 116 and b[p + 2] <= 32:
            p, status = _texture(b, p + 2, end, state, uv)
        elif p < end and b[p] == _HASH:
            p = next_line(b, p, end)
        else:
            p = _statement(b, p, end)
        if status != DONE:
            state[FAULT] = p
            return status
    state[POSITION] = end
    return DONE


@kernel
def _statement(b: Any, p: int, end: int) -> int:
    """Skip a line that is not read, with the lines that continue it."""
    while True:
        p = next_line(b, p, end)
        last = p - 2
        if last >= 0 and b[last] == 13:
            last -= 1
        if p >= end or last < 0 or b[last] != _BACKSLASH:
            return p


@kernel
def _gap(b: Any, p: int, end: int) -> int:
    """Skip blanks, and the end of a line that is continued."""
    p = skip_blanks(b, p, end)
    while p < end and b[p] == _BACKSLASH:
        q = skip_blanks(b, p + 1, end)
        if q < end and b[q] != _NEWLINE:
            return p
        p = skip_blanks(b, min(q + 1, end), end)
    return p


@kernel
def _ended(b: Any, p: int, end: int) -> bool:
    return p >= end or b[p] == _NEWLINE or b[p] == _HASH


@kernel
def _vertex(b: Any, p: int, end: int, state: Any, x: Any, rgba: Any) -> Any:
    """Read x y z [w] or x y z r g b [a]."""
    n = state[VERTICES]
    if n == x.shape[0]:
        return p, MORE_VERTICES
    for c in range(3):
        p = _gap(b, p, end)
        value, q = read_number(b, p, end)
        if q == p or value - value != 0.0:
            return p, NOT_FINITE
        x[n, c] = value
        p = q
    p = skip_blanks(b, p, end)
    if not _ended(b, p, end):
        p, status = _colour(b, p, end, state, rgba, n)
        if status != DONE:
            return p, status
    elif state[COLOURS]:
        rgba[n] = np.nan
    state[VERTICES] = n + 1
    return next_line(b, p, end), DONE


@kernel
def _colour(b: Any, p: int, end: int, state: Any, rgba: Any, n: int) -> Any:
    """Read what follows x y z: a weight, which is left out, or three or four colours."""
    rgba[n] = np.nan
    columns = 0
    while True:
        p = _gap(b, p, end)
        if _ended(b, p, end):
            break
        value, q = read_number(b, p, end)
        if q == p or value - value != 0.0:
            return p, NOT_FINITE
        if columns == 4:
            return p, COLUMNS
        rgba[n, columns] = value
        columns += 1
        p = q
    if columns == 2:
        return p, COLUMNS
    if columns < 3:
        rgba[n] = np.nan
    else:
        if state[COLOURS] == 0:
            rgba[:n] = np.nan
        state[COLOURS] = max(state[COLOURS], columns)
    return p, DONE


@kernel
def _texture(b: Any, p: int, end: int, state: Any, uv: Any) -> Any:
    """Read u [v [w]]."""
    t = state[TEXTURES]
    if t == uv.shape[0]:
        return p, MORE_TEXTURES
    uv[t, 1] = 0.0
    c = 0
    while c < 3:
        p = _gap(b, p, end)
        if c > 0 and _ended(b, p, end):
            break
        value, q = read_number(b, p, end)
        if q == p or value - value != 0.0:
            return p, NOT_FINITE
        if c < 2:
            uv[t, c] = value
        p = q
        c += 1
    p = _gap(b, p, end)
    if not _ended(b, p, end):
        return p, COLUMNS
    state[TEXTURES] = t + 1
    return next_line(b, p, end), DONE


@kernel
def _face(b: Any, p: int, end: int, state: Any, limits: Any, faces: Any, turns: Any) -> Any:
    """Read the corners v, v/vt, v//vn or v/vt/vn, and cut the polygon from its first corner."""
    m = state[FACES]
    corners = 0
    first = second = first_turn = second_turn = 0
    p = _gap(b, p, end)
    while not _ended(b, p, end):
        i, q = read_integer(b, p, end)
        if q == p:
            return p, NOT_INTEGER
        i = i + state[VERTICES] if i < 0 else i - 1
        if i < 0 or i >= limits[0]:
            return p, NO_VERTEX
        turn = -1
        if q < end and b[q] == _SLASH:
            turn, q = _turn(b, q + 1, end, state[TEXTURES])
            if turn < -1 or turn >= limits[1]:
                return p, NO_TEXTURE
            if turn >= 0 and state[TEXTURED] == 0:
                turns[:m] = -1
                state[TEXTURED] = 1
        if q < end and b[q] > 32 and b[q] != _BACKSLASH:
            return p, NOT_INTEGER
        if corners == 0:
            first, first_turn = i, turn
        elif corners > 1:
            if m == faces.shape[0]:
                return p, MORE_FACES
            faces[m, 0] = first
            faces[m, 1] = second
            faces[m, 2] = i
            if state[TEXTURED]:
                turns[m, 0] = first_turn
                turns[m, 1] = second_turn
                turns[m, 2] = turn
            m += 1
        second, second_turn = i, turn
        corners += 1
        p = _gap(b, q, end)
    if corners < 3:
        return p, TOO_FEW
    state[FACES] = m
    return next_line(b, p, end), DONE


@kernel
def _turn(b: Any, p: int, end: int, count: int) -> Any:
    """Read vt, /vn or vt/vn after the slash: (index from 0, position); -1 is none, -2 wrong."""
    turn = -1
    value, q = read_integer(b, p, end)
    if q > p:
        turn = value + count if value < 0 else value - 1
        if turn < 0:
            turn = -2
    if q < end and b[q] == _SLASH:
        _, q = read_integer(b, q + 1, end)
    return turn, q
