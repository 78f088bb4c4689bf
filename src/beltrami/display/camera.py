"""The camera: a perspective projection (l. 70)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats
from beltrami.display.vectors import as_vector, unit_vector
from beltrami.errors import MeshError

FIELD_OF_VIEW = 24.0  # degrees: a portrait lens, little distortion


@dataclass(frozen=True, eq=False, init=False)
class Camera:
    """A pinhole camera.

    Attributes
    ----------
    position : (3,) float
        Where the eye is.
    target : (3,) float
        The point seen in the middle of the picture.
    up : (3,) float
        The direction that is vertical in the picture; not parallel to the line of sight.
    field_of_view : float
        Angle, in degrees, that the shorter side of the picture spans.

    Examples
    --------
    >>> camera = Camera((0, 0, 10), (0, 0, 0), (0, 1, 0), field_of_view=90)
    >>> camera.project([[0, 0, 0], [10, 0, 0], [0, 4, 5]], size=(200, 100)).round(9).tolist()
    [[100.0, 50.0, 10.0], [150.0, 50.0, 10.0], [100.0, 10.0, 5.0]]
    """

    position: Floats
    target: Floats
    up: Floats
    field_of_view: float

    def __init__(
        self,
        position: ArrayLike,
        target: ArrayLike,
        up: ArrayLike,
        field_of_view: float = FIELD_OF_VIEW,
    ) -> None:
        for name, value in (("position", position), ("target", target), ("up", up)):
            object.__setattr__(self, name, as_vector(value, f"the {name} of the camera"))
        object.__setattr__(self, "field_of_view", float(field_of_view))
        sight = self.target - self.position
        if not np.linalg.norm(np.cross(unit_vector(sight), unit_vector(self.up))) > 1e-9:
            raise MeshError(
                "the camera looks along its own vertical, or nowhere",
                remedy="Move the position away from the target, and choose another `up`.",
            )
        if not 0 < self.field_of_view < 180:
            raise MeshError(f"a field of view of {self.field_of_view} is not between 0 and 180")

    @property
    def axes(self) -> Floats:
        """(3, 3): unit vectors to the right, upwards and forwards, as rows."""
        forward = unit_vector(self.target - self.position)
        right = unit_vector(np.cross(forward, unit_vector(self.up)))
        return np.stack([right, np.cross(right, forward), forward])

    def view_coordinates(self, points: ArrayLike) -> Floats:
        """(n, 3): how far to the right, upwards and forwards of the eye the points are."""
        return np.asarray((np.asarray(points, dtype=np.float64) - self.position) @ self.axes.T)

    def focal_length(self, size: tuple[int, int]) -> float:
        """Distance of the picture plane, in pixels, for a picture of (width, height) pixels."""
        return float(min(size) / 2 / np.tan(np.radians(self.field_of_view) / 2))

    def project(self, points: ArrayLike, size: tuple[int, int]) -> Floats:
        """(n, 3): pixel coordinates x to the right, y downwards, and the depth of each point.

        (0, 0) is the upper left corner of the picture; the centre of its first pixel is
        (0.5, 0.5). The depth is along the line of sight, in the unit of the points.

        Chapter items: P8.

        Raises
        ------
        MeshError
            If a point is not in front of the eye: it has no image; ``error.vertices`` lists them.
        """
        x, y, depth = self.view_coordinates(points).T
        if not (depth > 0).all():
            raise MeshError(
                "points that are not in front of the camera have no image",
                vertices=np.flatnonzero(~(depth > 0)),
            )
        focal = self.focal_length(size)
        return np.stack(
            [size[0] / 2 + focal * x / depth, size[1] / 2 - focal * y / depth, depth], 1
        )
