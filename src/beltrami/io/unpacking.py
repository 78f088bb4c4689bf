"""What is compressed is unpacked as far as a file of its size may go: a bomb stops early."""

from __future__ import annotations

import zlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import whole
from beltrami.errors import FileFormatError

FREE: Final = 1 << 28  # bytes that any file may unpack to
RATIO: Final = 100  # and each of its bytes: meshes have 2 to 10, gzip can reach 1032
GZIP: Final = 31  # zlib's number for its header
ZLIB: Final = 15
_BLOCK: Final = 1 << 20


@dataclass
class Room:
    """How many bytes a file may unpack to, and how many it has.

    Examples
    --------
    >>> room_of("a.off.gz", 1000).most, room_of("a.off.gz", 10**7).most
    (268435456, 1000000000)
    >>> room_of("a.off.gz", 1000, 50).take(51)
    Traceback (most recent call last):
        ...
    beltrami.errors.FileFormatError: a.off.gz: expected at most 50 bytes when it is unpacked, ...
    """

    path: object
    most: int
    used: int = 0

    def take(self, count: int) -> None:
        """Use so many bytes; FileFormatError if there are not so many left."""
        self.used += count
        if self.used > self.most:
            raise FileFormatError(
                self.path,
                f"expected at most {self.most} bytes when it is unpacked, found more: it may be a "
                "bomb. If you trust it, unpack it yourself, or read it with a larger max_bytes",
            )


def room_of(path: object, size: int, max_bytes: int | None = None) -> Room:
    """Return the room of a file of this size: 256 MiB, or 100 times the size if that is more.

    Raises
    ------
    MeshError
        If ``max_bytes``, which takes their place, is no whole number above zero.
    """
    if max_bytes is not None:
        return Room(path, whole("max_bytes", max_bytes, 1))
    return Room(path, max(FREE, RATIO * size))


def gunzipped(
    packed: NDArray[np.uint8], path: object, take: Callable[[int], None]
) -> NDArray[np.uint8]:
    """Decompress a gzip file; ``take`` is told of each block, and raises where it is too much.

    Raises
    ------
    FileFormatError
        If it is no whole gzip file.
    """
    result = bytearray()
    try:
        for block in _members(packed):
            take(len(block))
            result += block
    except (EOFError, zlib.error) as cause:
        raise FileFormatError(path, f"expected a whole gzip file ({cause})") from cause
    return np.frombuffer(result, np.uint8)


def inflated(data: bytes, wbits: int = ZLIB) -> Iterator[bytes]:
    """Decompress one stream, a block of at most a megabyte at a time."""
    unpacker = zlib.decompressobj(wbits)
    for start in range(0, len(data), _BLOCK):  # or each block would copy all that is left
        rest = data[start : start + _BLOCK]
        while rest and not unpacker.eof:
            yield unpacker.decompress(rest, _BLOCK)
            rest = unpacker.unconsumed_tail
        if unpacker.eof:
            return


def _members(packed: NDArray[np.uint8]) -> Iterator[bytes]:
    """Run through the members of a gzip file, with the zeros that may stand between them."""
    unpacker = zlib.decompressobj(GZIP)
    for start in range(0, len(packed), _BLOCK):
        rest = packed[start : start + _BLOCK].tobytes()
        while rest:
            if unpacker.eof:  # zeros to fill up, or another member
                rest = rest.lstrip(b"\0")
                if not rest:
                    break
                unpacker = zlib.decompressobj(GZIP)
            yield unpacker.decompress(rest, _BLOCK)
            rest = unpacker.unused_data if unpacker.eof else unpacker.unconsumed_tail
    if not unpacker.eof:
        raise EOFError("the end is missing")
