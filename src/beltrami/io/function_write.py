"""write_function: the values of a function on the vertices into a file."""

from __future__ import annotations

import gzip
import io
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beltrami._arrays import GIVE, rectangular
from beltrami._kinds import checked
from beltrami._optional import require
from beltrami.errors import DimensionError, NonFiniteError
from beltrami.io.atomic import replacing
from beltrami.io.function import MORPHOMETRY, TEXT
from beltrami.io.registry import suffix_of

_FLOAT32_MAX = float(np.finfo(np.float32).max)
Values = NDArray[Any]


@checked
def write_function(path: str | os.PathLike[str], f: ArrayLike, *, missing: bool = False) -> None:
    """Write a function on the vertices: wholly, or on any error or interrupt not at all.

    The inverse of ``read_function``. To keep it with its mesh, write
    ``mesh.with_data(name=f)`` to a format that holds both, as PLY does.

    Parameters
    ----------
    path
        Its suffix is the format, ``.gz`` after it compresses:
        ``.npy`` (with the type of f); text ``.txt``, ``.csv``, ``.tsv``, ``.dat``; through the
        extra ``io`` GIFTI ``.gii`` and FreeSurfer's ``.mgh``, ``.mgz``, and of one column
        ``.curv``, ``.sulc``, ``.thickness``, ``.area``, ``.volume``. GIFTI and FreeSurfer have
        32 bits: integers stay integers in GIFTI, as labels need it, all else is rounded.
        ``.shape.gii`` and ``.label.gii`` declare shapes and labels, as Workbench wants them.
    f
        (n,) or (n, c).
    missing
        Let NaN through, as maps have it where nothing was measured.

    Raises
    ------
    UnknownNameError
        If the suffix is not known; the error lists those that are.
    DimensionError
        If f is empty, has more than two axes, or more columns than the format holds, or if
        labels are no integers of 32 bits.
    NonFiniteError
        If a value is infinite, NaN (but for ``missing``), or too large for 32 bits.
    MissingExtraError
        If the format needs a package that is not installed.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> from beltrami.io.function import read_function
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     place = pathlib.Path(folder, "f.csv")
    ...     write_function(place, [[0.1, 2], [0.2, 3]])
    ...     read_function(place).tolist()
    [[0.1, 2.0], [0.2, 3.0]]
    """
    _write(path, f, missing, infinite=False)


def write_results(path: str | os.PathLike[str], f: ArrayLike) -> None:
    """Write as ``write_function`` does what may be infinite, as distances are between components.

    ``read_function`` refuses such a file; numpy and others read it.
    """
    _write(path, f, missing=False, infinite=True)


def _write(path: str | os.PathLike[str], f: ArrayLike, missing: bool, *, infinite: bool) -> None:
    suffix = suffix_of(path, None, (*TEXT, *WRITERS))
    content = _encoded(Path(path), suffix, _writable(f, suffix, missing, infinite))
    packed = Path(path).suffix.lower() == ".gz"
    with replacing(path) as file:
        file.write(gzip.compress(content, mtime=0) if packed else content)


def _writable(f: ArrayLike, suffix: str, missing: bool, infinite: bool) -> Values:
    values = rectangular(f)
    if values.ndim not in (1, 2) or values.size == 0:
        raise DimensionError(
            f"the function has the shape {values.shape} where (n,) or (n, c) is needed"
        )
    if suffix in MORPHOMETRY and values[0].size > 1:
        raise DimensionError(
            f"a {suffix} file holds one column, and the function has {values[0].size}",
            remedy="Write one file for each, or .mgh.",
        )
    good = ~np.isinf(values) if missing else np.isfinite(values)
    if suffix not in (".npy", *TEXT):
        good &= ~(np.abs(values) > _FLOAT32_MAX)
    if infinite:
        good |= np.isinf(values)
    if not good.all():
        raise NonFiniteError(
            f"the function has values not for a {suffix} file: infinite, too large or NaN",
            vertices=np.flatnonzero(~good.reshape(len(values), -1).all(axis=1)),
            remedy=GIVE if missing else f"{GIVE} NaN is written with missing=True.",
        )
    return values


def _encoded(place: Path, suffix: str, values: Values) -> bytes:
    if suffix in TEXT:
        return _text(values, "," if suffix == ".csv" else "\t" if suffix == ".tsv" else " ")
    return WRITERS[suffix](place, values)


def _text(values: Values, delimiter: str) -> bytes:
    file = io.BytesIO()
    np.savetxt(file, values, fmt="%.17g", delimiter=delimiter)
    return file.getvalue()


def _npy(_place: Path, values: Values) -> bytes:
    file = io.BytesIO()
    np.save(file, np.ascontiguousarray(values), allow_pickle=False)
    return file.getvalue()


def _gifti(place: Path, values: Values) -> bytes:
    nibabel = require("nibabel", "io", "writing GIFTI")
    kind = place.name.lower().removesuffix(".gz").split(".")[-2:-1]
    whole = values.dtype.kind in "biu" and np.abs(values.astype(float)).max() < 2**31
    if kind == ["label"] and not whole:
        raise DimensionError("labels must be integers of 32 bits", remedy="Write .func.gii.")
    intent = {"label": "LABEL", "shape": "SHAPE"}.get(kind[0] if kind else "", "NONE")
    image = nibabel.gifti.GiftiImage()
    for column in values.reshape(len(values), -1).T:
        image.add_gifti_data_array(
            nibabel.gifti.GiftiDataArray(
                np.ascontiguousarray(column, np.int32 if whole else np.float32),
                intent=f"NIFTI_INTENT_{intent}",
                datatype="NIFTI_TYPE_INT32" if whole else "NIFTI_TYPE_FLOAT32",
            )
        )
    if intent == "LABEL":
        for number in np.unique(values).tolist():
            label = nibabel.gifti.GiftiLabel(int(number), 0.5, 0.5, 0.5, 1.0)
            label.label = str(int(number))
            image.labeltable.labels.append(label)
    return bytes(image.to_bytes())


def _morphometry(_place: Path, values: Values) -> bytes:
    freesurfer = require("nibabel.freesurfer", "io", "writing FreeSurfer data")
    file = io.BytesIO()
    freesurfer.write_morph_data(file, values.reshape(-1).astype(np.float32))
    return file.getvalue()


def _mgh(place: Path, values: Values) -> bytes:
    nibabel = require("nibabel", "io", "writing FreeSurfer volumes")
    shape = (len(values), 1, 1, *values.shape[1:]) if values[0].size > 1 else (len(values), 1, 1)
    rows = values.reshape(shape).astype(np.float32)
    plain = bytes(nibabel.MGHImage(rows, np.eye(4)).to_bytes())
    return gzip.compress(plain, mtime=0) if place.suffix.lower() == ".mgz" else plain


WRITERS: dict[str, Callable[[Path, Values], bytes]] = {
    ".npy": _npy,
    ".gii": _gifti,
    **dict.fromkeys(MORPHOMETRY, _morphometry),
    **dict.fromkeys((".mgh", ".mgz"), _mgh),
}
