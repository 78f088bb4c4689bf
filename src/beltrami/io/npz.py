"""Named arrays in one file, numpy's npz, with a kind, a version and a checksum."""

from __future__ import annotations

import hashlib
import json
import os
import zipfile
from collections.abc import Mapping
from io import BytesIO
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from beltrami.errors import FileFormatError
from beltrami.io.atomic import replacing

HEADER: Final = "header"


def write_arrays(
    path: str | os.PathLike[str], kind: str, version: int, arrays: Mapping[str, NDArray[Any]]
) -> None:
    """Write arrays of numbers, as a whole or not at all; the same arrays give the same bytes.

    ``numpy.load`` reads them too; the member ``header`` is a text in JSON.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     place = pathlib.Path(folder) / "a.npz"
    ...     write_arrays(place, "numbers", 1, {"x": np.arange(3)})
    ...     read_arrays(place, "numbers", 1)["x"].tolist()
    [0, 1, 2]
    """
    whole = {name: _contiguous(array) for name, array in sorted(arrays.items())}
    header = {"kind": kind, "version": version, "sha256": _digest(whole)}
    with replacing(path) as file:
        np.savez(file, allow_pickle=False, **{HEADER: np.array(json.dumps(header))}, **whole)


def read_arrays(path: str | os.PathLike[str], kind: str, version: int) -> dict[str, NDArray[Any]]:
    """Read arrays of this kind; they are read-only, and nothing in the file is executed.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    FileFormatError
        If it is no file of this kind, of a later version, cut off or changed.
    """
    place = Path(path)
    if place.is_dir():
        raise FileFormatError(place, "expected a file, found a directory. Name a file in it")
    with place.open("rb") as file:
        size = file.seek(0, os.SEEK_END)
        try:
            arrays = _members(file, size)
            header = json.loads(str(arrays.pop(HEADER)[()]))
            found, number, digest = (header[key] for key in ("kind", "version", "sha256"))
        except Exception as cause:  # zipfile and numpy raise anything on a damaged file
            reason = f"{type(cause).__name__}: {cause}"
            raise FileFormatError(place, f"expected a whole file of a {kind} ({reason})") from cause
    if found != kind:
        raise FileFormatError(place, f"expected a {kind}, found {found!r}")
    if number != version:
        raise FileFormatError(
            place, f"expected version {version} of a {kind}, found {number!r}. Update beltrami"
        )
    if digest != _digest(arrays):
        raise FileFormatError(place, f"the numbers of this {kind} are not those that were written")
    return arrays


def _contiguous(array: NDArray[Any]) -> NDArray[Any]:
    flags = array.flags
    return array if flags.c_contiguous or flags.f_contiguous else np.ascontiguousarray(array)


def _digest(arrays: Mapping[str, NDArray[Any]]) -> str:
    """Return the SHA-256 of names, types, shapes and numbers."""
    sha = hashlib.sha256()
    for name in sorted(arrays):
        array = arrays[name]
        order = "C" if array.flags.c_contiguous else "F"
        sha.update(f"{name} {array.dtype.str} {array.shape} {order};".encode())
        sha.update(array.ravel(order="K").data)
    return sha.hexdigest()


def _members(file: Any, size: int) -> dict[str, NDArray[Any]]:
    """Return the arrays of a zip file; their sizes are checked before anything is allocated."""
    with zipfile.ZipFile(file) as archive:
        infos = archive.infolist()
        if sum(info.file_size for info in infos) > size:
            raise ValueError("members are longer than the file")
        names = [info.filename.removesuffix(".npy") for info in infos]
        if len(set(names)) != len(names):
            raise ValueError("a member is there twice")
        return {
            name: _array(_stored(archive, info)) for name, info in zip(names, infos, strict=True)
        }


def _stored(archive: zipfile.ZipFile, info: zipfile.ZipInfo) -> bytes:
    if info.compress_type != zipfile.ZIP_STORED:
        raise ValueError(f"{info.filename} is compressed")
    return archive.read(info)


def _array(content: bytes) -> NDArray[Any]:
    """Return the array of a member in numpy's npy format, of numbers or a text, in place."""
    stream = BytesIO(content)
    if np.lib.format.read_magic(stream) != (1, 0):
        raise ValueError("another version of npy")
    shape, fortran, dtype = np.lib.format.read_array_header_1_0(stream)
    if dtype.kind not in "biufU" or min(shape, default=0) < 0:
        raise ValueError(f"an array of type {dtype} and shape {shape}")
    count, start = 1, stream.tell()
    for p in shape:
        count *= p
    if count * dtype.itemsize != len(content) - start:
        raise ValueError(f"{len(content) - start} bytes where {count * dtype.itemsize} are needed")
    flat = np.frombuffer(content, dtype, count, start) if count else np.zeros(0, dtype)
    return flat.reshape(shape, order="F" if fortran else "C")
