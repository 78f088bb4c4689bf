"""Sketches of what is no surface: a spectrum, a sparse matrix; small pictures, as PNG."""

from __future__ import annotations

import io

import numpy as np
from numpy.typing import NDArray
from PIL import Image as Pillow

from beltrami._arrays import Floats, Integers
from beltrami.display.srgb import Image

_BLUE = (33, 102, 172)


def spectrum_sketch(eigenvalues: Floats, size: tuple[int, int] = (260, 200)) -> Image | None:
    """Draw the eigenvalues over their numbers as columns, from 0 to the largest one.

    Examples
    --------
    >>> spectrum_sketch(np.array([0.0, 1.0, 4.0]), size=(30, 20)).shape
    (20, 30, 4)
    """
    width, height = size
    if not len(eigenvalues) or not eigenvalues.max() > 0:
        return None
    column = np.minimum(np.arange(width) * len(eigenvalues) // width, len(eigenvalues) - 1)
    tall = np.clip(eigenvalues / eigenvalues.max(), 0, 1)[column] * (height - 1)
    inside = np.arange(height)[::-1, None] <= tall
    return _ink(inside, _BLUE)


def sparsity_sketch(
    rows: Integers, columns: Integers, n: int, size: tuple[int, int] = (200, 200)
) -> Image | None:
    """Draw where a matrix has entries: the darker a pixel, the more of its entries are not 0.

    Examples
    --------
    >>> sparsity_sketch(np.arange(9), np.arange(9), 9, size=(9, 9))[..., 3].diagonal().min() > 90
    np.True_
    """
    width, height = min(size[0], n), min(size[1], n)
    if not len(rows):
        return None
    places = (rows * height // n) * width + columns * width // n
    counts = np.bincount(places, minlength=width * height).reshape(height, width)
    dark = np.where(counts > 0, 0.4 + 0.6 * np.sqrt(counts / counts.max()), 0)
    large = np.kron(dark, np.ones((-(-size[1] // height), -(-size[0] // width))))
    return _ink(large, _BLUE)


def _ink(coverage: NDArray[np.generic], colour: tuple[int, int, int]) -> Image:
    """Return (h, w, 4): one colour, as opaque as the coverage in [0, 1] says."""
    image = np.empty((*coverage.shape, 4), np.uint8)
    image[..., :3] = colour
    image[..., 3] = np.rint(255 * coverage.astype(np.float64))
    return image


def as_png(image: Image) -> bytes:
    """Return the bytes of a PNG file."""
    file = io.BytesIO()
    Pillow.fromarray(image).save(file, format="PNG", compress_level=6)
    return file.getvalue()
