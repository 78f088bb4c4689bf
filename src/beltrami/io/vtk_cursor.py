"""Lines and arrays of a legacy VTK file, one after the other."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami._jit import kernel
from beltrami.io.numbers import read_number
from beltrami.io.source import Source

_TYPES = {
    "char": "i1", "signed_char": "i1", "unsigned_char": "u1", "short": "i2",
    "unsigned_short": "u2", "int": "i4", "unsigned_int": "u4", "long": "i8",
    "unsigned_long": "u8", "vtkidtype": "i4", "float": "f4", "double": "f8",
    "vtktypeint8": "i1", "vtktypeuint8": "u1", "vtktypeint16": "i2", "vtktypeuint16": "u2",
    "vtktypeint32": "i4", "vtktypeuint32": "u4", "vtktypeint64": "i8", "vtktypeuint64": "u8",
    "vtktypefloat32": "f4", "vtktypefloat64": "f8",
}  # fmt: skip
_BLOCK = 256  # bytes that are searched at a time
_END = 10


class VtkCursor:
    r"""A place in a legacy VTK file, which goes forward.

    Examples
    --------
    >>> cursor = VtkCursor(Source("a.vtk", np.frombuffer(b"POINTS 1 float\n0 .5 1\n", np.uint8)))
    >>> cursor.words(), cursor.array("float", 3).tolist()
    (['POINTS', '1', 'float'], [0.0, 0.5, 1.0])
    """

    def __init__(self, source: Source) -> None:
        self.source = source
        self.position = 0
        self.binary = False
        self._start = 0  # of the line read last

    def line(self) -> str:
        """Read the rest of this line."""
        self._start = start = self.position
        data = self.source.data
        while self.position < len(data):
            ends = np.flatnonzero(data[self.position : self.position + _BLOCK] == _END)
            self.position += int(ends[0]) if len(ends) else _BLOCK
            if len(ends):
                break
        text = data[start : self.position].tobytes().decode("latin-1").strip()
        self.position = min(self.position + 1, len(data))
        return text

    def words(self) -> list[str]:
        """Read the next line that is not empty, as words; none at the end of the file."""
        while self.position < len(self.source.data):
            words = self.line().split()
            if words:
                return words
        return []

    def back(self) -> None:
        """Go back to the beginning of the line read last."""
        self.position = self._start

    def unexpected(self, expected: str) -> Exception:
        """Make the error for the line read last."""
        if self.binary:
            start = min(self._start, len(self.source.data))
            found = self.source.data[start : start + 40].tobytes().split(b"\n")[0]
            return self.source.at_byte(start, f"expected {expected}, found {found!r}")
        return self.source.unexpected(self._start, expected)

    def count(self, words: list[str], place: int) -> int:
        """Return a word of the line read last as a number of things."""
        if place >= len(words) or not words[place].isdecimal() or len(words[place]) > 15:
            raise self.unexpected("a count")
        return int(words[place])

    def skip_metadata(self) -> None:
        """Skip to the next empty line."""
        while self.position < len(self.source.data) and self.line():
            pass

    def array(self, kind: str, count: int) -> NDArray[Any]:
        """Read so many numbers of a type of VTK.

        Raises
        ------
        FileFormatError
            If the type has no numbers, or they are not there; it is asked before there is an array.
        """
        name = _TYPES.get(kind.lower())
        if name is None:
            raise self.unexpected(f"one of the types {', '.join(list(_TYPES)[:12])}")
        dtype, left = np.dtype(name), len(self.source.data) - self.position
        least = count * dtype.itemsize if self.binary else 2 * count - 1
        if least > left:
            problem = f"expected {count} numbers, at least {least} bytes, found {max(left, 0)}"
            raise self.source.at_byte(self.position, f"{problem}: the file is cut off")
        if self.binary:
            begin, self.position = self.position, self.position + least
            read = self.source.data[begin : self.position].view(dtype.newbyteorder(">"))
            return read.astype(dtype)
        values = np.empty(count)
        self.position, read_so_far = read_numbers(self.source.data, self.position, values)
        if read_so_far < count:
            raise self.source.unexpected(self.position, f"a number ({read_so_far} of {count})")
        with np.errstate(invalid="ignore", over="ignore"):
            kept = values.astype(dtype)
        if dtype.kind in "iu" and not (kept == values).all():
            raise self.source.unexpected(self.position, f"whole numbers of the type {kind}")
        return kept


@kernel
def read_numbers(b: Any, p: Any, values: Any) -> Any:
    """Read numbers parted by blanks and ends of lines: (position, how many were read)."""
    end = b.size
    for k in range(values.size):
        while p < end and b[p] <= 32:
            p += 1
        value, after = read_number(b, p, end)
        if after == p:
            return p, k
        values[k] = value
        p = after
    return p, values.size
