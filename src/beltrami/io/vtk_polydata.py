"""Legacy VTK files of surfaces (POLYDATA), as VTK, pyvista, ParaView and LaPy write them."""

from __future__ import annotations

from typing import Any, NamedTuple
from urllib.parse import unquote

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats, Integers
from beltrami.io.faces import fan, first_outside, unroll
from beltrami.io.source import Source
from beltrami.io.vtk_cursor import VtkCursor

_CELLS = ("VERTICES", "LINES", "POLYGONS", "TRIANGLE_STRIPS")
_WIDTHS = {"VECTORS": 3, "NORMALS": 3, "TENSORS": 9, "GLOBAL_IDS": 1, "PEDIGREE_IDS": 1}


class PolyData(NamedTuple):
    """Points (n, 3), triangles (m, 3), arrays on the points, texture coordinates (n, 2)."""

    points: Floats
    faces: Integers
    data: dict[str, NDArray[Any]]
    uv: NDArray[Any] | None


def is_polydata(source: Source) -> bool:
    r"""Whether this is a legacy VTK file of a surface.

    Examples
    --------
    >>> text = b"# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\n"
    >>> is_polydata(Source("a.vtk", np.frombuffer(text, np.uint8)))
    True
    """
    lines = source.data[:2000].tobytes().upper().split(b"\n")[:6]
    return lines[0].startswith(b"# VTK DATAFILE") and any(
        line.split() == [b"DATASET", b"POLYDATA"] for line in lines
    )


def read_polydata(source: Source) -> PolyData:
    r"""Read a surface, of the versions 1 to 5.1, in text or binary.

    Polygons are cut from their first corner, strips into their triangles; points and lines that
    are cells, and data on cells, are left out. Texture coordinates apart, arrays on the points
    have the names of the file.

    Raises
    ------
    FileFormatError
        With the line or the byte, for what is no such file.

    Notes
    -----
    Source: Kitware, *VTK File Formats*, "Simple Legacy Formats".

    Examples
    --------
    >>> text = (
    ...     b"# vtk DataFile Version 3.0\ntwo\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n"
    ...     b"0 0 0 1 0 0 1 1 0 0 1 0\nPOLYGONS 1 5\n4 0 1 2 3\n"
    ...     b"POINT_DATA 4\nSCALARS height double\nLOOKUP_TABLE default\n1 2 3 4\n"
    ... )
    >>> found = read_polydata(Source("a.vtk", np.frombuffer(text, np.uint8)))
    >>> found.faces.tolist(), found.data["height"].tolist()
    ([[0, 1, 2], [0, 2, 3]], [1.0, 2.0, 3.0, 4.0])
    """
    cursor = VtkCursor(source)
    cursor.line()
    cursor.line()
    mode = cursor.line().upper()
    if mode not in ("ASCII", "BINARY"):
        raise cursor.unexpected("ASCII or BINARY")
    cursor.binary = mode == "BINARY"
    cursor.words()
    return _Surface(cursor).read()


class _Surface:
    """What has been read so far."""

    def __init__(self, cursor: VtkCursor) -> None:
        self.cursor = cursor
        self.points = np.zeros((0, 3))
        self.faces = [np.zeros((0, 3), np.int64)]
        self.data: dict[str, NDArray[Any]] = {}
        self.uv: NDArray[Any] | None = None
        self.rows, self.kept = 0, False  # of the data that comes; whether it is on the points

    def read(self) -> PolyData:
        while words := self.cursor.words():
            key = words[0].upper()
            if key == "POINTS":
                count = self.cursor.count(words, 1)
                kind = _word(self.cursor, words, 2) if self.cursor.binary else "double"
                values = self.cursor.array(kind, 3 * count)
                self.points = values.reshape(-1, 3).astype(np.float64)
            elif key in _CELLS:
                self._cells(key, words)
            elif key in ("POINT_DATA", "CELL_DATA"):
                self.rows, self.kept = self.cursor.count(words, 1), key == "POINT_DATA"
            elif key == "METADATA":
                self.cursor.skip_metadata()
            else:
                self._attribute(key, words)
        return PolyData(self.points, np.concatenate(self.faces), self.data, self.uv)

    def _cells(self, key: str, words: list[str]) -> None:
        first, second = self.cursor.count(words, 1), self.cursor.count(words, 2)
        if first > second + 1:
            raise self.cursor.unexpected(f"fewer than {first} lists in {second} numbers")
        ahead = self.cursor.words() if first else []
        if ahead and ahead[0].upper() == "OFFSETS":
            offsets = self.cursor.array(_word(self.cursor, ahead, 1), first).astype(np.int64)
            names = self.cursor.words()
            corners = self.cursor.array(_word(self.cursor, names, 1), second).astype(np.int64)
            sizes = np.diff(offsets)
            if offsets[0] != 0 or offsets[-1] != second or (sizes < 0).any():
                raise self.cursor.unexpected("offsets that ascend from 0 to the end")
        else:
            if ahead:
                self.cursor.back()
            corners, sizes = self._lists(self.cursor.array("int", second).astype(np.int64), first)
        if key in ("POLYGONS", "TRIANGLE_STRIPS"):
            self.faces.append(self._triangles(key, corners, sizes))

    def _lists(self, cells: Integers, count: int) -> tuple[Integers, Integers]:
        """Part lists, each with its length before it, into corners and lengths."""
        if len(cells) == 4 * count and (cells[::4] == 3).all():
            return cells.reshape(-1, 4)[:, 1:].ravel(), np.full(count, 3)
        places, place = np.empty(count, np.int64), 0
        for i in range(count):
            if place >= len(cells) or cells[place] < 0:
                raise self.cursor.unexpected(f"{count} lists of vertices")
            places[i] = place
            place += int(cells[place]) + 1
        if place != len(cells):
            raise self.cursor.unexpected(f"{count} lists of vertices")
        return np.delete(cells, places), cells[places]

    def _triangles(self, key: str, corners: Integers, sizes: Integers) -> Integers:
        if (sizes < 3).any():
            raise self.cursor.unexpected("three corners or more in a face")
        if first_outside(corners, len(self.points)) >= 0:
            raise self.cursor.unexpected(f"indices of vertices, 0..{len(self.points) - 1}")
        if key == "POLYGONS":
            return fan(corners, sizes)
        return unroll(np.insert(corners, np.cumsum(sizes), -1))

    # ------------------------------------------------------------------ data

    def _attribute(self, key: str, words: list[str]) -> None:
        cursor, name = self.cursor, unquote(_word(self.cursor, words, 1))
        if key == "FIELD":
            self._field(cursor.count(words, 2))
        elif key == "SCALARS":
            width = cursor.count(words, 3) if len(words) > 3 else 1
            if (cursor.words() or [""])[0].upper() != "LOOKUP_TABLE":
                cursor.back()
            self._keep(name, cursor.array(_word(cursor, words, 2), width * self.rows), width)
        elif key == "COLOR_SCALARS":
            width = cursor.count(words, 2)
            kind = "unsigned_char" if cursor.binary else "float"
            self._keep(name, cursor.array(kind, width * self.rows), width)
        elif key == "LOOKUP_TABLE":
            cursor.array("unsigned_char" if cursor.binary else "float", 4 * cursor.count(words, 2))
        elif key == "TEXTURE_COORDINATES":
            width = cursor.count(words, 2)
            uv = cursor.array(_word(cursor, words, 3), width * self.rows).reshape(self.rows, -1)
            self.uv = uv if self.kept else self.uv
        elif key in _WIDTHS:
            width = _WIDTHS[key]
            self._keep(name, cursor.array(_word(cursor, words, 2), width * self.rows), width)
        else:
            raise cursor.unexpected("a section of a surface, as POINTS, POLYGONS or POINT_DATA")

    def _field(self, count: int) -> None:
        for _ in range(count):
            words = self.cursor.words()
            while words and words[0].upper() == "METADATA":
                self.cursor.skip_metadata()
                words = self.cursor.words()
            width, rows = self.cursor.count(words, 1), self.cursor.count(words, 2)
            values = self.cursor.array(_word(self.cursor, words, 3), width * rows)
            if rows == self.rows:
                self._keep(unquote(words[0]), values, width)

    def _keep(self, name: str, values: NDArray[Any], width: int) -> None:
        if self.kept:
            self.data[name] = values if width == 1 else values.reshape(self.rows, width)


def _word(cursor: VtkCursor, words: list[str], place: int) -> str:
    if place >= len(words):
        raise cursor.unexpected(f"{place + 1} words")
    return words[place]
