"""The lines of an OBJ file: one pass over its bytes."""

from __future__ import annotations

from typing import Any

import numpy as np

from beltrami._jit import kernel, part_of_kernels
from beltrami.io.lanes import plain_faces, plain_vertices
from beltrami.io.numbers import next_line, read_integer, read_number, skip_blanks

# Where the pass stands, in an array that it leaves behind and takes up again.
POSITION, VERTICES, TEXTURES, FACES, COLOURS, TEXTURED, FAULT = range(7)

# How a pass ends.
DONE, MORE_VERTICES, MORE_TEXTURES, MORE_FACES = range(4)
NOT_FINITE, NOT_INTEGER, NO_VERTEX, NO_TEXTURE, TOO_FEW, COLUMNS = range(4, 10)

_NEWLINE, _HASH, _SLASH, _BACKSLASH, _F, _T, _V = 10, 35, 47, 92, 102, 116, 118


@kernel
def scan(
    b: Any,
    state: Any,
    limits: Any,
    row: Any,
    x: Any,
    rgba: Any,
    uv: Any,
    faces: Any,
    turns: Any,
) -> int:
    """Read lines until the end, a full array or a fault; return how it ended.

    ``x`` (n, 3), ``rgba`` (n, 4), ``uv`` (t, 2), ``faces`` and ``turns`` (m, 3) are filled;
    ``turns`` holds the texture index of each corner, -1 without. Indices must stay below
    ``limits``: (vertices, texture coordinates). ``row`` has room for the seven numbers of a line.
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
        texture = p + 2 < end and b[p] == _V and b[p + 1] == _T and b[p + 2] <= 32
        if p + 1 < end and b[p] == _F and b[p + 1] <= 32:
            p, status = _face(b, p + 1, end, state, limits, faces, turns)
        elif texture or (p + 1 < end and b[p] == _V and b[p + 1] <= 32):
            most = uv.shape[1] + 1 if texture else row.size
            p, columns, status = _row(b, p + 2 if texture else p + 1, end, row, most)
            if status == DONE and texture:
                status = _keep_texture(row, columns, state, uv)
            elif status == DONE:
                status = _keep_vertex(row, columns, state, x, rgba)
        elif p < end and b[p] != _HASH:
            p = _statement(b, p, end)
            continue
        if status != DONE:
            state[FAULT] = p
            return status
        p = next_line(b, p, end)
    state[POSITION] = end
    return DONE


@part_of_kernels
def _statement(b: Any, p: int, end: int) -> int:
    """Skip a line that is not read, with the lines that continue it."""
    while True:
        p = next_line(b, p, end)
        last = p - 2
        if last >= 0 and b[last] == 13:
            last -= 1
        if p >= end or last < 0 or b[last] != _BACKSLASH:
            return p


@part_of_kernels
def _gap(b: Any, p: int, end: int) -> int:
    """Skip blanks, and the end of a line that is continued."""
    p = skip_blanks(b, p, end)
    while p < end and b[p] == _BACKSLASH:
        q = skip_blanks(b, p + 1, end)
        if q < end and b[q] != _NEWLINE:
            return p
        p = skip_blanks(b, q + 1 if q < end else end, end)
    return p


@part_of_kernels
def _keep_vertex(row: Any, columns: int, state: Any, x: Any, rgba: Any) -> int:
    """Keep x y z [w] or x y z r g b [a]; a weight is left out."""
    n = state[VERTICES]
    if n == x.shape[0]:
        return MORE_VERTICES
    if columns < 3:
        return NOT_FINITE
    if columns == 5:
        return COLUMNS
    for c in range(3):
        x[n, c] = row[c]
    colours = columns - 3 if columns > 5 else 0
    if colours and state[COLOURS] == 0:
        for i in range(n):
            for c in range(4):
                rgba[i, c] = np.nan
    if colours > state[COLOURS]:
        state[COLOURS] = colours
    if state[COLOURS]:
        for c in range(4):
            rgba[n, c] = row[3 + c] if c < colours else np.nan
    state[VERTICES] = n + 1
    return DONE


@part_of_kernels
def _keep_texture(row: Any, columns: int, state: Any, uv: Any) -> int:
    """Keep u [v [w]]."""
    t = state[TEXTURES]
    if t == uv.shape[0]:
        return MORE_TEXTURES
    if columns == 0:
        return NOT_FINITE
    uv[t, 0] = row[0]
    uv[t, 1] = row[1] if columns > 1 else 0.0
    state[TEXTURES] = t + 1
    return DONE


@part_of_kernels
def _row(b: Any, p: int, end: int, row: Any, most: int) -> Any:
    """Read the numbers of a line: (position, how many, status)."""
    columns = 0
    while True:
        while p < end and b[p] <= 32 and b[p] != _NEWLINE:
            p += 1
        if p >= end or b[p] == _NEWLINE or b[p] == _HASH:
            return p, columns, DONE
        value, q = read_number(b, p, end)
        if q == p and b[p] == _BACKSLASH:
            p = _gap(b, p, end)
            if p > q:
                continue
        if columns == most:
            return p, columns, COLUMNS
        if q == p or value - value != 0.0:
            return p, columns, NOT_FINITE
        row[columns] = value
        columns += 1
        p = q


@part_of_kernels
def _face(b: Any, p: int, end: int, state: Any, limits: Any, faces: Any, turns: Any) -> Any:
    """Read the corners v, v/vt, v//vn or v/vt/vn, and cut the polygon from its first corner."""
    m = state[FACES]
    corners = 0
    first = second = first_turn = second_turn = 0
    while True:
        while p < end and b[p] <= 32 and b[p] != _NEWLINE:
            p += 1
        if p >= end or b[p] == _NEWLINE or b[p] == _HASH:
            break
        i, q = read_integer(b, p, end)
        if q == p:
            p = _gap(b, p, end)
            if p > q:
                continue
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
                for before in range(m):
                    for c in range(3):
                        turns[before, c] = -1
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
        p = q
    if corners < 3:
        return p, TOO_FEW
    state[FACES] = m
    return p, DONE


@part_of_kernels
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
