"""Reading a source: its bytes, whose digest names the work, and the mesh in them."""

from __future__ import annotations

import hashlib
import os
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami._optional import require
from beltrami.batch import memory
from beltrami.batch.failures import TooLargeError
from beltrami.batch.sources import MESHES
from beltrami.compression.decompress import decompress
from beltrami.errors import FileFormatError
from beltrami.io import extras
from beltrami.io.registry import READERS, suffix_of
from beltrami.io.source import Source
from beltrami.io.unpacking import gunzipped, room_of
from beltrami.mesh.mesh import Mesh

_BLOCK = 1 << 20


@dataclass(eq=False)
class Input:
    """A source as it was read, once: what its bytes are known by, and they until they are used."""

    name: str
    suffix: str
    packed: bool
    sha256: str
    bytes: int
    content: NDArray[np.uint8]

    def taken(self) -> NDArray[np.uint8]:
        """Return the bytes and forget them: a huge mesh is not to be there twice."""
        content, self.content = self.content, np.empty(0, np.uint8)
        return content


def read_input(name: str, place: str, allowed: int | None = None) -> Input:
    """Read the bytes of a source.

    Raises
    ------
    OSError
        If they cannot be read.
    UnknownNameError
        If the suffix is not that of a mesh.
    TooLargeError
        If reading the mesh would need more memory than is allowed.
    FileFormatError
        If it is a member of an archive that unpacks to more than it may (see ``read_mesh``).
    """
    member = place.partition("::")[0]
    suffix = suffix_of(member, None, MESHES)
    opened = _opened(place)
    _require_no_bomb(opened, place)
    with opened as file:
        content = _content(file, suffix, allowed)
    digest = hashlib.sha256(content.data).hexdigest()
    packed = member.lower().endswith(".gz")
    return Input(name, suffix, packed, digest, len(content), content)


def mesh_of(given: Input, allowed: int | None = None) -> Mesh:
    """Read the mesh from the bytes.

    Raises
    ------
    FileFormatError
        If the bytes are not what the suffix promises, or a bomb (see ``read_mesh``).
    TooLargeError
        If they unpack to more than the memory that is allowed.
    MemoryError
        If a package runs out of memory while it reads.
    """
    content = given.taken()
    if given.packed:
        content = _unpacked(content, given, allowed)
    if given.suffix == ".btm":
        return decompress(content.tobytes())
    if given.suffix in READERS:
        return READERS[given.suffix](Source(given.name, content))
    with tempfile.TemporaryDirectory() as folder:  # these packages read files only
        path = Path(folder, f"mesh{given.suffix}")
        path.write_bytes(content.data)
        most = room_of(given.name, given.bytes).most  # of the source, not of what it unpacked to
        try:
            return extras.read(path, given.suffix, most)
        except FileFormatError as error:
            _require_memory(error)
            raise FileFormatError(given.name, error.problem) from error


def _require_memory(error: BaseException | None) -> None:
    """Raise the MemoryError behind an error: a larger limit may do, so the file is not to blame."""
    while error is not None:
        if isinstance(error, MemoryError):
            raise error
        error = error.__cause__


def _opened(place: str) -> Any:
    """Open a source, local or behind a URL, in a ``with``."""
    if "://" in place or "::" in place:
        return require("fsspec", "batch", "a batch").open(place, "rb")
    if os.path.isdir(place):
        raise FileFormatError(place, "expected a file, found a directory. Name a file in it")
    return open(place, "rb")


def _require_no_bomb(opened: Any, place: str) -> None:
    """Refuse a member of a zip file that says that it unpacks to more than it may."""
    if place.startswith("zip://"):
        facts = opened.fs.info(opened.path)
        room_of(place, int(facts["compress_size"])).take(int(facts["size"]))


def _content(file: Any, suffix: str, allowed: int | None) -> NDArray[np.uint8]:
    """Read all bytes, as long as there is room for the mesh in them."""
    size = _size_of(file)
    if size is not None:
        _require_room(size, suffix, allowed)
        content = np.empty(size, np.uint8)
        count = file.readinto(content.data) if hasattr(file, "readinto") else None
        if count == size and not file.read(1):
            return content
        file.seek(0)
    blocks = bytearray()
    while block := file.read(_BLOCK):
        blocks += block
        _require_room(len(blocks), suffix, allowed)
    return np.frombuffer(blocks, np.uint8)


def _size_of(file: Any) -> int | None:
    """Return how many bytes there are, if that is known."""
    if not file.seekable():
        return None
    size = int(file.seek(0, os.SEEK_END))
    file.seek(0)
    return size


def _require_room(size: int, suffix: str, allowed: int | None) -> None:
    """Raise TooLargeError if reading so many bytes would not fit."""
    factor = memory.READ_PACKED if suffix == ".btm" else memory.READ
    needed = memory.BASE + int(factor * size)
    if allowed is not None and needed > allowed:
        raise TooLargeError(f"reading {size / 1e6:.0f} MB of {suffix}", needed, allowed)


def _unpacked(packed: NDArray[np.uint8], given: Input, allowed: int | None) -> NDArray[np.uint8]:
    """Decompress, and stop where it is a bomb, or the memory that is allowed would not do."""
    room = room_of(given.name, len(packed))

    def take(count: int) -> None:
        room.take(count)
        _require_room(room.used, given.suffix, allowed)

    return gunzipped(packed, given.name, take)
