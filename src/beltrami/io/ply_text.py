"""The rows of a PLY element written as text."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats
from beltrami._jit import kernel
from beltrami.errors import FileFormatError
from beltrami.io.numbers import read_number
from beltrami.io.ply_header import Element, Property, Rows
from beltrami.io.source import Source, trimmed

_DONE, _NOT_NUMBER, _NOT_IN_TYPE, _NOT_LENGTH = range(4)


def read_text(
    source: Source, start: int, element: Element, wanted: str | None, turns: str | None
) -> Rows:
    """Read the rows of an element, with one list of integers, and one of floating point.

    Raises
    ------
    FileFormatError
        With the line, for what is no number, or one that its type cannot hold.
    """
    properties = element.properties
    names = [p.name for p in properties]
    listed = np.array([p.length is not None for p in properties], np.bool_)
    bounds = np.array([_bounds(p.type) for p in properties]).reshape(-1, 2)
    scalars = np.empty((element.rows if len(properties) else 0, int((~listed).sum())))
    rows = len(scalars)
    kinds = ((wanted, np.int64), (turns, np.float64))
    lists = [_Room.of(source, start, rows, names, *kind) for kind in kinds]
    held = [array for room in lists for array in (room.lengths, room.values)]
    position, filled, status = _rows(
        source.data, start, rows, listed, bounds, lists[0].place, lists[1].place, scalars, *held
    )
    if status != _DONE:
        expected = {
            _NOT_NUMBER: f"a number (element {element.name!r} has {element.rows} rows)",
            _NOT_IN_TYPE: "an integer within the type of its property",
            _NOT_LENGTH: "the length of a list",
        }
        raise source.unexpected(position, expected[status])
    kept = [p for p in properties if p.length is None]
    table = {p.name: _cast(source, element, p, scalars[:, i]) for i, p in enumerate(kept)}
    corners, textures = (
        (trimmed(room.values, count), room.lengths) if room.place >= 0 else None
        for room, count in zip(lists, filled, strict=True)
    )
    return Rows(table, corners, textures, position)


class _Room(NamedTuple):
    """The place of a list among the properties, -1 for none, and room for what is in it."""

    place: int
    lengths: NDArray[np.int64]
    values: NDArray[Any]

    @classmethod
    def of(
        cls, source: Source, start: int, rows: int, names: list[str], name: str | None, kind: Any
    ) -> _Room:
        place = names.index(name) if name in names else -1
        size = (len(source.data) - start) // 2 + 1 if place >= 0 else 0
        return cls(place, np.empty(rows if place >= 0 else 0, np.int64), np.empty(size, kind))


def _cast(source: Source, element: Element, p: Property, column: Floats) -> NDArray[Any]:
    """Give a column the type of its property, which must be able to hold it."""
    with np.errstate(over="ignore"):
        result = column.astype(p.type)
    lost = np.flatnonzero(np.isinf(result) & np.isfinite(column))
    if len(lost):
        raise FileFormatError(
            source.path,
            f"expected numbers that a {p.type} can hold in the property {p.name!r}, found "
            f"{column[lost[0]]:g} in row {lost[0]} of the element {element.name!r}",
        )
    return result


def _bounds(kind: str) -> tuple[float, float]:
    """Return the range of an integer type; for the others one that is empty."""
    if kind[0] == "f":
        return 1.0, 0.0
    info = np.iinfo(kind)
    return float(info.min), float(info.max)


@kernel
def next_token(b: Any, p: int) -> int:
    r"""Skip blanks and newlines.

    Examples
    --------
    >>> import numpy as np
    >>> next_token(np.frombuffer(b" \n 7", np.uint8), 0)
    3
    """
    while p < b.size and b[p] <= 32:
        p += 1
    return p


@kernel
def _rows(
    b: Any,
    p: int,
    rows: int,
    listed: Any,
    bounds: Any,
    which: int,
    turn: int,
    scalars: Any,
    lengths: Any,
    values: Any,
    turn_lengths: Any,
    turns: Any,
) -> Any:
    """Read all rows: (position, values of the two wanted lists, status)."""
    end = b.size
    filled = turned = 0
    for row in range(rows):
        column = 0
        for k in range(listed.size):
            length: Any = 1
            if listed[k]:
                p = next_token(b, p)
                number, q = read_number(b, p, end)
                if q == p or not 0.0 <= number <= end or number != np.floor(number):
                    return p, (filled, turned), _NOT_LENGTH
                length = np.int64(number)
                p = q
                if k == which:
                    lengths[row] = length
                elif k == turn:
                    turn_lengths[row] = length
            for _ in range(length):
                p = next_token(b, p)
                number, q = read_number(b, p, end)
                if q == p:
                    return p, (filled, turned), _NOT_NUMBER
                low, high = bounds[k, 0], bounds[k, 1]
                if low <= high and not (low <= number <= high and number == np.floor(number)):
                    return p, (filled, turned), _NOT_IN_TYPE
                if k == which:
                    values[filled] = np.int64(number)
                    filled += 1
                elif k == turn:
                    turns[turned] = number
                    turned += 1
                elif not listed[k]:
                    scalars[row, column] = number
                    column += 1
                p = q
    return p, (filled, turned), _DONE
