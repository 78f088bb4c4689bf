"""Formats whose numbers are compressed inside: how much they hold, before a package unpacks it."""

from __future__ import annotations

import base64
import lzma
import math
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, Final
from xml.etree import ElementTree as ET
from xml.parsers import expat

import numpy as np

from beltrami.errors import FileFormatError
from beltrami.io.unpacking import Room, inflated

_BLOCK: Final = 1 << 20
_RAW: Final = re.compile(b'<AppendedData[^>]+">')
_ORDERS: Final = {"LittleEndian": "<", "BigEndian": ">"}
_HEADS: Final = {"UInt32": "u4", "UInt64": "u8"}


def require_room(path: Path, suffix: str, room: Room) -> None:
    """Raise FileFormatError if what is compressed inside a file is more than it may unpack to."""
    if suffix not in _LOOKS:
        return
    try:
        for block in _LOOKS[suffix](path, room.path):
            room.take(len(block))
    except FileFormatError:
        raise
    except Exception as cause:  # of the parsers, on a broken file
        reason = f"{type(cause).__name__}: {cause}"
        raise FileFormatError(room.path, f"expected a {suffix} file ({reason})") from cause


def _of_gifti(path: Path, name: object) -> Iterator[bytes]:
    """Unpack each array of a GIFTI file as far as its sizes say, and a byte more."""
    arrays: list[tuple[int, list[str]]] = []
    most, inside = [-1], [False]  # of the array that was begun last; in its data

    def start(name: str, attributes: dict[str, str]) -> None:
        if inside[0]:
            raise ValueError(f"{name} in Data")
        if name == "DataArray":
            sizes = [int(v) for key, v in attributes.items() if re.fullmatch(r"Dim\d", key)]
            packed = "gz" in attributes.get("Encoding", "gz").lower()
            most[0] = 8 * math.prod(sizes) if packed else -1
        if name == "Data":
            inside[0] = True
            arrays.append((most[0], []))

    def end(name: str) -> None:
        inside[0] = inside[0] and name != "Data"

    def text(piece: str) -> None:
        if inside[0] and arrays[-1][0] >= 0:
            arrays[-1][1].append(piece)

    parser = expat.ParserCreate()
    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.CharacterDataHandler = text
    with path.open("rb") as file:
        parser.ParseFile(file)
    for size, pieces in arrays:
        found = 0
        for block in inflated(base64.b64decode("".join(pieces))) if size >= 0 else ():
            found += len(block)
            if found > size:
                raise FileFormatError(
                    name, f"expected at most {size} bytes in an array, as it says, found more"
                )
            yield block


def _of_vtu(path: Path, _name: object) -> Iterator[bytes]:
    """Unpack the blocks of all arrays of a VTU file, whichever of its three ways they stand in."""
    root, data = _tree(path.read_bytes())
    compressor = root.get("compressor")
    if compressor is None:
        return
    unpack = one_stream if compressor == "vtkLZMADataCompressor" else inflated
    kind = np.dtype(
        _ORDERS[root.get("byte_order", "LittleEndian")] + _HEADS[root.get("header_type", "UInt32")]
    )
    if data is not None:
        yield from _of_bytes(data, kind, unpack)
        return
    appended = "".join(part.text or "" for part in root.findall("AppendedData")).strip()
    for array in root.iter():
        if array.get("format") == "binary":
            yield from _of_text((array.text or "").strip(), 0, kind, unpack)
        elif array.get("format") == "appended":
            at = int(array.get("offset", "0"))
            if at < 0:
                raise ValueError(f"an array at {at}")
            yield from _of_text(appended, 1 + at, kind, unpack)


def _tree(content: bytes) -> tuple[ET.Element, bytes | None]:
    """Return the elements, and the raw bytes among them where the whole is no XML.

    They are told apart as meshio does, or it might unpack what was not looked into.
    """
    try:
        return ET.fromstring(content), None  # noqa: S314 - expat bounds what entities become
    except ET.ParseError:
        found, end = _RAW.search(content), content.find(b"</AppendedData>")
        if found is None:
            raise
    rest = content[: found.end()] + content[end:]
    data = content[found.end() : end].partition(b"_")[2].rsplit(b"\n", 1)[0]
    return ET.fromstring(rest.decode()), data  # noqa: S314 - as above


def _of_text(
    text: str, at: int, kind: np.dtype[Any], unpack: Callable[[bytes], Iterator[bytes]]
) -> Any:
    """Unpack the array in base64 that begins there: sizes of blocks, then the blocks.

    The text is not copied: a file may name many arrays in one long text.
    """
    count = int(np.frombuffer(_decoded(text, at, kind.itemsize), kind, 1)[0])
    head = (3 + count) * kind.itemsize
    sizes = np.frombuffer(_decoded(text, at, head), kind)[3:].tolist()
    blocks = _decoded(text, at + _letters(head), sum(sizes))
    yield from _of_blocks(blocks, sizes, unpack)


def _of_bytes(data: bytes, kind: np.dtype[Any], unpack: Callable[[bytes], Iterator[bytes]]) -> Any:
    """Unpack arrays that follow each other."""
    at = 0
    while at + 3 * kind.itemsize <= len(data):
        count = int(np.frombuffer(data, kind, 1, at)[0])
        sizes = np.frombuffer(data, kind, 3 + count, at)[3:].tolist()
        at += (3 + count) * kind.itemsize
        yield from _of_blocks(data[at : at + sum(sizes)], sizes, unpack)
        at += sum(sizes)


def _of_blocks(
    data: bytes, sizes: list[int], unpack: Callable[[bytes], Iterator[bytes]]
) -> Iterator[bytes]:
    if len(data) != sum(sizes):
        raise ValueError(f"{len(data)} bytes where the blocks have {sum(sizes)}")
    at = 0
    for size in sizes:
        yield from unpack(data[at : at + size])
        at += size


def _letters(size: int) -> int:
    """Return how many letters of base64 so many bytes take."""
    return 4 * -(-size // 3)


def _decoded(text: str, at: int, size: int) -> bytes:
    return base64.b64decode(text[at : at + _letters(size)])[:size]


def one_stream(data: bytes) -> Iterator[bytes]:
    """Decompress one stream of LZMA, a block at a time; no other one may follow."""
    unpacker = lzma.LZMADecompressor(memlimit=1 << 28)
    while not unpacker.eof:
        block = unpacker.decompress(data, _BLOCK)
        if not block and unpacker.needs_input:
            return
        yield block
        data = b""
    if unpacker.unused_data:
        raise ValueError("something follows the stream of LZMA")


_LOOKS: Final[dict[str, Callable[[Path, object], Iterator[bytes]]]] = {
    ".gii": _of_gifti,
    ".vtu": _of_vtu,
}
