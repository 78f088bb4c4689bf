"""The header of a PLY file: elements and their properties."""

from __future__ import annotations

import re
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltrami.errors import FileFormatError
from beltrami.io.source import Source, mark_length

TYPES = {
    "char": "i1",
    "uchar": "u1",
    "short": "i2",
    "ushort": "u2",
    "int": "i4",
    "uint": "u4",
    "float": "f4",
    "double": "f8",
    "int8": "i1",
    "uint8": "u1",
    "int16": "i2",
    "uint16": "u2",
    "int32": "i4",
    "uint32": "u4",
    "float32": "f4",
    "float64": "f8",
}
ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_PAGE = 1 << 12
_LONGEST = 1 << 20  # bytes of header


class Property(NamedTuple):
    """One property: its name, its type as numpy writes it, and that of the length of a list."""

    name: str
    type: str
    length: str | None = None


class Element(NamedTuple):
    """One element: its name, how many there are, their properties."""

    name: str
    rows: int
    properties: list[Property]

    @property
    def least_bytes(self) -> int:
        """The size of a binary row whose lists are empty."""
        return sum(np.dtype(p.length or p.type).itemsize for p in self.properties)


class Rows(NamedTuple):
    """What the rows of an element say: scalars by name, two lists, and where they end.

    A list is (values, lengths): the vertices of faces or strips, and texture coordinates.
    """

    scalars: dict[str, NDArray[Any]]
    corners: tuple[NDArray[Any], NDArray[np.int64] | int] | None
    turns: tuple[NDArray[Any], NDArray[np.int64] | int] | None
    position: int


class Header(NamedTuple):
    """The byte order ("" for text), the elements, and where the data starts."""

    order: str
    elements: list[Element]
    start: int


def read_header(source: Source) -> Header:
    r"""Read the header.

    Raises
    ------
    FileFormatError
        With the line, for what is no header, and where the counts exceed the size of the file.

    Examples
    --------
    >>> import numpy as np
    >>> text = b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n7\n"
    >>> read_header(Source("a.ply", np.frombuffer(text, np.uint8))).elements[0].properties
    [Property(name='x', type='f4', length=None)]
    """
    start = mark_length(source.data)
    head = _head(source)[start:]
    if not head.startswith((b"ply\n", b"ply\r")):
        raise source.unexpected(start, "the word ply on a line of its own")
    newline = b"\n" if head.startswith((b"ply\n", b"ply\r\n")) else b"\r"
    order: str | None = None
    elements: list[Element] = []
    for number, line in enumerate(head.split(newline), 1):
        start += len(line) + 1
        words = line.decode("latin-1").split()
        if words == ["end_header"]:
            break
        if words[:1] == ["format"]:
            if len(words) < 2 or words[1] not in ORDERS:
                raise _wrong(source, number, f"a format out of {', '.join(ORDERS)}", line)
            order = ORDERS[words[1]]
        elif words[:1] == ["element"]:
            elements.append(_element(source, number, line, words))
        elif words[:1] == ["property"]:
            if not elements:
                raise _wrong(source, number, "an element before its properties", line)
            added = _property(source, number, line, words)
            if any(added.name == p.name for p in elements[-1].properties):
                raise _wrong(source, number, "each property once", line)
            elements[-1].properties.append(added)
        elif words and words[0] not in ("comment", "obj_info", "ply"):
            raise _wrong(source, number, "format, element, property, comment or end_header", line)
    else:
        raise FileFormatError(source.path, "expected a line end_header, found none")
    if order is None:
        raise FileFormatError(source.path, "expected a line 'format ...' in the header, found none")
    start = min(start, len(source.data))
    _check_counts(source, order, elements, start)
    return Header(order, elements, start)


def _head(source: Source) -> bytes:
    """Return the beginning of the file: a page, or up to the longest header if that is short."""
    page = source.data[:_PAGE].tobytes()
    return page if re.search(rb"[\r\n]end_header[\r\n]", page) else source.data[:_LONGEST].tobytes()


def _wrong(source: Source, number: int, expected: str, line: bytes) -> FileFormatError:
    found = line[:60].decode("latin-1").strip()
    return FileFormatError(source.path, f"expected {expected}, found {found!r}", line=number)


def _element(source: Source, number: int, line: bytes, words: list[str]) -> Element:
    if len(words) != 3 or not (words[2].isascii() and words[2].isdigit() and len(words[2]) < 19):
        raise _wrong(source, number, "'element NAME COUNT' with a count of 0 or more", line)
    return Element(words[1], int(words[2]), [])


def _property(source: Source, number: int, line: bytes, words: list[str]) -> Property:
    if len(words) == 3 and words[1] in TYPES:
        return Property(words[2], TYPES[words[1]])
    if len(words) == 5 and words[1] == "list" and words[2] in TYPES and words[3] in TYPES:
        if TYPES[words[2]][0] != "f":
            return Property(words[4], TYPES[words[3]], TYPES[words[2]])
        raise _wrong(source, number, "an integer type for the count of a list", line)
    kinds = "char uchar short ushort int uint float double"
    raise _wrong(source, number, f"'property [list TYPE] TYPE NAME', TYPE out of {kinds}", line)


def _check_counts(source: Source, order: str, elements: list[Element], start: int) -> None:
    """Refuse counts that the file is too short for, before anything is allocated."""
    left = len(source.data) - start
    for element in elements:
        row = element.least_bytes if order else 2 * len(element.properties)
        left -= element.rows * row
        if left < (0 if order else -1):
            raise source.at_byte(
                len(source.data),
                f"expected {element.rows} rows of the element {element.name!r}, at least "
                f"{element.rows * row} bytes, found {max(left + element.rows * row, 0)}: the "
                "file is cut off or its counts are wrong",
            )
