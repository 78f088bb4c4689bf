"""Whole numbers in bytes of seven bits (LEB128), and reading of bytes that may be wrong."""

from __future__ import annotations

from collections.abc import Iterable

from beltrami.errors import FileFormatError

_LONGEST = 9  # bytes of a number


def to_varints(numbers: Iterable[int]) -> bytes:
    """Write whole numbers >= 0: seven bits a byte, the low ones first, 128 added if more follow.

    Examples
    --------
    >>> to_varints([1, 300]).hex()
    '01ac02'
    """
    out = bytearray()
    for number in numbers:
        rest = int(number)
        while rest >= 128:
            out.append(rest % 128 + 128)
            rest //= 128
        out.append(rest)
    return bytes(out)


class Reader:
    r"""Reads numbers and bytes one after another; what is missing is a FileFormatError.

    Examples
    --------
    >>> reader = Reader(bytes.fromhex("01ac02ff"), "a.btm")
    >>> reader.varint(), reader.varint(), reader.rest()
    (1, 300, b'\xff')
    """

    def __init__(self, data: bytes, path: object, start: int = 0) -> None:
        self.data = data
        self.path = path
        self.start = start  # of the data, in the file
        self.position = 0

    def fault(self, problem: str) -> FileFormatError:
        """Make the error for what is wrong here."""
        return FileFormatError(self.path, problem, byte=self.start + self.position)

    def take(self, count: int) -> bytes:
        """Read so many bytes."""
        end = self.position + count
        if end > len(self.data):
            raise self.fault(f"expected {count} more bytes, found the end")
        taken = self.data[self.position : end]
        self.position = end
        return taken

    def rest(self) -> bytes:
        """Read all that is left."""
        return self.take(len(self.data) - self.position)

    def varint(self, most: int | None = None, what: str = "a number") -> int:
        """Read a number, at most ``most``."""
        value = 0
        for place in range(_LONGEST):
            byte = self.take(1)[0]
            value |= (byte & 127) << (7 * place)
            if byte < 128:
                break
        else:
            raise self.fault(f"expected {what}, found more than {_LONGEST} bytes of it")
        if most is not None and value > most:
            raise self.fault(f"expected {what} of at most {most}, found {value}")
        return value
