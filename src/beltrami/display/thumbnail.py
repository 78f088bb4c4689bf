"""Thumbnails: any mesh, dirty or huge, as a small picture, in a fraction of a second."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Integers
from beltrami.display.camera import Camera
from beltrami.display.framing import fit_camera, named_vertices
from beltrami.display.render import render
from beltrami.display.srgb import Image
from beltrami.mesh.geometry import in_space
from beltrami.mesh.mesh import Mesh

SIZE = (260, 200)
_FACES = 150_000  # of a larger mesh, so many are drawn, each made larger
_ABSENT = (1.0, 0.0, 1.0)  # no light makes this of the colours we draw: it becomes transparent
_WIRES = 1500  # faces up to which the sides are drawn


def thumbnail(
    mesh: Mesh,
    f: NDArray[np.generic] | None = None,
    *,
    size: tuple[int, int] = SIZE,
    limits: tuple[float, float] | None = None,
    wireframe: bool = False,
) -> Image | None:
    """Draw a mesh as (h, w, 4) uint8 with a transparent background; None if nothing is there.

    No mesh is refused. Of more than three coordinates the first three are drawn, and faces that
    have a corner that is NaN or infinite are left out. Of more than 150 000 faces every k-th is
    drawn, larger by 2√k around its middle, so that hardly a hole is left.

    Parameters
    ----------
    f
        (n,) numbers, or (n, 3) colours in [0, 1] or as uint8; where they are not finite, 0.
    limits
        The values at the ends of the colour map.

    Notes
    -----
    Cost: O(size), whatever the number of faces.

    Examples
    --------
    >>> thumbnail(Mesh([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]]), size=(40, 30)).shape
    (30, 40, 4)
    >>> thumbnail(Mesh(np.zeros((0, 3)), np.zeros((0, 3), int))) is None
    True
    """
    stride = -(-mesh.n_faces // _FACES)
    corners = mesh.faces[:: max(stride, 1)]
    x = mesh.vertices[corners, :3]  # (t, 3, d)
    corners = corners[np.isfinite(x).all(axis=(1, 2))]
    drawn = _drawable(mesh, corners, stride)
    if drawn is None:
        return None
    samples = (2 * size[0], 2 * size[1])
    values = None
    if f is not None:
        values = np.nan_to_num(f, nan=0.0, posinf=0.0, neginf=0.0)
        values = values[corners].reshape(-1, *values.shape[1:]) if stride > 1 else values
    picture = render(
        drawn,
        values,
        size=samples,
        camera=_close_camera(drawn, samples),
        limits=limits,
        level_set=None,
        colorbar=False,
        background=_ABSENT,
        shading="flat" if stride > 1 else "gouraud",
        wireframe=wireframe and len(corners) <= _WIRES,
        line_width=2.0,
        antialias=1,
    )
    return _cut_out(picture)


def _drawable(mesh: Mesh, corners: Integers, stride: int) -> Mesh | None:
    """Return the faces as a mesh of size 1 around 0; None if they are none, or one point."""
    if not len(corners):
        return None
    x = mesh.vertices[:, :3] if stride <= 1 else mesh.vertices[corners, :3].reshape(-1, 3)
    seen = x[corners] if stride <= 1 else x
    low, high = seen.reshape(-1, x.shape[1]).min(axis=0), seen.reshape(-1, x.shape[1]).max(axis=0)
    middle = low / 2 + high / 2
    half = float((high / 2 - low / 2).max())
    if half == 0:
        return None
    with np.errstate(invalid="ignore", over="ignore"):
        x = np.where(np.isfinite(x), x - middle, 0) / half
    x = np.clip(x, -1, 1)  # vertices of no drawn face may be anywhere
    if stride <= 1:
        return Mesh(x, corners)
    triples = x.reshape(-1, 3, x.shape[1])
    centre = triples.mean(axis=1, keepdims=True)
    grown = centre + 2 * np.sqrt(stride) * (triples - centre)
    return Mesh(grown.reshape(x.shape), np.arange(len(x)).reshape(-1, 3))


def _close_camera(mesh: Mesh, size: tuple[int, int]) -> Camera:
    """Place the camera as usual, with a zoom that fills the picture with what is seen."""
    camera = fit_camera(mesh)
    x, _ = in_space(mesh.vertices, mesh.faces)
    seen = camera.project(x[named_vertices(mesh.faces, len(x))], size)[:, :2]
    reach = np.abs(seen / (np.array(size) / 2) - 1).max()
    return fit_camera(mesh, zoom=0.97 / max(float(reach), 0.05))


def _cut_out(picture: Image) -> Image:
    """Make the background transparent, and half the size: the mean of 2 x 2 samples."""
    there = (picture != np.rint(255 * np.array(_ABSENT)).astype(np.uint8)).any(axis=2)
    height, width = there.shape
    blocks = (height // 2, 2, width // 2, 2)
    share = there.reshape(blocks).mean(axis=(1, 3))
    light = (picture * there[..., None]).reshape(*blocks, 3).mean(axis=(1, 3))
    colour = light / np.where(share > 0, share, 1)[..., None]
    return np.dstack([np.rint(colour), np.rint(255 * share)]).astype(np.uint8)
