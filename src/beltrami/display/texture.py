"""Textures: pictures on surfaces, read at each pixel through the texture coordinates (l. 665)."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats, Integers
from beltrami._jit import kernel
from beltrami.display.srgb import from_linear, to_linear
from beltrami.errors import MeshError, check_name
from beltrami.io.picture import Picture, as_picture
from beltrami.mesh.mesh import Mesh

PATTERNS = ("checkerboard",)
SQUARES = 16  # of the checkerboard, along the longer side of the texture coordinates
_TILE = 256
_LIGHT, _DARK = (0.95, 0.94, 0.90), (0.27, 0.42, 0.56)


class Texture(NamedTuple):
    """A picture in all its sizes, and where each corner of the faces lies on it.

    Attributes
    ----------
    uv : (m, 3, 2) float
        The picture is [0, 1]², v upwards, and goes on periodically; NaN where a corner has none.
    pixels : (p, 3) float32
        sRGB of 0 to 1, row by row from the top, of the picture and then of its halves.
    levels : (k, 3) int
        The first pixel, the width and the height of each size.
    """

    uv: Floats
    pixels: NDArray[np.float32]
    levels: Integers


def make_texture(mesh: Mesh, picture: Picture) -> Texture:
    """Prepare a picture for a mesh with ``corner_uv``.

    Parameters
    ----------
    mesh
        With texture coordinates, such as ``parameterize(mesh).textured``.
    picture
        ``"checkerboard"``: 16 squares along the longer side of the texture coordinates; or a file
        or an array, as in ``as_picture``.

    Raises
    ------
    MeshError
        If the mesh has no texture coordinates.
    UnknownNameError
        If there is no such pattern; and what ``as_picture`` raises.
    """
    uv = np.full((1, 3, 2), np.nan) if mesh.corner_uv is None else mesh.corner_uv
    finite = np.asarray(np.isfinite(uv).all(axis=2))
    if not finite.any():
        raise MeshError(
            "a mesh without texture coordinates takes no texture",
            remedy="Draw parameterize(mesh).textured or atlas(mesh).mesh.",
        )
    uv = np.where(finite[..., None], uv, np.nan)
    if is_pattern(picture):
        known = uv[finite]
        low, extent = known.min(axis=0), float(np.ptp(known, axis=0).max())
        tile = checkerboard(_TILE, 2)
        return Texture((uv - low) / (extent or 1.0) * (SQUARES / 2), *_halves(tile))
    return Texture(uv, *_halves(as_picture(picture)))


def is_pattern(picture: Picture) -> bool:
    """Tell whether a picture is named, not given: a text without a suffix is the name of a pattern.

    Raises
    ------
    UnknownNameError
        If there is no such pattern.
    """
    if not isinstance(picture, str) or Path(picture).suffix:
        return False
    check_name("texture", picture, PATTERNS)
    return True


def checkerboard(size: int = 1024, squares: int = SQUARES) -> Floats:
    """Return a picture (size, size, 3) of squares in two colours.

    Examples
    --------
    >>> board = checkerboard(4, 2)
    >>> bool((board[0, 0] == board[2, 2]).all()), bool((board[0, 0] == board[0, 2]).any())
    (True, False)
    """
    odd = np.arange(size) * squares // size % 2 == 1
    return np.where((odd[:, None] ^ odd)[..., None], np.array(_DARK), np.array(_LIGHT))


def _halves(picture: Floats) -> tuple[NDArray[np.float32], Integers]:
    """Return all sizes of a picture down to one pixel, each the mean light of two by two."""
    light = to_linear(picture)
    sizes, pixels, first = [], [], 0
    while True:
        height, width = light.shape[:2]
        sizes.append((first, width, height))
        pixels.append(from_linear(light).reshape(-1, 3).astype(np.float32))
        first += width * height
        if width == height == 1:
            return np.concatenate(pixels), np.array(sizes, np.int64)
        even = np.pad(light, ((0, height % 2), (0, width % 2), (0, 0)), mode="edge")
        if height == 1:
            even = even[:1].repeat(2, axis=0)
        if width == 1:
            even = even[:, :1].repeat(2, axis=1)
        light = (even[::2, ::2] + even[1::2, ::2] + even[::2, 1::2] + even[1::2, 1::2]) / 4


@kernel
def look_up(
    pixels: Any, levels: Any, u: float, v: float, across: float, down: float, color: Any
) -> None:
    """Set the colour at (u, v): linear between pixels, and between the two sizes that fit.

    ``across`` and ``down`` are how far a step to the next sample goes on the picture, over its
    width or height; a pixel of the size that is read is about as large.
    """
    texels = max(across * levels[0, 1], down * levels[0, 2])
    level = max(np.log2(texels), 0.0) if texels > 0 else 0.0
    level = min(level, levels.shape[0] - 1.0)
    k = min(int(level), levels.shape[0] - 2) if levels.shape[0] > 1 else 0
    part = level - k
    color[:] = 0.0
    _add(pixels, levels[k], u, v, 1.0 - part, color)
    if part > 0.0:
        _add(pixels, levels[k + 1], u, v, part, color)


@kernel
def _add(pixels: Any, level: Any, u: float, v: float, weight: float, color: Any) -> None:
    """Add the four pixels around (u, v) of one size."""
    first, width, height = level[0], level[1], level[2]
    x, y = u * width - 0.5, (1.0 - v) * height - 0.5
    left, top = int(np.floor(x)), int(np.floor(y))
    x -= left
    y -= top
    for dy in range(2):
        row = first + ((top + dy) % height) * width
        for dx in range(2):
            p = row + (left + dx) % width
            share = weight * (x if dx else 1.0 - x) * (y if dy else 1.0 - y)
            for c in range(3):
                color[c] += share * pixels[p, c]
