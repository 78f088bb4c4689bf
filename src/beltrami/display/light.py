"""Light: the intensity I(i) = max(<n_i, l(i)>, 0) that a lamp gives to each vertex (l. 107)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats
from beltrami.display.camera import Camera
from beltrami.display.vectors import as_points, as_vector
from beltrami.errors import MeshError, check_name
from beltrami.mesh.geometry import in_space, unit
from beltrami.mesh.mesh import Mesh

SHADINGS = ("gouraud", "flat")


@dataclass(frozen=True, eq=False, init=False)
class DirectionalLight:
    """A light at infinity: l(i) = l for every vertex.

    Chapter items: P11.

    Attributes
    ----------
    direction : (3,) float
        From the mesh TOWARDS the light; any length but zero.
    """

    direction: Floats

    def __init__(self, direction: ArrayLike) -> None:
        vector = as_vector(direction, "the direction of the light")
        if not vector.any():
            raise MeshError("the direction of the light is zero, which is no direction")
        object.__setattr__(self, "direction", vector)

    def towards(self, points: ArrayLike) -> Floats:
        """(n, 3) unit vectors from the points (n, 3) to the light."""
        shape = as_points(points, "the points").shape
        return np.repeat(unit(self.direction[None]), shape[0], axis=0)


@dataclass(frozen=True, eq=False, init=False)
class SpotLight:
    """A lamp at a point s: l(i) = (s - x_i) / |s - x_i|.

    Chapter items: P12.

    Attributes
    ----------
    position : (3,) float
        The point s, in the coordinates of the mesh.
    """

    position: Floats

    def __init__(self, position: ArrayLike) -> None:
        object.__setattr__(self, "position", as_vector(position, "the position of the light"))

    def towards(self, points: ArrayLike) -> Floats:
        """(n, 3) unit vectors from the points (n, 3) to the light; zero at the light itself."""
        return unit(self.position - as_points(points, "the points"))


Light: TypeAlias = DirectionalLight | SpotLight


def light_intensity(mesh: Mesh, light: Light, shading: str = "gouraud") -> Floats:
    """Intensity I(i) = max(<n_i, l(i)>, 0) of each vertex, in [0, 1] (l. 107).

    l(i) is the unit vector that points towards the light. The chapter prints v_i - s, which
    lights the far side (erratum E11).

    Chapter items: U11.

    Parameters
    ----------
    mesh
        In the plane or in space.
    light
        A ``DirectionalLight`` or a ``SpotLight``.
    shading
        ``"gouraud"``: at the vertices; ``"flat"``: at the middles of the faces.

    Returns
    -------
    (n,) or (m,) float
        0 where there is no normal (all faces around are flat), and at a vertex that is the
        position of the lamp, where no direction leads to it.

    Examples
    --------
    >>> mesh = Mesh([[1, 0, 0], [0, 1, 0], [-1, -1, 0]], [[0, 1, 2]])
    >>> light_intensity(mesh, SpotLight((1, 0, 5))).round(3).tolist()
    [1.0, 0.962, 0.913]
    >>> light_intensity(mesh, DirectionalLight((0, 0, -1))).tolist()
    [0.0, 0.0, 0.0]
    """
    check_name("shading", shading, SHADINGS)
    points, faces = in_space(mesh.vertices, mesh.faces)
    if shading == "flat":
        return incident(mesh.face_normals, points[faces].mean(axis=1), light)
    return incident(mesh.vertex_normals, points, light)


def incident(normals: Floats, points: Floats, light: Light) -> Floats:
    """max(<n, l>, 0) of each row of unit normals and points."""
    return np.clip(np.einsum("ix,ix->i", normals, light.towards(points)), 0.0, 1.0)


def over_the_shoulder(camera: Camera) -> DirectionalLight:
    """Light from above the left shoulder of the viewer."""
    return DirectionalLight(np.array([-0.42, 0.55, -0.85]) @ camera.axes)


def from_the_side(camera: Camera) -> DirectionalLight:
    """Light from the right, weak and a little below, so that no side is black."""
    return DirectionalLight(np.array([0.85, -0.15, -0.45]) @ camera.axes)
