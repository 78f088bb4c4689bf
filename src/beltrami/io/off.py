"""OFF: vertices, polygons, and normals and colours of vertices (NOFF, COFF, CNOFF)."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats, read_only
from beltrami._jit import kernel, part_of_kernels
from beltrami.io.lanes import plain_faces
from beltrami.io.numbers import next_line, read_integer, read_number, skip_blanks
from beltrami.io.source import POINTS_ONLY, Source, mark_length, trimmed
from beltrami.mesh.mesh import Mesh

_DONE, _NOT_FINITE, _COLUMNS, _NOT_INTEGER, _TOO_FEW, _NO_VERTEX, _MORE, _LEFT = range(8)
_HEADER = 4096  # bytes searched at a time for the counts
_NEWLINE, _HASH, _THREE = 10, 35, 51
_NO_DATA = re.compile(rb"(?:[\x00-\x09\x0b-\x20]*(?:#[^\n]*)?\n)*[\x00-\x09\x0b-\x20]*")


def read_off(source: Source) -> Mesh:
    r"""Read an OFF file; polygons are cut from their first corner.

    The keyword is OFF with any of the prefixes ST, C and N: normals become the vertex data
    "normal", colours "color", texture coordinates "uv". Colours of faces are left out. Colours
    that are whole numbers up to 255, not all of them 0 or 1, are kept as bytes.

    Raises
    ------
    FileFormatError
        With the line, for what is no such file; also without vertices or faces.

    Examples
    --------
    >>> import numpy as np
    >>> text = b"OFF 3 1 0 # one triangle\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
    >>> read_off(Source("triangle.off", np.frombuffer(text, np.uint8))).faces.tolist()
    [[0, 1, 2]]
    """
    keyword, counts, start = _header(source)
    n, m = counts
    for count, what in ((n, "vertices"), (m, "faces")):
        if count == 0:
            hint = POINTS_ONLY if n else ""
            raise source.at_line(max(start - 1, 0), f"expected {what}, found the count 0{hint}")
    _require_room(source, start, n, m)
    extra = 3 * ("N" in keyword)
    rows, columns, position = _read_vertices(source, start, n, 3 + extra, keyword)
    faces = _read_faces(source, position, n, m)
    data = _vertex_data(rows[:, 3:columns], keyword)
    vertices = rows if rows.shape[1] == 3 else rows[:, :3].copy()
    return Mesh(read_only(vertices), read_only(faces), data)


def off_points(source: Source) -> Floats:
    """Read the vertices alone, (n, 3); nothing after them is looked at."""
    keyword, (n, m), start = _header(source)
    if n == 0:
        raise source.at_line(max(start - 1, 0), "expected vertices, found the count 0")
    _require_room(source, start, n, m)
    rows, _, _ = _read_vertices(source, start, n, 3 + 3 * ("N" in keyword), keyword)
    return rows[:, :3].copy()


def _require_room(source: Source, start: int, n: int, m: int) -> None:
    """Refuse counts that the file is too short for, before anything is allocated."""
    if 6 * n + 8 * m > len(source.data) - start + 1:  # the shortest lines there are
        raise source.at_line(
            max(start - 1, 0),
            f"expected {n} vertices and {m} faces, at least {6 * n + 8 * m} bytes, found "
            f"{len(source.data) - start}: the file is cut off or its counts are wrong",
        )


def _header(source: Source) -> tuple[str, tuple[int, int], int]:
    """Find the keyword, the counts of vertices and faces, and where the data starts."""
    head = source.data[: 16 * _HEADER].tobytes()
    mark = mark_length(source.data)
    text = b" " * mark + head[mark:]  # with all positions as they are, as below
    text = re.sub(rb"#[^\n]*", lambda comment: b" " * len(comment.group()), text)
    keyword = re.match(rb"\s*((?:ST)?C?N?OFF)(?=\s|$)", text)
    if keyword is None:
        place = len(text) - len(text.lstrip())
        raise source.unexpected(place, "OFF, COFF, NOFF, CNOFF or one of them after ST")
    counts = re.compile(rb"\s*(\d{1,18})[ \t\r]+(\d{1,18})(?:[ \t\r]+\d+)?[ \t\r]*(?=\n|$)").match(
        text, keyword.end()
    )
    if counts is None:
        place = keyword.end() + len(text[keyword.end() :]) - len(text[keyword.end() :].lstrip())
        raise source.unexpected(place, "the counts of vertices, faces and edges")
    start = min(counts.end() + 1, len(source.data))
    return keyword[1].decode(), (int(counts[1]), int(counts[2])), start


def _read_vertices(
    source: Source, start: int, n: int, least: int, keyword: str
) -> tuple[NDArray[np.float64], int, int]:
    """Read n lines of as many numbers as the first has: (array, columns, position)."""
    width, position = _first_row(source, start)
    colours = keyword.startswith("C") or "STC" in keyword
    texture = 2 * keyword.startswith("ST")
    allowed = [least + texture + c for c in ((3, 4) if colours else (0,))]
    if width not in allowed:
        wanted = " or ".join(map(str, allowed))
        raise source.at_line(
            position, f"expected {wanted} numbers for a vertex of {keyword}, found {width}"
        )
    rows = np.empty((n, width))
    position, status = _vertices(source.data, start, rows)
    if status == _COLUMNS:
        raise source.unexpected(position, f"{width} numbers for a vertex, as on the lines before")
    if status != _DONE:
        raise source.unexpected(position, "a finite number (the coordinate of a vertex)")
    return rows, width, position


def _first_row(source: Source, start: int) -> tuple[int, int]:
    """Count the words on the next line of data: (how many, where it starts)."""
    found = _NO_DATA.match(source.data.data, start)
    position = found.end() if found else start
    rest = source.data[position:]
    newline = np.flatnonzero(rest[:_HEADER] == _NEWLINE)
    line = rest[: newline[0] if len(newline) else _HEADER].tobytes().split(b"#")[0]
    return len(line.split()), position


def _read_faces(source: Source, position: int, n: int, m: int) -> NDArray[np.int64]:
    faces = np.empty((m, 3), np.int64)
    polygons = filled = 0
    while True:
        position, polygons, filled, status = _faces(
            source.data, position, n, m, faces, polygons, filled
        )
        if status == _DONE:
            return trimmed(faces, filled)
        if status != _MORE:
            expected = {
                _NOT_INTEGER: f"an integer (face {polygons + 1} of {m})",
                _TOO_FEW: "three corners or more in a face",
                _NO_VERTEX: f"the index of a vertex, 0..{n - 1}",
                _LEFT: f"the end of the file after {m} faces",
            }
            raise source.unexpected(position, expected[status])
        trimmed(faces, 2 * len(faces))


def _vertex_data(rows: NDArray[np.float64], keyword: str) -> dict[str, NDArray[Any]]:
    """Name the columns after x y z: normal, colour, texture, in this order."""
    data: dict[str, NDArray[Any]] = {}
    if keyword.endswith("NOFF"):
        data["normal"], rows = rows[:, :3], rows[:, 3:]
    if keyword.startswith("ST"):
        data["uv"], rows = rows[:, -2:], rows[:, :-2]
    if rows.shape[1]:
        whole = (rows == np.floor(rows)).all() and rows.min() >= 0 and 1 < rows.max() <= 255
        data["color"] = rows.astype(np.uint8) if whole else rows
    return {name: read_only(column.copy()) for name, column in data.items()}


@part_of_kernels
def _next_data(b: Any, p: int) -> int:
    """Skip blank lines and comments."""
    end = b.size
    while p < end:
        p = skip_blanks(b, p, end)
        if p < end and b[p] != 10 and b[p] != _HASH:
            return p
        p = next_line(b, p, end)
    return end


@part_of_kernels
def _ended(b: Any, p: int) -> bool:
    return p >= b.size or b[p] == 10 or b[p] == _HASH


@kernel
def _vertices(b: Any, p: int, rows: Any) -> Any:
    """Fill the rows, one from each line: (position, status)."""
    end = b.size
    n, width = rows.shape
    for i in range(n):
        p = _next_data(b, p)
        for c in range(width):
            p = skip_blanks(b, p, end)
            value, q = read_number(b, p, end)
            if q == p or value - value != 0.0:
                return p, _NOT_FINITE
            rows[i, c] = value
            p = q
        p = skip_blanks(b, p, end)
        if not _ended(b, p):
            return p, _COLUMNS
        p = next_line(b, p, end)
    return p, _DONE


@kernel
def _faces(b: Any, p: int, n: int, m: int, faces: Any, polygons: int, filled: int) -> Any:
    """Fill the triangles until all m polygons are read: (position, polygons, filled, status)."""
    end = b.size
    while polygons < m:
        before = filled
        most = min(faces.shape[0], filled + m - polygons)
        p, filled = plain_faces(b, p, _THREE, 0, n - 1, faces[:most], filled)
        polygons += filled - before
        if polygons == m:
            break
        p = line = _next_data(b, p)
        size, q = read_integer(b, p, end)
        if q == p or (q < end and b[q] > 32):
            return p, polygons, filled, _NOT_INTEGER
        if size < 3:
            return p, polygons, filled, _TOO_FEW
        if size - 2 > faces.shape[0] - filled and size <= end - q:
            return line, polygons, filled, _MORE
        first = second = 0
        for c in range(size):
            p = skip_blanks(b, q, end)
            i, q = read_integer(b, p, end)
            if q == p or (q < end and b[q] > 32):
                return p, polygons, filled, _NOT_INTEGER
            if i < 0 or i >= n:
                return p, polygons, filled, _NO_VERTEX
            if c == 0:
                first = i
            elif c > 1 and filled < faces.shape[0]:  # no room: more corners than bytes, an error
                faces[filled, 0] = first
                faces[filled, 1] = second
                faces[filled, 2] = i
                filled += 1
            second = i
        polygons += 1
        p = next_line(b, q, end)
    p = _next_data(b, p)
    return p, polygons, filled, (_DONE if p >= end else _LEFT)
