"""TextureAtlas: charts of a mesh in one square, and how they came there."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from beltrami._arrays import Floats, Integers, read_only
from beltrami._carded import Carded
from beltrami.mesh.mesh import Mesh
from beltrami.parameterization.certificate import Certificate
from beltrami.parameterization.distortion import Distortion
from beltrami.parameterization.parameterization import Parameterization


@dataclass(frozen=True, eq=False, repr=False)
class TextureAtlas(Carded):
    """A surface in charts, which lie apart from each other in the unit square.

    ``atlas`` makes it.

    Attributes
    ----------
    uv : (m, 3, 2) float
        Texture coordinates of the corners of the faces, in [0, 1]².
    labels : (m,) int
        The chart of each face, 0 to count - 1.
    map : Parameterization
        The same as one map of the surface cut open: ``map.mesh`` has a copy of a vertex for each
        chart that it is in, ``map.vertex_map`` is the way back, ``map.original`` finds the point
        of the surface that a point of the square belongs to.
    size, padding : int
        Texels along a side of the square, and kept free around each chart.
    """

    uv: Floats
    labels: Integers
    map: Parameterization
    size: int
    padding: int

    def __repr__(self) -> str:
        verdict = "no overlap" if self.is_bijective else "NOT a bijection"
        return (
            f"<TextureAtlas: {len(self.labels)} faces in {self.count} charts, {verdict}, "
            f"{self.fill:.0%} of the square filled, {self.distortion!r}>"
        )

    @property
    def count(self) -> int:
        """Number of charts."""
        return int(self.labels.max()) + 1

    @property
    def mesh(self) -> Mesh:
        """The surface as it was given, with ``corner_uv``: no vertex is doubled."""
        return self.map.textured

    @property
    def seams(self) -> Integers:
        """(q, 2) int: the edges of the surface that were cut."""
        return self.map.cut_edges

    @property
    def certificate(self) -> Certificate:
        """Exact facts about all charts together: flipped faces, crossings, charts in others."""
        return self.map.certificate

    @property
    def is_bijective(self) -> bool:
        """Whether no face is turned over and nothing overlaps, decided exactly."""
        return self.map.is_bijective

    @property
    def distortion(self) -> Distortion:
        """What the whole does to lengths, with one scale for all charts."""
        return self.map.distortion

    @cached_property
    def fill(self) -> float:
        """The part of the square that the charts cover."""
        u, v = self.uv[:, 1] - self.uv[:, 0], self.uv[:, 2] - self.uv[:, 0]
        return float((u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]).sum() / 2)

    @cached_property
    def chart_distortion(self) -> Floats:
        """(count,) float: the mean symmetric Dirichlet energy of each chart, 1 for isometries."""
        areas = self.distortion.areas
        total = np.bincount(self.labels, areas * self.distortion.energy, self.count)
        return read_only(total / np.bincount(self.labels, areas, self.count))

    @cached_property
    def density(self) -> Floats:
        """(count,) float: texels per unit of length, in the mean over each chart."""
        s = self.distortion.singular_values.prod(axis=1)
        areas = self.distortion.areas
        shares = np.bincount(self.labels, areas * s, self.count)
        return read_only(self.size * np.sqrt(shares / np.bincount(self.labels, areas, self.count)))
