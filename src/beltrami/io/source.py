"""The bytes of a file, and errors that say where in them something is wrong."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami.errors import FileFormatError
from beltrami.io.unpacking import gunzipped, room_of

POINTS_ONLY = ". If it has points only, PointCloud(read_points(path)) is the domain for them"
_SHOWN = 40  # of the bytes at fault
_BLOCK = 1 << 20  # bytes read at a time: they stay in the processor's cache
_MARK = b"\xef\xbb\xbf"


@dataclass(frozen=True, eq=False)
class Source:
    r"""A file: its name and its bytes, which are read when they are first asked for.

    Examples
    --------
    >>> import numpy as np
    >>> source = Source("a.off", np.frombuffer(b"OFF\n3 x 0", np.uint8))
    >>> print(source.unexpected(6, "an integer"))
    a.off, line 2: expected an integer, found 'x'
    """

    path: Path | str
    content: NDArray[np.uint8] | None = None

    @cached_property
    def data(self) -> NDArray[np.uint8]:
        """All the bytes."""
        return np.fromfile(self.path, np.uint8) if self.content is None else self.content

    @property
    def size(self) -> int:
        """How many bytes there are."""
        return Path(self.path).stat().st_size if self.content is None else len(self.content)

    def blocks(self) -> Iterator[tuple[int, NDArray[np.uint8]]]:
        r"""Run through a text of lines: (position, bytes), cut after ends of lines.

        Not after one with a backslash before it, which continues the line. A file is read block
        by block into the same memory, so a block is gone when the next one is asked for.

        Examples
        --------
        >>> source = Source("a.obj", np.frombuffer(b"v 0 0 0\n", np.uint8))
        >>> [(start, len(block)) for start, block in source.blocks()]
        [(0, 8)]
        """
        if self.content is not None:
            yield 0, self.content
            return
        with Path(self.path).open("rb", buffering=0) as file:
            buffer, start, kept = bytearray(_BLOCK), 0, 0
            while count := file.readinto(memoryview(buffer)[kept:]):
                end = kept + count
                cut = _last_line(buffer, end)
                if cut:
                    yield start, np.frombuffer(buffer, np.uint8, cut)
                kept = end - cut
                longer = max(_BLOCK, 2 * kept)
                rest = buffer[cut:end]
                if longer != len(buffer):
                    buffer = bytearray(longer)
                buffer[:kept] = rest
                start += cut
            if kept:
                yield start, np.frombuffer(buffer, np.uint8, kept)

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


def mark_length(text: NDArray[np.uint8]) -> int:
    """Return how many bytes the mark of UTF-8 takes at the beginning of a text, 3 or 0.

    It is no part of the first line, which would be none of its format with it.
    """
    return len(_MARK) if text[: len(_MARK)].tobytes() == _MARK else 0


def _last_line(text: bytearray, end: int) -> int:
    """Return the position after the last end of a line that is not continued; 0 without one."""
    while True:
        end = text.rfind(b"\n", 0, end)
        if end < 0:
            return 0
        line = text[text.rfind(b"\n", 0, end) + 1 : end]
        if not line.rstrip().endswith(b"\\"):
            return end + 1


def load(path: str | os.PathLike[str], max_bytes: int | None = None) -> Source:
    """Open a file; one whose name ends in ``.gz`` is decompressed.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    FileFormatError
        If it is a directory, or not the gzip file that its name promises, or a bomb: see
        ``room_of``.
    """
    place = Path(path)
    if place.is_dir():
        raise FileFormatError(place, "expected a file, found a directory. Name a file in it")
    if place.suffix.lower() != ".gz":
        with place.open("rb"):  # what cannot be opened is known here
            return Source(place)
    packed = np.fromfile(place, np.uint8)
    room = room_of(place, len(packed), max_bytes)
    return Source(place, gunzipped(packed, place, room.take))


@contextmanager
def plain_file(path: Path, suffix: str, max_bytes: int | None = None) -> Iterator[Path]:
    """Yield the name of the file, or of a decompressed copy, for packages that read files only."""
    source = load(path, max_bytes)
    if source.content is None:
        yield path
        return
    with tempfile.TemporaryDirectory() as folder:
        whole = Path(folder, f"mesh{suffix}")
        whole.write_bytes(source.content.data)
        yield whole


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
