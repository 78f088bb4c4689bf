"""bake: functions on the vertices as textures, with seams that do not show."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, as_floats, as_function, require_finite, whole
from beltrami._jit import kernel
from beltrami._kinds import checked
from beltrami.display.raster import NOTHING, visible_triangles
from beltrami.display.srgb import Image
from beltrami.display.triangles import GRID, Triangles
from beltrami.display.values import choose_limits
from beltrami.errors import DimensionError, MeshError
from beltrami.mesh.door import require_mesh
from beltrami.mesh.mesh import Mesh
from beltrami.parameterization.texture_atlas import TextureAtlas

_FARTHEST = -1.0  # barycentric coordinate down to which a face goes on beyond its sides


def bake(atlas: TextureAtlas | Mesh, f: ArrayLike, size: int | None = None) -> Floats:
    r"""Write a function on the vertices into a texture: its values at the middles of the texels.

    Texels outside of all charts get the value that the nearest face, continued beyond its sides,
    has there: a picture that is read with linear interpolation then shows no seam, not even where
    it is made smaller. Values are those of the linear interpolant, not of the vertices, so that
    a texture of fewer texels than vertices is a sample of it.

    Chapter items: P71.

    Parameters
    ----------
    atlas
        Of ``atlas``; or a mesh with ``corner_uv`` in [0, 1]².
    f
        (n,) or (n, c) values at the vertices of the surface; bytes become fractions of 255, and
        stay between 0 and 1 outside of the charts.
    size
        Texels along a side; by default that of the atlas, and 1024 for a mesh.

    Returns
    -------
    (size, size) or (size, size, c) float
        The first row is at the top, v = 1 - ½ / size. ``colorize`` makes a picture of numbers.

    Raises
    ------
    MeshError
        If the mesh has no texture coordinates in some corner, or some outside [0, 1].
    DimensionError, NonFiniteError
        If the function does not fit, or is not finite.

    Notes
    -----
    Cost: O(m + size²).

    Examples
    --------
    >>> square = Mesh([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1, 2], [0, 2, 3]])
    >>> placed = Mesh(square.vertices, square.faces, corner_uv=square.vertices[square.faces])
    >>> bake(placed, square.vertices[:, 0], 4).tolist()[0]
    [0.125, 0.375, 0.625, 0.875]
    """
    mesh = atlas.mesh if isinstance(atlas, TextureAtlas) else require_mesh(atlas, "a texture")
    default = atlas.size if isinstance(atlas, TextureAtlas) else 1024
    side = whole("size", default if size is None else size, least=1, most=32768)
    uv = mesh.corner_uv
    if uv is None or not mesh.n_faces:
        raise MeshError(
            "a mesh without texture coordinates takes no texture",
            remedy="Give atlas(mesh).",
        )
    outside = ~((uv >= 0) & (uv <= 1)).all(axis=(1, 2))
    if outside.any():
        raise MeshError(
            "texture coordinates outside [0, 1]",
            faces=np.flatnonzero(outside),
            remedy="Give atlas(mesh), whose coordinates are inside.",
        )
    values = as_function(f, mesh.n_vertices)
    bytes_given = np.asarray(f).dtype == np.uint8
    if bytes_given:
        values = values / 255.0
    corners = values.reshape(mesh.n_vertices, -1)[mesh.faces]
    xy = np.ascontiguousarray(np.stack([uv[..., 0], 1 - uv[..., 1]], axis=2) * side)
    texels = _baked(xy, np.ascontiguousarray(corners), side)
    if bytes_given:
        np.clip(texels, 0.0, 1.0, out=texels)
    return texels[..., 0] if values.ndim == 1 else texels


@checked
def colorize(
    values: ArrayLike,
    colormap: str | ArrayLike | None = None,
    limits: tuple[float, float] | None = None,
) -> Image:
    """Make a picture of an array of numbers, with the colours that ``render`` gives to functions.

    Parameters
    ----------
    values
        (h, w) finite numbers, such as ``bake`` returns.
    colormap, limits
        As in ``render``.

    Returns
    -------
    (h, w, 3) uint8

    Examples
    --------
    >>> colorize([[0.0, 1.0]], [[0, 0, 0], [1, 1, 1]]).tolist()
    [[[0, 0, 0], [255, 255, 255]]]
    """
    given = as_floats(values)
    if given.ndim != 2 or not given.size:
        raise DimensionError(f"numbers of the shape {given.shape} where (h, w) is needed")
    require_finite(given, "the picture")
    (low, high), table = choose_limits(given.ravel(), limits, colormap)
    place = np.full(given.shape, 0.5) if low == high else (given - low) / (high - low)
    at = np.clip(place, 0, 1) * (len(table) - 1)
    channels = [np.interp(at, np.arange(len(table)), channel) for channel in table.T]
    return np.rint(255 * np.stack(channels, axis=2)).astype(np.uint8)


def _baked(xy: Floats, corners: Floats, side: int) -> Floats:
    """Return (side, side, c) values, for corners (m, 3, 2) in texels, y downwards."""
    from scipy.ndimage import distance_transform_edt  # slow to load

    m = len(xy)
    flat = Triangles(
        xy=np.rint(xy * GRID).astype(np.int64),
        nearness=np.ones((m, 3)),
        face=np.arange(m),
        borders=np.ones((m, 3), np.bool_),
        cut=np.zeros((0, 3, 3)),
    )
    seen = visible_triangles(flat, (side, side)).triangle
    column, row = np.minimum(xy.mean(axis=1).astype(np.int64), side - 1).T
    missed = seen[row, column] == NOTHING  # faces between the middles of the texels
    seen[row[missed], column[missed]] = np.flatnonzero(missed)
    nearest = distance_transform_edt(seen == NOTHING, return_distances=False, return_indices=True)
    texels = np.empty((side, side, corners.shape[2]))
    _fill(seen, nearest, xy, corners, texels)
    return texels


@kernel
def _fill(seen: Any, nearest: Any, xy: Any, corners: Any, texels: Any) -> None:
    """Evaluate at each texel the face that it sees, or the one seen by the nearest texel."""
    b = np.empty(3)
    for y in range(texels.shape[0]):
        for x in range(texels.shape[1]):
            row, column = nearest[0, y, x], nearest[1, y, x]
            f = seen[row, column]
            _coordinates(xy[f], x + 0.5, y + 0.5, b)
            if not min(b[0], min(b[1], b[2])) >= _FARTHEST:
                _coordinates(xy[f], column + 0.5, row + 0.5, b)
                total = 0.0
                for c in range(3):
                    b[c] = max(b[c], 0.0) if b[c] == b[c] else 1.0
                    total += b[c]
                for c in range(3):
                    b[c] /= total
            for k in range(texels.shape[2]):
                texels[y, x, k] = (
                    b[0] * corners[f, 0, k] + b[1] * corners[f, 1, k] + b[2] * corners[f, 2, k]
                )


@kernel
def _coordinates(xy: Any, x: float, y: float, b: Any) -> None:
    """Set the barycentric coordinates of a point; NaN where the face has no area."""
    ux, uy = xy[1, 0] - xy[0, 0], xy[1, 1] - xy[0, 1]
    vx, vy = xy[2, 0] - xy[0, 0], xy[2, 1] - xy[0, 1]
    double = ux * vy - uy * vx
    if double == 0.0:
        b[:] = np.nan
        return
    b[1] = ((x - xy[0, 0]) * vy - (y - xy[0, 1]) * vx) / double
    b[2] = (ux * (y - xy[0, 1]) - uy * (x - xy[0, 0])) / double
    b[0] = 1.0 - b[1] - b[2]
