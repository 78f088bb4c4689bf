"""The bytes of a file, and errors that say where in them something is wrong."""

from __future__ import annotations

import gzip
import os
import zlib
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltrami.errors import FileFormatError

_SHOWN = 40  # of the bytes at fault


class Source(NamedTuple):
    r"""A file read into memory: its name and its bytes.

    Examples
    --------
    >>> import numpy as np
    >>> source = Source("a.off", np.frombuffer(b"OFF\n3 x 0", np.uint8))
    >>> print(source.unexpected(6, "an integer"))
    a.off, line 2: expected an integer, found 'x'
    """

    path: Path | str
    data: NDArray[np.uint8]

    def line_at(self, position: int) -> int:
        """Return the number of the line, from 1, at this position."""
        return 1 + int(np.count_nonzero(self.data[:position] == 10))

    def unexpected(self, position: int, expected: str) -> FileFormatError:
        """Make the error for a text file: its line, what was expected there, what was found."""
        rest = self.data[position : position + _SHOWN].tobytes()
        if position >= len(self.data):
            found = "the end of the file"
        elif not rest.split(b"\n")[0].strip():
            found = "the end of the line"
        else:
            found = repr(rest.split()[0].decode("latin-1"))
        line = self.line_at(min(position, len(self.data)))
        return FileFormatError(self.path, f"expected {expected}, found {found}", line=line)

    def at_line(self, position: int, problem: str) -> FileFormatError:
        """Make the error for a text file, with the line of this position."""
        return FileFormatError(self.path, problem, line=self.line_at(position))

    def at_byte(self, position: int, problem: str) -> FileFormatError:
        """Make the error for a binary file."""
        return FileFormatError(self.path, problem, byte=int(position))


def load(path: str | os.PathLike[str]) -> Source:
    """Read a whole file; one whose name ends in ``.gz`` is decompressed.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    FileFormatError
        If it is a directory, or not the gzip file that its name promises.
    """
    place = Path(path)
    if place.is_dir():
        raise FileFormatError(place, "expected a file, found a directory. Name a file in it")
    if place.suffix.lower() != ".gz":
        return Source(place, np.fromfile(place, np.uint8))
    try:
        content = gzip.decompress(place.read_bytes())
    except (EOFError, zlib.error, gzip.BadGzipFile) as cause:
        raise FileFormatError(place, f"expected a whole gzip file ({cause})") from cause
    return Source(place, np.frombuffer(content, np.uint8))


def trimmed(array: NDArray[Any], rows: int) -> NDArray[Any]:
    """Cut an array that owns its memory to its first rows, in place, without a copy.

    Examples
    --------
    >>> import numpy as np
    >>> trimmed(np.arange(10).repeat(2).reshape(10, 2).copy(), 3).shape
    (3, 2)
    """
    array.resize((rows, *array.shape[1:]), refcheck=False)
    return array
