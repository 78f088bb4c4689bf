"""Where the camera stands: fitted to the ball around a mesh."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Booleans, Floats, Integers, as_floats
from beltrami.display.camera import FIELD_OF_VIEW, Camera
from beltrami.display.vectors import as_vector, unit_vector
from beltrami.errors import EmptyMeshError, MeshError, check_name, shown
from beltrami.mesh.geometry import in_space
from beltrami.mesh.mesh import Mesh

FILL = 0.94  # part of the shorter side of the picture that the ball around the mesh takes
# Right, up and towards the viewer, for azimuth 0 and elevation 0.
_FRAMES = {
    "x": ((0, 0, 1), (1, 0, 0), (0, 1, 0)),
    "y": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    "z": ((1, 0, 0), (0, 0, 1), (0, -1, 0)),
}


def fit_camera(
    meshes: Mesh | Sequence[Mesh],
    view: ArrayLike | None = None,
    *,
    up: str = "y",
    field_of_view: float = FIELD_OF_VIEW,
    zoom: float = 1.0,
    focus: ArrayLike | None = None,
) -> Camera:
    """Place a camera so that the ball around the vertices fills 94 % of the picture.

    The ball does not depend on the direction, so that all views of a mesh have the same scale.
    Its centre is that of the bounding box; vertices that no face names are left out.

    Parameters
    ----------
    meshes
        One mesh, or several to be seen by one camera.
    view
        (azimuth, elevation) in degrees of the eye as seen from the mesh, or a vector from the
        mesh to the eye. Azimuth 0 is the front and grows to the right. The default is (30, 20),
        and (0, 0) for planar meshes (d = 2).
    up
        The axis that is vertical in the picture. ``"y"`` (front: z) suits meshes of computer
        graphics and ``"z"`` (front: -y) brains, scans and prints; files do not say which.
    field_of_view
        In degrees; smaller is flatter.
    zoom
        Magnification: the angle of view shrinks, the eye stays where it is.
    focus
        (3,) point in the middle of the picture; the centre of the ball by default.

    Raises
    ------
    EmptyMeshError
        If no mesh has a face.
    MeshError
        If the view, or the zoom, is none.

    Examples
    --------
    >>> triangle = Mesh([[0, 0], [2, 0], [0, 2]], [[0, 1, 2]])
    >>> fit_camera(triangle).target.tolist()
    [1.0, 1.0, 0.0]
    """
    meshes = [meshes] if isinstance(meshes, Mesh) else list(meshes)
    planar = bool(meshes) and all(mesh.dimension == 2 for mesh in meshes)
    center, radius = _ball([drawn_points(mesh) for mesh in meshes])
    frame = np.array(_FRAMES[check_name("axis", up, tuple(_FRAMES))], dtype=np.float64)
    direction = _direction(view, frame, planar)
    if not (math.isfinite(zoom) and zoom > 0):
        raise MeshError(f"a zoom of {zoom} is not a positive number")
    slope = np.tan(np.radians(field_of_view) / 2)
    distance = radius / np.sin(np.arctan(FILL * slope))
    target = center if focus is None else as_vector(focus, "the focus")
    vertical = frame[1] if np.linalg.norm(np.cross(direction, frame[1])) > 1e-6 else -frame[2]
    angle = float(np.degrees(2 * np.arctan(slope / zoom)))
    return Camera(target + distance * direction, target, vertical, angle)


def _direction(view: ArrayLike | None, frame: Floats, planar: bool) -> Floats:
    """Return the unit vector from the mesh to the eye."""
    if view is None:
        view = (0.0, 0.0) if planar else (30.0, 20.0)
    given = as_floats(view)
    if given.shape not in ((2,), (3,)) or not np.isfinite(given).all():
        raise MeshError(
            f"the view {shown(view)} is no direction",
            remedy="Give (azimuth, elevation) in degrees, or a vector of three numbers.",
        )
    if given.shape == (2,):
        azimuth, elevation = np.radians(given)
        level = np.cos(elevation)
        given = np.array([np.sin(azimuth) * level, np.sin(elevation), np.cos(azimuth) * level])
        given = given @ frame
    if not given.any():
        raise MeshError("the view is the vector zero, which is no direction")
    return unit_vector(given)


def drawn_points(mesh: Mesh) -> Floats:
    """Positions in space of the vertices that faces name."""
    positions, faces = in_space(mesh.vertices, mesh.faces)
    return np.asarray(positions[named_vertices(faces, len(positions))])


def named_vertices(faces: Integers, n: int) -> Booleans:
    """(n,) mask of the vertices that a face names: those that can be seen.

    Examples
    --------
    >>> named_vertices(np.array([[0, 1, 3]]), 4).tolist()
    [True, True, False, True]
    """
    named = np.zeros(n, np.bool_)
    named[faces] = True
    return named


def _ball(clouds: list[Floats]) -> tuple[Floats, float]:
    """Centre of the bounding box of all points, and the greatest distance from it."""
    points = np.concatenate(clouds) if clouds else np.zeros((0, 3))
    if not len(points):
        raise EmptyMeshError("there is no face to look at")
    low, high = points.min(axis=0), points.max(axis=0)
    center = low + (high - low) / 2
    scale = np.abs(points - center).max()  # the squares below neither overflow nor vanish
    if scale == 0:
        return center, 1.0  # one point: any distance will do
    return center, float(scale * np.linalg.norm((points - center) / scale, axis=1).max())
