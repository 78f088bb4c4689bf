"""The rows of a PLY element written as text."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats, Integers
from beltrami._jit import kernel
from beltrami.errors import FileFormatError
from beltrami.io.numbers import read_number
from beltrami.io.ply_header import Element, Property
from beltrami.io.source import Source, trimmed

_DONE, _NOT_NUMBER, _NOT_IN_TYPE, _NOT_LENGTH = range(4)


def read_text(
    source: Source, start: int, element: Element, wanted: str | None
) -> tuple[dict[str, NDArray[Any]], tuple[Integers, Integers] | None, int]:
    """Read the rows of an element: scalars by name, one list (values, lengths), the position.

    Raises
    ------
    FileFormatError
        With the line, for what is no number, or one that its type cannot hold.
    """
    properties = element.properties
    names = [p.name for p in properties]
    which = names.index(wanted) if wanted in names else -1
    listed = np.array([p.length is not None for p in properties], np.bool_)
    bounds = np.array([_bounds(p.type) for p in properties]).reshape(-1, 2)
    scalars = np.empty((element.rows if len(properties) else 0, int((~listed).sum())))
    has_list = which >= 0 and bool(listed[which])
    lengths = np.empty(element.rows if has_list else 0, np.int64)
    values = np.empty((len(source.data) - start) // 2 + 1 if has_list else 0, np.int64)
    rows = element.rows if len(properties) else 0
    position, filled, status = _rows(
        source.data,
        start,
        rows,
        listed,
        bounds,
        which if has_list else -1,
        scalars,
        lengths,
        values,
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
    found = (trimmed(values, filled), lengths) if has_list else None
    return table, found, position


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
    scalars: Any,
    lengths: Any,
    values: Any,
) -> Any:
    """Read all rows: (position, values of the wanted list, status)."""
    end = b.size
    filled = 0
    for row in range(rows):
        column = 0
        for k in range(listed.size):
            length: Any = 1
            if listed[k]:
                p = next_token(b, p)
                number, q = read_number(b, p, end)
                if q == p or not 0.0 <= number <= end or number != np.floor(number):
                    return p, filled, _NOT_LENGTH
                length = np.int64(number)
                p = q
                if k == which:
                    lengths[row] = length
            for _ in range(length):
                p = next_token(b, p)
                number, q = read_number(b, p, end)
                if q == p:
                    return p, filled, _NOT_NUMBER
                low, high = bounds[k, 0], bounds[k, 1]
                if low <= high and not (low <= number <= high and number == np.floor(number)):
                    return p, filled, _NOT_IN_TYPE
                if k == which:
                    values[filled] = np.int64(number)
                    filled += 1
                elif not listed[k]:
                    scalars[row, column] = number
                    column += 1
                p = q
    return p, filled, _DONE
