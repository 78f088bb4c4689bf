"""Pictures for textures: from files and arrays to sRGB values, and to the bytes of a PNG."""

from __future__ import annotations

import io
import os
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike
from PIL import Image as Pillow

from beltrami._arrays import Floats, rectangular
from beltrami.errors import DimensionError, FileFormatError, MeshError

Picture: TypeAlias = str | os.PathLike[str] | ArrayLike


def as_picture(picture: Picture) -> Floats:
    """Return a picture as (h, w, 3) sRGB of 0 to 1.

    Parameters
    ----------
    picture
        The name of a file that Pillow reads, such as PNG or JPEG (transparency is left out); or
        (h, w, 3) sRGB or (h, w) grey values, in [0, 1] or as uint8.

    Raises
    ------
    FileFormatError, FileNotFoundError
        If the file is no picture, or not there.
    DimensionError, MeshError
        If the array has another shape, or values outside [0, 1].

    Examples
    --------
    >>> as_picture([[0.0, 1.0]]).tolist()
    [[[0.0, 0.0, 0.0], [1.0, 1.0, 1.0]]]
    """
    if isinstance(picture, str | os.PathLike):
        try:
            with Pillow.open(picture) as file:
                return np.asarray(file.convert("RGB"), dtype=np.float64) / 255.0
        except Exception as cause:  # Pillow raises anything on a broken file
            if isinstance(cause, OSError) and cause.errno is not None:
                raise  # the file is not there, or may not be read
            raise FileFormatError(picture, "expected a picture, such as PNG or JPEG") from cause
    given = rectangular(picture)
    if given.ndim not in (2, 3) or given.size == 0 or (given.ndim == 3 and given.shape[2] != 3):
        raise DimensionError(
            f"a picture has the shape {given.shape} where (h, w) or (h, w, 3) is needed"
        )
    values = given / 255.0 if given.dtype == np.uint8 else given.astype(np.float64)
    if not ((values >= 0) & (values <= 1)).all():
        raise MeshError(
            "values of a picture outside [0, 1]", remedy="Give sRGB in [0, 1], or as uint8."
        )
    return np.repeat(values[:, :, None], 3, axis=2) if given.ndim == 2 else values


def as_pillow(picture: Picture) -> Pillow.Image:
    """Return a picture as one of Pillow, with 8 bits a channel."""
    return Pillow.fromarray(np.rint(as_picture(picture) * 255.0).astype(np.uint8))


def png_bytes(picture: Picture) -> bytes:
    """Return the bytes of a PNG file."""
    file = io.BytesIO()
    as_pillow(picture).save(file, format="PNG")
    return file.getvalue()
