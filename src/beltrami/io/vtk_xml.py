"""The XML files of VTK: their elements, and the numbers of an array, wherever these stand."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, Final
from xml.parsers import expat

import numpy as np
from numpy.typing import NDArray

from beltrami.errors import FileFormatError
from beltrami.io.source import Source
from beltrami.io.unpacking import Room
from beltrami.io.vtk_cursor import read_numbers
from beltrami.io.vtk_packing import ORDERS, Packing

TYPES: Final = {
    "Int8": "i1", "UInt8": "u1", "Int16": "i2", "UInt16": "u2", "Int32": "i4", "UInt32": "u4",
    "Int64": "i8", "UInt64": "u8", "Float32": "f4", "Float64": "f8",
}  # fmt: skip
_HEADS: Final = {"UInt32": "u4", "UInt64": "u8"}
_END: Final = b"</AppendedData>"


@dataclass
class Element:
    """An element of the file: its name, attributes, text before and between, what is in it."""

    name: str
    attributes: dict[str, str]
    pieces: list[str] = field(default_factory=list)
    inside: list[Element] = field(default_factory=list)

    def named(self, name: str) -> Iterator[Element]:
        """Run through the elements of a name that are in this one."""
        return (element for element in self.inside if element.name == name)


class VtkXml:
    r"""A file: its elements are read at once, its arrays when they are asked for.

    Raises
    ------
    FileFormatError
        If it is no XML, or says of itself what VTK does not know.

    Notes
    -----
    Source: Kitware, *VTK File Formats*, "XML File Formats".

    Examples
    --------
    >>> text = b'<VTKFile type="PolyData"><DataArray type="Int8" format="ascii"> 1 2 </DataArray>'
    >>> file = VtkXml(Source("a.vtp", np.frombuffer(text + b"</VTKFile>", np.uint8)), Room("", 9))
    >>> file.array(next(file.root.named("DataArray")), 2).tolist()
    [1, 2]
    """

    def __init__(self, source: Source, room: Room) -> None:
        self.path, self._text = source.path, source.data.tobytes()
        self._appended = (0, 0)  # where the letters or bytes at the end of the file are
        self._encoded = True
        self.root = self._parsed()
        told = self.root.attributes
        order = self._one_of(told.get("byte_order", "LittleEndian"), ORDERS)
        head = self._one_of(told.get("header_type", "UInt32"), _HEADS)
        self._order = order
        try:
            self._packing = Packing(np.dtype(order + head), told.get("compressor", ""), room)
        except KeyError:
            raise self.wrong(f"no compressor {told['compressor']!r} of VTK") from None

    def wrong(self, problem: str) -> FileFormatError:
        """Make the error for this file."""
        return FileFormatError(self.path, problem)

    def whole(self, element: Element, name: str, default: str = "0") -> int:
        """Return an attribute that is a number of things."""
        told = element.attributes.get(name, default)
        if not (told.isascii() and told.strip().isdecimal()) or len(told) > 40:
            raise self.wrong(f"expected a count as {name} of {element.name}, found {told[:40]!r}")
        return int(told)

    def array(self, element: Element, count: int) -> NDArray[Any]:
        """Return so many numbers of an array, in the type that it says.

        Raises
        ------
        FileFormatError
            If they are not there, or more of them are; it is asked before there is an array.
        """
        told = element.attributes
        name = told.get("Name", element.name)
        dtype = np.dtype(self._order + self._one_of(told.get("type", ""), TYPES))
        form = told.get("format", "ascii")
        if form == "ascii":
            return self._ascii("".join(element.pieces), dtype.newbyteorder("="), count, name)
        size = count * dtype.itemsize
        try:
            if form == "binary":
                letters = "".join("".join(element.pieces).split()).encode("ascii")
                data = self._packing.encoded(letters, 0, len(letters), size)
            elif form == "appended":
                start, end = self._appended
                at = start + self.whole(element, "offset", "none")
                read = self._packing.encoded if self._encoded else self._packing.raw
                data = read(self._text, at, end, size)
            else:
                raise self.wrong(f"expected ascii, binary or appended, found the format {form!r}")
        except ValueError as cause:
            raise self.wrong(f"expected {size} bytes in the array {name!r}: {cause}") from cause
        return np.frombuffer(data, dtype).astype(dtype.newbyteorder("="))

    def _ascii(self, text: str, dtype: np.dtype[Any], count: int, name: str) -> NDArray[Any]:
        if 2 * count - 1 > len(text):
            raise self.wrong(f"expected {count} numbers in the array {name!r}, found fewer")
        read = np.empty(count)
        letters = np.frombuffer(text.encode() or b" ", np.uint8)
        end, so_far = read_numbers(letters, 0, read)
        if so_far < count or text.encode()[end:].strip():
            found = text.encode()[end : end + 40].split()
            told = repr(found[0].decode("latin-1")) if found else "the end"
            raise self.wrong(
                f"expected {count} numbers in the array {name!r}, found {told} after {so_far}"
            )
        with np.errstate(invalid="ignore", over="ignore"):
            kept = read.astype(dtype)
        if dtype.kind in "iu" and not (kept == read).all():
            raise self.wrong(f"expected whole numbers of {dtype} in the array {name!r}")
        return kept

    def _one_of(self, told: str, known: dict[str, str]) -> str:
        if told not in known:
            raise self.wrong(f"expected one of {', '.join(known)}, found {told[:40]!r}")
        return known[told]

    # ---------------------------------------------------------------- the XML

    def _parsed(self) -> Element:
        """Return the first element; what stands after <AppendedData> need not be XML."""
        open_, top = [], Element("", {})
        open_.append(top)
        parser = expat.ParserCreate()
        parser.buffer_text = True

        def start(name: str, attributes: dict[str, str]) -> None:
            if name == "AppendedData":
                raise _Appended(parser.CurrentByteIndex, attributes.get("encoding", ""))
            open_[-1].inside.append(Element(name, attributes))
            open_.append(open_[-1].inside[-1])

        def end(_name: str) -> None:
            open_.pop()

        def text(piece: str) -> None:
            if open_[-1].name == "DataArray":
                open_[-1].pieces.append(piece)

        parser.StartElementHandler, parser.EndElementHandler = start, end
        parser.CharacterDataHandler = text
        try:
            parser.Parse(self._text, True)
        except expat.ExpatError as cause:
            problem = f"expected XML, found {expat.ErrorString(cause.code)}"
            raise FileFormatError(self.path, problem, line=cause.lineno) from cause
        except _Appended as found:
            self._at_end(found)
        if [element.name for element in top.inside] != ["VTKFile"]:
            raise self.wrong("expected the element VTKFile, found another one")
        return top.inside[0]

    def _at_end(self, found: _Appended) -> None:
        if found.encoding not in ("base64", "raw"):
            raise self.wrong(
                f"expected the encoding base64 or raw of AppendedData, found {found.encoding!r}"
            )
        self._encoded = found.encoding == "base64"
        begin = re.compile(rb">\s*_").search(self._text, found.place)
        end = self._text.rfind(_END)
        if begin is None or end < begin.end():
            raise self.wrong(f"expected _ and {_END.decode()} around the data: the file is cut off")
        self._appended = begin.end(), end


class _Appended(Exception):  # noqa: N818 - it ends the reading of elements, and is no error
    def __init__(self, place: int, encoding: str) -> None:
        self.place, self.encoding = place, encoding
