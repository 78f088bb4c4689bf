"""What single faces bring to the pair (L, B): their four numbers, weights of sides, masses."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from beltrami._arrays import Floats, Integers
from beltrami._jit import kernel
from beltrami.mesh.geometry import in_space, well_scaled
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.triangle import measure, shares
from beltrami.operators.areas import AREA_KINDS


class FaceNumbers(NamedTuple):
    """The four numbers of each face, from which its weights and areas follow.

    Attributes
    ----------
    dots : (m, 3) float
        Dot products of the sides at the corners, in unit².
    double : (m,) float
        Twice the areas, in unit².
    unit : float
        Of length: a power of two, 1 but for extreme coordinates.
    """

    dots: Floats
    double: Floats
    unit: float

    @property
    def areas(self) -> Floats:
        """(m,) areas of the faces, in length²."""
        return np.asarray(self.double / 2 * self.unit**2)

    @property
    def half_cotangents(self) -> Floats:
        """(m, 3) half the cotangent at each corner: the part of the weight of the side opposite."""
        return np.asarray(self.dots * (0.5 / self.double)[:, None])


def face_numbers(mesh: Mesh) -> FaceNumbers:
    """Measure the faces of a mesh that is known to be sound. Cost: O(m).

    Examples
    --------
    >>> dots, double, unit = face_numbers(Mesh([[0, 0], [2, 0], [0, 1]], [[0, 1, 2]]))
    >>> (dots + 0.0).tolist(), double.tolist(), unit
    ([[0.0, 4.0, 1.0]], [2.0], 1.0)
    """
    scaled, unit = well_scaled(mesh.vertices)
    dots, double = np.empty((mesh.n_faces, 3)), np.empty(mesh.n_faces)
    _measure_faces(*in_space(scaled, mesh.faces), dots, double)
    return FaceNumbers(dots, double, unit)


def split_masses(
    kind: str, sides: Floats, faces: Integers, n: int, numbers: FaceNumbers | None = None
) -> Floats:
    """Return the (m, 3) parts of the masses of the vertices that the faces bring to their corners.

    For the ``"consistent"`` mass it is A/12 at each corner, instead of a matrix: the eigenvalues
    of the pair of a face are the same, because L_f 1 = 0.

    Parameters
    ----------
    kind
        A mass: see ``laplacian``.
    sides
        (m, 3) the parts of the weights of the sides; used by ``"degree"`` alone.
    faces, n
        The vertices of the corners, and how many vertices there are.
    numbers
        Needed for areas; not for ``"degree"`` and ``"unit"``.
    """
    if kind == "degree":
        u, v, w = sides.T
        return np.stack([v + w, w + u, u + v], axis=1)
    if numbers is None or kind == "unit":
        around = np.bincount(faces.ravel(), minlength=n)
        return np.asarray(1 / around[faces])
    if kind == "consistent":
        return np.repeat(numbers.areas[:, None] / 12, 3, axis=1)
    parts = np.asarray(_shares(numbers.dots, numbers.double, AREA_KINDS[kind]))
    return parts * numbers.unit**2


@kernel
def _measure_faces(x: Any, corners: Any, dots: Any, double: Any) -> None:
    """Fill the four numbers of each face: the dot products at its corners, twice its area."""
    for f in range(corners.shape[0]):
        dots[f, 0], dots[f, 1], dots[f, 2], double[f] = measure(
            x, corners[f, 0], corners[f, 1], corners[f, 2]
        )


@kernel
def _shares(dots: Any, double: Any, kind: int) -> Any:
    """Split the area of each face among its corners."""
    out = np.empty(dots.shape)
    for f in range(dots.shape[0]):
        out[f, 0], out[f, 1], out[f, 2] = shares(
            dots[f, 0], dots[f, 1], dots[f, 2], double[f], kind
        )
    return out
