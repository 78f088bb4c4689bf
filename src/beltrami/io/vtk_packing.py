"""The bytes of an array in VTK's XML files: a head, then numbers, plain or in compressed blocks."""

from __future__ import annotations

import base64
import lzma
import zlib
from collections.abc import Callable, Iterator
from typing import Any, Final

import numpy as np

from beltrami._jit import kernel
from beltrami.io.packed_inside import one_stream
from beltrami.io.unpacking import Room, inflated

ORDERS: Final = {"LittleEndian": "<", "BigEndian": ">"}
_LZ4_RATIO: Final = 255  # no byte of LZ4 stands for more


class Packing:
    """How arrays are packed in a file: the type of their heads, and the compressor.

    A head of an array that is not compressed is the number of its bytes; of one that is, it is the
    number of blocks, the size of each, that of the last if it is another, else 0, and the sizes
    of the compressed blocks. In base64 a head and what it is before are encoded together in the
    first case, apart in the second.

    Raises
    ------
    KeyError
        If there is no such compressor.

    Examples
    --------
    >>> packing = Packing(np.dtype("<u4"), "", Room("a.vtp", 100))
    >>> packing.encoded(base64.b64encode(bytes([2, 0, 0, 0]) + b"ab"), 0, 8, 2)
    b'ab'
    """

    def __init__(self, head: np.dtype[Any], compressor: str, room: Room) -> None:
        self._head, self._room = head, room
        self._unpack = _COMPRESSORS[compressor] if compressor else None

    def raw(self, data: bytes, at: int, end: int, size: int) -> bytes:
        """Return an array of so many bytes, from bytes; ValueError if it is not there."""

        def part(begin: int, count: int) -> bytes:
            if at + begin + count > end:
                raise ValueError("the file is cut off")
            return data[at + begin : at + begin + count]

        return self._array(part, part, size)

    def encoded(self, letters: bytes, at: int, end: int, size: int) -> bytes:
        """Return an array of so many bytes, from letters of base64; ValueError as above."""

        def part(begin: int, count: int) -> bytes:
            """Decode a part of what is encoded together, from its beginning."""
            return decoded(0, begin + count)[begin:]

        def apart(begin: int, count: int) -> bytes:
            """Decode what comes after a head of so many bytes."""
            return decoded(_letters(begin), count)

        def decoded(start: int, count: int) -> bytes:
            if at + start + _letters(count) > end:
                raise ValueError("the file is cut off")
            found = base64.b64decode(letters[at + start : at + start + _letters(count)])
            if len(found) < count:
                raise ValueError("letters that are not base64")
            return found[:count]

        return self._array(part, apart, size)

    def _array(
        self, part: Callable[[int, int], bytes], after: Callable[[int, int], bytes], size: int
    ) -> bytes:
        word = self._head.itemsize
        first = int(np.frombuffer(part(0, word), self._head)[0])
        unpack = self._unpack
        if unpack is None:
            if first != size:
                raise ValueError(f"its head says {first}")
            self._room.take(size)
            return part(word, size)
        if first == 0 and size == 0:
            return b""
        if first > size:  # of blocks
            raise ValueError(f"its head says {first} blocks")
        head = np.frombuffer(part(0, (3 + first) * word), self._head).tolist()
        whole, last, sizes = head[1], head[2] or head[1], head[3:]
        if first == 0 or (first - 1) * whole + last != size:
            raise ValueError(f"its head says {first} blocks, {whole} long, the last one {last}")
        self._room.take(size)
        blocks = after((3 + first) * word, sum(sizes))
        return _unpacked(unpack, blocks, sizes, [whole] * (first - 1) + [last])


def _unpacked(
    unpack: Callable[[bytes, int], bytes], blocks: bytes, sizes: list[int], lengths: list[int]
) -> bytes:
    result, at = bytearray(), 0
    for size, length in zip(sizes, lengths, strict=True):
        result += unpack(blocks[at : at + size], length)
        at += size
    return bytes(result)


def _letters(size: int) -> int:
    """Return how many letters of base64 so many bytes take."""
    return 4 * -(-size // 3)


def _of_streams(unpack: Callable[[bytes], Iterator[bytes]]) -> Callable[[bytes, int], bytes]:
    def block(data: bytes, length: int) -> bytes:
        found = bytearray()
        try:
            for piece in unpack(data):
                found += piece
                if len(found) > length:
                    break
        except (zlib.error, lzma.LZMAError) as cause:
            raise ValueError(f"a block is broken ({cause})") from cause
        if len(found) != length:
            raise ValueError(f"a block has not the {length} bytes that its head says")
        return bytes(found)

    return block


def lz4_block(data: bytes, length: int) -> bytes:
    r"""Decompress a block of LZ4 that becomes so many bytes; ValueError if it does not.

    Literals and copies of what came before take turns: each pair begins with a byte of their two
    lengths.

    Notes
    -----
    Source: Y. Collet, *LZ4 Block Format Description*.

    Examples
    --------
    >>> lz4_block(b"\x12a\x01\x00\x30bcd", 10)
    b'aaaaaaabcd'
    """
    if length > _LZ4_RATIO * len(data):
        raise ValueError(f"a block has not the {length} bytes that its head says")
    result = np.empty(length, np.uint8)
    if _lz4(np.frombuffer(data, np.uint8), result) != length:
        raise ValueError("a block is broken (LZ4)")
    return result.tobytes()


@kernel
def _more(b: Any, p: Any, count: Any) -> Any:
    """Add to a length of 15 the bytes that follow, up to one below 255: (length, position)."""
    if count == 15:
        while p < b.size:
            count += np.int64(b[p])
            p += 1
            if b[p - 1] != 255:
                break
    return count, p


@kernel
def _lz4(b: Any, out: Any) -> int:
    """Return how many bytes were written, or -1 for what is no block of LZ4."""
    p = k = 0
    while p < b.size:
        token = np.int64(b[p])
        literals, p = _more(b, p + 1, token >> 4)
        if p + literals > b.size or k + literals > out.size:
            return -1
        for i in range(literals):
            out[k + i] = b[p + i]
        p += literals
        k += literals
        if p == b.size:
            return k
        if p + 2 > b.size:
            return -1
        back = np.int64(b[p]) + 256 * np.int64(b[p + 1])
        copied, p = _more(b, p + 2, token & 15)
        copied += 4
        if back == 0 or back > k or k + copied > out.size:
            return -1
        for i in range(copied):
            out[k + i] = out[k + i - back]
        k += copied
    return -1


_COMPRESSORS: Final[dict[str, Callable[[bytes, int], bytes]]] = {
    "vtkZLibDataCompressor": _of_streams(inflated),
    "vtkLZMADataCompressor": _of_streams(one_stream),
    "vtkLZ4DataCompressor": lz4_block,
}
