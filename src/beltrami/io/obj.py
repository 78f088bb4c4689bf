"""OBJ: vertices, their colours, polygons and texture coordinates."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats, read_only
from beltrami.errors import FileFormatError, MeshError
from beltrami.io import obj_kernel as lines
from beltrami.io.source import POINTS_ONLY, Source, mark_length, trimmed
from beltrami.mesh.mesh import Mesh

_NO_LIMIT = 1 << 62
_BYTES_OF_LINE = 16  # most lines are longer: the arrays grow where they are not
_EXPECTED = {
    lines.NOT_FINITE: "a finite number",
    lines.NOT_INTEGER: "a corner v, v/vt, v//vn or v/vt/vn",
    lines.NO_VERTEX: "the index of a vertex (1..{0}, or negative to count back)",
    lines.NO_TEXTURE: "a corner with the index of a texture coordinate (1..{1})",
    lines.TOO_FEW: "three corners or more in a face",
    lines.COLUMNS: "x y z, x y z w, x y z r g b [a], or u [v [w]]",
}


def read_obj(source: Source) -> Mesh:
    r"""Read an OBJ file: v, vt and f; polygons are cut from their first corner.

    ``v x y z r g b`` gives the vertex data "color". Corners with texture coordinates give
    ``corner_uv``, NaN at a corner without. Normals, groups, materials, lines and points are
    left out. Time and memory grow with the size of the file.

    Raises
    ------
    FileFormatError
        With the line, for what is no such file; also without vertices or faces.

    Examples
    --------
    >>> import numpy as np
    >>> text = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 -1\n"
    >>> read_obj(Source("square.obj", np.frombuffer(text, np.uint8))).faces.tolist()
    [[0, 1, 2], [0, 2, 3]]
    """
    state = np.zeros(7, np.int64)
    limits = np.full(2, _NO_LIMIT)
    arrays = _fill(source, state, limits)
    n, t, m = (int(state[i]) for i in (lines.VERTICES, lines.TEXTURES, lines.FACES))
    if n == 0 or m == 0:
        missing = "vertices (lines 'v x y z')" if n == 0 else "faces (lines 'f i j k')"
        hint = POINTS_ONLY if n else ""
        raise FileFormatError(
            source.path, f"expected {missing}, found none in the whole file{hint}"
        )
    x, rgba, uv, faces, turns = arrays
    faces, turns = trimmed(faces, m), trimmed(turns, m)
    textured = bool(state[lines.TEXTURED])
    if textured and turns.max() >= t:
        _fill(source, np.zeros(7, np.int64), np.array([n, t]))  # raises at the line
    data = (
        {"color": read_only(rgba[:n, : state[lines.COLOURS]].copy())}
        if state[lines.COLOURS]
        else None
    )
    corner_uv = None
    if textured:
        corner_uv = uv[turns]
        corner_uv[turns < 0] = np.nan
        read_only(corner_uv)
    try:
        return Mesh(read_only(trimmed(x, n)), read_only(faces), data, corner_uv)
    except MeshError:  # an index beyond the last vertex: the second pass raises at its line
        _fill(source, np.zeros(7, np.int64), np.array([n, t]))
        raise


def obj_points(source: Source) -> Floats:
    """Read the vertices alone, (n, 3); faces are checked, but need not be there."""
    state = np.zeros(7, np.int64)
    x = _fill(source, state, np.full(2, _NO_LIMIT))[0]
    if state[lines.VERTICES] == 0:
        raise FileFormatError(source.path, "expected vertices (lines 'v x y z'), found none")
    return trimmed(x, int(state[lines.VERTICES]))


def _fill(source: Source, state: NDArray[np.int64], limits: NDArray[np.int64]) -> Any:
    """Scan the whole file into arrays that grow when they are full."""
    rows = source.size // _BYTES_OF_LINE + 16
    x, rgba, uv = np.empty((rows, 3)), np.empty((rows, 4)), np.empty((rows, 2))
    faces, turns = np.empty((rows, 3), np.int64), np.empty((rows, 3), np.int64)
    row = np.empty(7)
    full = {
        lines.MORE_VERTICES: (x, rgba),
        lines.MORE_TEXTURES: (uv,),
        lines.MORE_FACES: (faces, turns),
    }
    for start, block in source.blocks():
        state[lines.POSITION] = 0 if start else mark_length(block)
        status = lines.scan(block, state, limits, row, x, rgba, uv, faces, turns)
        while status in full:
            for array in full[status]:
                trimmed(array, 2 * len(array))
            status = lines.scan(block, state, limits, row, x, rgba, uv, faces, turns)
        if status != lines.DONE:
            expected = _EXPECTED[status].format(*(count_or_all(k) for k in limits))
            raise source.unexpected(start + int(state[lines.FAULT]), expected)
    return x, rgba, uv, faces, turns


def count_or_all(limit: int) -> str:
    """Write a limit, or "n" while it is not known."""
    return "n" if limit == _NO_LIMIT else str(limit)
