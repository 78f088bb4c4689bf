"""The container: a magic number, a version, features, sections with lengths and checksums."""

from __future__ import annotations

import os
import zlib
from dataclasses import dataclass

from beltrami.compression.varint import Reader, to_varints
from beltrami.io.source import load

MAGIC = b"\x89BTM"
VERSION = 1

# Sections; each at most once, but for functions.
CONNECTIVITY, GRID, ORDER, DATA, UV, SPECTRUM, PREDICTED, PREDICTED_UV = range(1, 9)
NAMES = {
    CONNECTIVITY: "connectivity",
    GRID: "positions on a grid",
    ORDER: "order of the vertices",
    DATA: "functions",
    UV: "texture coordinates",
    SPECTRUM: "positions in a spectrum",
    PREDICTED: "predicted functions",
    PREDICTED_UV: "predicted texture coordinates",
}
# Their order in the file; of one rank in any order.
_RANKS = {CONNECTIVITY: 0, GRID: 1, ORDER: 2, SPECTRUM: 3, DATA: 4, PREDICTED: 4, UV: 5}
_RANKS[PREDICTED_UV] = 6
_SEVERAL = (DATA, PREDICTED)

# Features that a reader must know; a bit of the sixth byte each.
FEATURES = {
    1: "the order of the vertices is kept",
    2: "beginnings with all faces and first coefficients are coarser shapes",
    4: "functions are predicted",
}
KEEPS_ORDER, PROGRESSIVE, PREDICTS = FEATURES


@dataclass(frozen=True)
class Section:
    """A section: its kind, its bytes, where these begin in the file, whether some are missing."""

    kind: int
    payload: bytes
    start: int = 0
    is_cut: bool = False

    def reader(self, path: object) -> Reader:
        """Read its bytes."""
        return Reader(self.payload, path, self.start)


def bytes_of(source: bytes | str | os.PathLike[str]) -> tuple[bytes, object]:
    """Return (bytes, name for errors) of a file, or of bytes themselves."""
    if isinstance(source, bytes | bytearray | memoryview):
        return bytes(source), "<bytes>"
    return load(source).data.tobytes(), source


def pack(features: int, sections: list[Section]) -> bytes:
    """Put sections together; each has the checksum of all bytes before it.

    Examples
    --------
    >>> data = pack(0, [Section(GRID, b"abc")])
    >>> data[:7].hex(), len(data), unpack(data, "a.btm")[1][0].payload
    ('8942544d010001', 16, b'abc')
    """
    parts = [MAGIC + bytes([VERSION, features]) + to_varints([len(sections)])]
    checksum = zlib.crc32(parts[0])
    for section in sections:
        part = to_varints([section.kind, len(section.payload)]) + section.payload
        ending = zlib.crc32(part, checksum).to_bytes(4, "little")
        checksum = zlib.crc32(part + ending, checksum)
        parts += [part, ending]
    return b"".join(parts)


def unpack(data: bytes, path: object, partial: bool = False) -> tuple[int, list[Section]]:
    """Return the features and the sections of a file, after all checks.

    With ``partial`` the data may end anywhere after the number of sections: the last one that
    is returned may be cut off, and has then no checksum.

    Raises
    ------
    FileFormatError
        If these are not the bytes of a whole file of a version and with features known here.
    """
    reader = Reader(data, path)
    if data[:4] != MAGIC:
        raise reader.fault("not a .btm file: it does not begin with 89 42 54 4d")
    reader.take(4)
    version, features = reader.take(1)[0], reader.take(1)[0]
    if version != VERSION:
        raise reader.fault(f"version {version} of the format; this reads version {VERSION}")
    unknown = features & ~sum(FEATURES)
    if unknown:
        raise reader.fault(f"features {unknown:#04x} of a later beltrami, unknown here")
    sections: list[Section] = []
    count = reader.varint(1 << 16, "sections")
    checksum = zlib.crc32(data[: reader.position])
    for _ in range(count):
        if partial and reader.position == len(data):
            break
        section, checksum = _section(reader, partial, checksum)
        sections.append(section)
    if reader.position != len(data):
        raise reader.fault(f"{len(data) - reader.position} bytes after the last section")
    kinds = [section.kind for section in sections]
    twice = [k for k in NAMES if kinds.count(k) > 1 and k not in _SEVERAL]
    if kinds != sorted(kinds, key=_RANKS.__getitem__) or twice:
        raise reader.fault("the sections are in a wrong order, or one is there twice")
    if not features & PREDICTS and any(k in (PREDICTED, PREDICTED_UV) for k in kinds):
        raise reader.fault("predicted functions that were not announced")
    return features, sections


def _section(reader: Reader, partial: bool, checksum: int) -> tuple[Section, int]:
    """Read a section; ``checksum`` is that of all bytes before it, and becomes that up to its end.

    So each byte is added once, however many sections there are.
    """
    first = reader.position
    kind = reader.varint()
    if kind not in NAMES:
        raise reader.fault(f"a section of the kind {kind}, unknown here")
    length = reader.varint()
    start = reader.position
    if partial and start + length + 4 > len(reader.data):
        return Section(kind, reader.rest()[:length], start, True), checksum
    payload = reader.take(length)
    checksum = zlib.crc32(reader.data[first : reader.position], checksum)
    ending = reader.take(4)
    if int.from_bytes(ending, "little") != checksum:
        raise reader.fault(f"the checksum of the section {NAMES[kind]!r} is wrong")
    return Section(kind, payload, start), zlib.crc32(ending, checksum)
