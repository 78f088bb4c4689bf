"""The rows of a binary PLY element."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Integers
from beltrami._jit import kernel
from beltrami.io.ply_header import Element, Property, Rows
from beltrami.io.source import Source


def read_binary(
    source: Source, start: int, element: Element, order: str, wanted: str | None, turns: str | None
) -> Rows:
    """Read the rows of an element, with one list of integers, and one of floating point.

    The lengths are one number where all are equal.

    Raises
    ------
    FileFormatError
        With the byte, where the file ends too early or a list has a negative length.
    """
    if not element.properties:
        return Rows({}, None, None, start)
    triangles = _plain_triangles(source, start, element, order, wanted)
    if triangles is not None:
        return Rows({}, (triangles, 3), None, start + 13 * element.rows)
    names = [p.name for p in element.properties]
    which = names.index(wanted) if wanted in names else -1
    turn = names.index(turns) if turns in names else -1
    if not any(p.length for p in element.properties):
        table = _table(element.properties, [], order)
        _require_bytes(source, start, table.itemsize * element.rows, element)
        rows = np.frombuffer(source.data, table, element.rows, start)
        scalars = {p.name: rows[f"p{i}"] for i, p in enumerate(element.properties)}
        return Rows(scalars, None, None, start + rows.nbytes)
    regular = _regular(source, start, element, order)
    if regular is not None:
        rows = regular
        scalars = {
            p.name: rows[f"p{i}"] for i, p in enumerate(element.properties) if p.length is None
        }
        found, textures = (
            (rows[f"p{i}"].astype(kind), rows[f"p{i}"].shape[1]) if i >= 0 else None
            for i, kind in ((which, np.int64), (turn, np.float64))
        )
        return Rows(scalars, found, textures, start + rows.nbytes)
    return _read_irregular(source, start, element, order, which, turn)


def _require_bytes(source: Source, start: int, size: int, element: Element) -> None:
    if size > len(source.data) - start:
        raise source.at_byte(
            len(source.data),
            f"expected {size} bytes for the {element.rows} rows of the element {element.name!r}, "
            f"found the end of the file after {len(source.data) - start}",
        )


def _plain_triangles(
    source: Source, start: int, element: Element, order: str, wanted: str | None
) -> Integers | None:
    """Read what nearly every file holds, rows of a byte 3 and three integers of four bytes.

    None if the rows are anything else; the general way then says what they are.
    """
    kinds = [(p.name, p.length, p.type) for p in element.properties]
    if order != "<" or kinds not in ([(wanted, "u1", "i4")], [(wanted, "u1", "u4")]):
        return None
    if 13 * element.rows > len(source.data) - start:
        return None
    faces = np.empty((element.rows, 3), np.int64)
    unbroken = _unpack_triangles(source.data[start:], kinds[0][2] == "i4", faces)
    return faces if unbroken else None


@kernel
def _unpack_triangles(b: Any, signed: bool, faces: Any) -> bool:
    """Unpack rows of 13 bytes; say whether each begins with 3."""
    p = 0
    for f in range(faces.shape[0]):
        if b[p] != 3:
            return False
        for c in range(3):
            q = p + 1 + 4 * c
            value = (
                np.uint32(b[q])
                | (np.uint32(b[q + 1]) << np.uint32(8))
                | (np.uint32(b[q + 2]) << np.uint32(16))
                | (np.uint32(b[q + 3]) << np.uint32(24))
            )
            faces[f, c] = np.int32(value) if signed else np.int64(value)
        p += 13
    return True


def _table(properties: list[Property], lengths: list[int], order: str) -> np.dtype[Any]:
    """Lay out a row whose lists have these lengths; fields are named by their place."""
    fields: list[Any] = []
    left = list(lengths)
    for i, p in enumerate(properties):
        if p.length is None:
            fields.append((f"p{i}", order + p.type))
        else:
            fields += [(f"c{i}", order + p.length), (f"p{i}", order + p.type, (left.pop(0),))]
    return np.dtype(fields)


def _regular(source: Source, start: int, element: Element, order: str) -> NDArray[Any] | None:
    """View the rows as a table if every list is as long as in the first row."""
    lengths: list[int] = []
    p = start
    for field in element.properties:
        if field.length is None:
            p += np.dtype(field.type).itemsize
            continue
        kind = np.dtype(order + field.length)
        if p + kind.itemsize > len(source.data) or element.rows == 0:
            return None
        length = int(np.frombuffer(source.data, kind, 1, p)[0])
        if not 0 <= length <= len(source.data):
            return None
        lengths.append(length)
        p += kind.itemsize + length * np.dtype(field.type).itemsize
    if element.rows * (p - start) > len(source.data) - start:
        return None
    rows = np.frombuffer(
        source.data, _table(element.properties, lengths, order), element.rows, start
    )
    left = iter(lengths)
    for i, field in enumerate(element.properties):
        if field.length is not None and (rows[f"c{i}"] != next(left)).any():
            return None
    return rows


def _read_irregular(
    source: Source, start: int, element: Element, order: str, which: int, turn: int
) -> Rows:
    properties = element.properties
    sizes = np.array([np.dtype(p.type).itemsize for p in properties])
    counts = np.array(
        [np.dtype(p.length or "i1").itemsize * (p.length is not None) for p in properties]
    )
    signed = np.array([p.length is not None and p.length[0] == "i" for p in properties])
    places = np.empty((element.rows, len(properties)), np.int64)
    big = order == ">"
    end, row = _walk(source.data, start, sizes, counts, signed, big, places)
    if row < element.rows:
        raise source.at_byte(
            end,
            f"expected row {row + 1} of {element.rows} of the element {element.name!r}, found a "
            "negative length of a list or the end of the file",
        )
    scalars: dict[str, NDArray[Any]] = {}
    for i, p in enumerate(properties):
        if p.length is None:
            kind = np.dtype(order + p.type)
            raw = source.data[places[:, i, None] + np.arange(kind.itemsize)]
            scalars[p.name] = np.ascontiguousarray(raw).view(kind)[:, 0]
    lists: list[Any] = [None, None]
    for k, place in enumerate((which, turn)):
        if place >= 0 and counts[place]:
            count = (int(counts[place]), bool(signed[place]))
            lengths, total = _lengths(source.data, places[:, place], *count, big)
            first = places[:, place] + count[0]
            form = np.dtype(order + properties[place].type)
            if k == 0:
                values = np.empty(total, np.int64)
                size = int(sizes[place])
                _gather(source.data, first, lengths, size, form.kind == "i", big, values)
            else:
                values = _gathered(source.data, first, lengths, form)
            lists[k] = values, lengths
    return Rows(scalars, lists[0], lists[1], end)


def _gathered(
    b: NDArray[np.uint8], first: Integers, lengths: Integers, kind: np.dtype[Any]
) -> NDArray[np.float64]:
    """Return the numbers of lists that begin at these bytes, one list after the other."""
    before = np.cumsum(lengths) - lengths
    within = np.arange(int(lengths.sum())) - np.repeat(before, lengths)
    starts = np.repeat(first, lengths) + within * kind.itemsize
    raw = np.ascontiguousarray(b[starts[:, None] + np.arange(kind.itemsize)])
    return raw.view(kind)[:, 0].astype(np.float64)


@kernel
def load_integer(b: Any, p: int, size: int, signed: bool, big: bool) -> int:
    """Return the integer of ``size`` bytes at p; four bytes at most.

    Examples
    --------
    >>> import numpy as np
    >>> bytes_ = np.array([255, 254], np.uint8)
    >>> load_integer(bytes_, 0, 2, True, True), load_integer(bytes_, 0, 2, False, False)
    (-2, 65279)
    """
    value: Any = 0
    for i in range(size):
        value = 256 * value + np.int64(b[p + i if big else p + size - 1 - i])
    if signed and value >= 1 << (8 * size - 1):
        value -= 1 << (8 * size)
    return value


@kernel
def _walk(b: Any, p: int, sizes: Any, counts: Any, signed: Any, big: bool, places: Any) -> Any:
    """Note where each property of each row stands: (position, complete rows)."""
    end = b.size
    for row in range(places.shape[0]):
        start = p
        for k in range(sizes.size):
            places[row, k] = p
            length = 1
            if counts[k]:
                if counts[k] > end - p:
                    return start, row
                length = load_integer(b, p, counts[k], signed[k], big)
                p += counts[k]
            if length < 0 or length * sizes[k] > end - p:
                return start, row
            p += length * sizes[k]
    return p, places.shape[0]


@kernel
def _lengths(b: Any, places: Any, size: int, signed: bool, big: bool) -> Any:
    lengths = np.empty(places.size, np.int64)
    total = 0
    for row in range(places.size):
        lengths[row] = load_integer(b, places[row], size, signed, big)
        total += lengths[row]
    return lengths, total


@kernel
def _gather(
    b: Any, places: Any, lengths: Any, size: int, signed: bool, big: bool, values: Any
) -> None:
    k = 0
    for row in range(places.size):
        for i in range(lengths[row]):
            values[k] = load_integer(b, places[row] + i * size, size, signed, big)
            k += 1
