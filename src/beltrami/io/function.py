"""read_function: the values of a function on the vertices of a mesh."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats
from beltrami._kinds import checked
from beltrami._optional import require
from beltrami.errors import FileFormatError, MissingExtraError, check_name
from beltrami.io.packed_inside import require_room
from beltrami.io.registry import READERS, read_mesh, suffix_of
from beltrami.io.source import load, plain_file
from beltrami.io.table import read_table
from beltrami.io.unpacking import Room, gunzipped, room_of

MORPHOMETRY = (".curv", ".sulc", ".thickness", ".area", ".volume")
TEXT = (".txt", ".csv", ".dat", ".tsv")


@checked
def read_function(
    path: str | os.PathLike[str],
    name: str | None = None,
    *,
    format: str | None = None,  # noqa: A002 - the public name
    missing: bool = False,
    max_bytes: int | None = None,
) -> Floats:
    r"""Read a function on the vertices, one row for each: (n,) or (n, c) float64.

    Chapter items: D5.

    Parameters
    ----------
    path
        ``.npy``; text columns ``.txt``, ``.csv``, ``.tsv``, ``.dat``; a mesh with vertex data,
        such as ``.ply``; through the extra ``io`` GIFTI ``.gii`` and FreeSurfer (``.curv``,
        ``.sulc``, ``.thickness``, ``.area``, ``.volume``, ``.mgh``, ``.mgz``; of ``.annot`` the
        number of the region of each vertex, -1 for none).
    name
        Which vertex data of a mesh, or which column of a text file whose first line names them;
        not needed where there is only one.
    format
        A suffix such as ``".curv"`` where the name of the file does not tell.
    missing
        Let NaN through, as maps have it where nothing was measured. Functions of this library
        refuse it: ``repair(mesh, remove_vertices=np.isnan(f))`` leaves those vertices out.
    max_bytes
        What a compressed file may unpack to: see ``read_mesh``.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    UnknownNameError
        If the suffix, or the name, does not exist; it lists those that do.
    FileFormatError
        If the file is not what its format promises, or a value is not finite (but for
        ``missing``).
    MissingExtraError
        If the format needs a package that is not installed.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     place = pathlib.Path(folder, "f.txt")
    ...     _ = place.write_text("0.5\n1.5\n")
    ...     read_function(place).tolist()
    [0.5, 1.5]
    """
    values = read_values(path, name, format=format, missing=missing, max_bytes=max_bytes)
    return np.ascontiguousarray(values, dtype=np.float64)


def read_values(
    path: str | os.PathLike[str],
    name: str | None = None,
    *,
    format: str | None = None,  # noqa: A002 - as above
    missing: bool = False,
    max_bytes: int | None = None,
) -> NDArray[Any]:
    """Read a function as ``read_function`` does, in the type that it has in the file."""
    suffix = suffix_of(path, format, (*TEXT, *READERS, *_OTHERS))
    place = Path(path)
    if suffix in TEXT:
        return read_table(load(place, max_bytes), name, missing)
    if suffix in READERS:
        data = read_mesh(place, suffix, max_bytes=max_bytes).vertex_data
        if not data:
            raise FileFormatError(place, "expected data on the vertices, found only a mesh")
        if name is None and len(data) == 1:
            name = next(iter(data))
        values = data[check_name("vertex data", name, tuple(data))]
    else:
        values = _foreign(place, suffix, max_bytes)
    return _checked(place, values, missing)


def _foreign(place: Path, suffix: str, max_bytes: int | None) -> Any:
    with plain_file(place, suffix, max_bytes) as plain:
        room = room_of(place, place.stat().st_size, max_bytes)
        try:
            return _OTHERS[suffix](plain, room)
        except (FileFormatError, MissingExtraError):
            raise
        except Exception as cause:  # the packages raise anything on a broken file
            reason = f"{type(cause).__name__}: {cause}"
            raise FileFormatError(place, f"expected a {suffix} file ({reason})") from cause


def _checked(place: Path, values: Any, missing: bool) -> NDArray[Any]:
    if not isinstance(values, np.ndarray) or values.dtype.kind not in "biuf":
        raise FileFormatError(place, "expected an array of real numbers")
    if values.ndim not in (1, 2) or values.size == 0:
        raise FileFormatError(place, f"expected the shape (n,) or (n, c), found {values.shape}")
    wrong = np.isinf(values) if missing else ~np.isfinite(values)
    if wrong.any():
        row = int(np.argwhere(wrong)[0, 0])
        hint = "" if np.isinf(values).any() else ". With missing=True NaN is read"
        problem = f"expected finite values, found NaN or infinity in row {row}{hint}"
        raise FileFormatError(place, problem)
    return values


def _read_npy(place: Path, _room: Room) -> Any:
    return np.load(place, allow_pickle=False)


def _read_gifti(place: Path, room: Room) -> Any:
    nibabel = require("nibabel", "io", "reading GIFTI")
    require_room(place, ".gii", room)
    geometry = {"NIFTI_INTENT_POINTSET", "NIFTI_INTENT_TRIANGLE"}
    codes = {nibabel.nifti1.intent_codes[name] for name in geometry}
    arrays = [a.data for a in nibabel.load(place).darrays if a.intent not in codes]
    if not arrays:
        raise FileFormatError(place, "expected an array of values, found only geometry")
    return arrays[0] if len(arrays) == 1 else np.stack(arrays, axis=1)


def _read_morphometry(place: Path, _room: Room) -> Any:
    freesurfer = require("nibabel.freesurfer", "io", "reading FreeSurfer data")
    return freesurfer.read_morph_data(place)


def _read_annotation(place: Path, _room: Room) -> Any:
    freesurfer = require("nibabel.freesurfer", "io", "reading FreeSurfer data")
    return freesurfer.read_annot(place)[0]


def _read_mgh(place: Path, room: Room) -> Any:
    nibabel = require("nibabel", "io", "reading FreeSurfer volumes")
    content = place.read_bytes()
    if content.startswith(b"\x1f\x8b"):  # .mgz
        content = gunzipped(np.frombuffer(content, np.uint8), room.path, room.take).tobytes()
    values = np.asarray(nibabel.MGHImage.from_bytes(content).dataobj)
    rows = values.reshape(len(values), -1)  # (n, 1, 1) or (n, 1, 1, frames)
    return rows[:, 0] if rows.shape[1] == 1 else rows


_OTHERS: dict[str, Callable[[Path, Room], Any]] = {
    ".npy": _read_npy,
    ".gii": _read_gifti,
    **dict.fromkeys(MORPHOMETRY, _read_morphometry),
    ".annot": _read_annotation,
    **dict.fromkeys((".mgh", ".mgz"), _read_mgh),
}
