"""Distortion: what a map to the plane does to lengths, angles and areas (l. 683, E91)."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, read_only
from beltrami.mesh.door import require_mesh
from beltrami.mesh.geometry import in_space, well_scaled
from beltrami.mesh.mesh import Mesh
from beltrami.operators.soundness import require_sound
from beltrami.parameterization.certificate import as_map


@dataclass(frozen=True, eq=False, repr=False)
class Distortion:
    r"""The singular values of a map on each face, and what follows from them.

    Summaries are means over the surface, and are 1 for an isometry up to scale; they do not
    change if the map is scaled.

    Attributes
    ----------
    singular_values : (m, 2)
        :math:`\sigma_1 \ge \sigma_2 \ge 0`, by how much lengths grow at most and at least.
    areas : (m,)
        The areas of the faces of the surface.
    """

    singular_values: Floats
    areas: Floats

    def __repr__(self) -> str:
        return (
            f"<Distortion: conformal {self.mean_conformal:.4g}, area {self.mean_area:.4g}, "
            f"symmetric Dirichlet {self.symmetric_dirichlet:.4g} (1 = isometry)>"
        )

    @cached_property
    def scale(self) -> float:
        """By how much the map would have to shrink to keep the area of the surface."""
        return float(np.sqrt(self.areas @ self.singular_values.prod(axis=1) / self.areas.sum()))

    @cached_property
    def conformal(self) -> Floats:
        r"""(m,) :math:`\sigma_1 / \sigma_2`: 1 where angles are kept, infinite without area."""
        return read_only(_ratio(self.singular_values[:, 0], self.singular_values[:, 1]))

    @cached_property
    def area(self) -> Floats:
        r"""(m,) :math:`\sigma_1 \sigma_2` over its mean: 1 where areas are kept."""
        return read_only(self.singular_values.prod(axis=1) / (self.scale**2 or 1.0))

    @cached_property
    def energy(self) -> Floats:
        r"""(m,) symmetric Dirichlet energy of the map scaled best.

        :math:`(\sigma_1^2 + \sigma_2^2 + \sigma_1^{-2} + \sigma_2^{-2}) / 4` (J. Smith, S.
        Schaefer, Bijective parameterization with free boundaries, 2015), where the scale makes the
        mean smallest.
        """
        grown, shrunk = self._squares
        means = float(self._mean(shrunk)), float(self._mean(grown))
        finite = means[1] > 0 and math.isfinite(means[0])
        best = math.sqrt(means[0] / means[1]) if finite else 1.0
        return read_only(np.asarray((grown * best + shrunk / best) / 4))

    @property
    def mean_conformal(self) -> float:
        """Mean of the ratio of the singular values."""
        return float(self._mean(self.conformal))

    @property
    def mean_area(self) -> float:
        """Mean of the larger one of the ratio of areas and its inverse."""
        return float(self._mean(np.maximum(self.area, _ratio(np.ones(1), self.area))))

    @property
    def symmetric_dirichlet(self) -> float:
        """Mean of ``energy``: at least 1, and 1 for isometries alone."""
        grown, shrunk = (float(self._mean(squares)) for squares in self._squares)
        return math.inf if math.isinf(shrunk) else math.sqrt(grown) * math.sqrt(shrunk) / 2

    @cached_property
    def _squares(self) -> tuple[Floats, Floats]:
        s = self.singular_values / (self.scale or 1.0)
        with np.errstate(over="ignore"):
            return (s**2).sum(axis=1), (_ratio(np.ones(1), s) ** 2).sum(axis=1)

    def _mean(self, values: Floats) -> Floats:
        with np.errstate(over="ignore"):
            return np.asarray((self.areas / self.areas.sum() * values).sum())


def distortion(mesh: Mesh, uv: ArrayLike) -> Distortion:
    r"""Measure the distortion of a map of the vertices to the plane, linear on the faces.

    Cost: O(m).

    Chapter items: P74.

    Raises
    ------
    EmptyMeshError, NonFiniteError, DegenerateFaceError
        If the mesh is not sound.
    DimensionError, NonFiniteError
        If ``uv`` is no (n, 2) array of finite numbers.

    Examples
    --------
    >>> square = Mesh([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1, 2], [0, 2, 3]])
    >>> distortion(square, square.vertices @ [[2, 0], [0, 1]]).singular_values.round(12).tolist()
    [[2.0, 1.0], [2.0, 1.0]]
    """
    require_sound(require_mesh(mesh, "a distortion"))
    return measured(mesh, as_map(uv, mesh.n_vertices))


def measured(mesh: Mesh, x: Floats, g: Floats | None = None) -> Distortion:
    """Measure without checking; g are the slopes, if they are known."""
    g = slopes(mesh) if g is None else g
    return Distortion(read_only(singular_values(*jacobians(mesh, x, g))), mesh.face_areas)


def slopes(mesh: Mesh) -> Floats:
    """Return (m, 3, 2): the gradient of each corner's hat function, in a frame of its face.

    The frame has its first direction along the first side, and the orientation of the face. The
    unit is 1/length.
    """
    scaled, unit = well_scaled(mesh.vertices)
    positions, corners = in_space(scaled, mesh.faces)
    u = positions[corners[:, 1]] - positions[corners[:, 0]]
    v = positions[corners[:, 2]] - positions[corners[:, 0]]
    length = np.linalg.norm(u, axis=1)
    height = np.linalg.norm(np.cross(u, v), axis=1) / length
    slant = (u * v).sum(axis=1) / length**2
    along = np.stack([-1 / length, 1 / length, np.zeros(len(u))], axis=1)
    across = np.stack([slant - 1, -slant, np.ones(len(u))], axis=1) / height[:, None]
    return np.stack([along, across], axis=2) / unit


def jacobians(mesh: Mesh, x: Floats, g: Floats) -> tuple[Floats, Floats]:
    """Return the (m, 2) derivatives of the map along the two directions of ``slopes``.

    Differences come first, so that a map of a tiny region far from 0 keeps its digits.
    """
    p = x[mesh.faces[:, 1]] - x[mesh.faces[:, 0]]
    q = x[mesh.faces[:, 2]] - x[mesh.faces[:, 0]]
    a, b = (p * g[:, 1, c, None] + q * g[:, 2, c, None] for c in range(2))
    return a, b


def singular_values(a: Floats, b: Floats) -> Floats:
    """Return the singular values of the matrices with the columns a and b, the larger first.

    The smaller one is the determinant over the larger, which keeps its digits.
    """
    turned = np.hypot(a[:, 0] + b[:, 1], a[:, 1] - b[:, 0])
    mirrored = np.hypot(a[:, 0] - b[:, 1], a[:, 1] + b[:, 0])
    large = (turned + mirrored) / 2
    with np.errstate(under="ignore"):
        determinant = np.abs(a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    small = np.divide(determinant, large, out=np.zeros_like(large), where=large > 0)
    return np.stack([large, np.minimum(small, large)], axis=1)


def _ratio(a: Floats, b: Floats) -> Floats:
    """Return a / b, infinite where b is 0 or nearly so."""
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        return np.asarray(np.where(b > 0, a / np.where(b > 0, b, 1), np.inf))
