"""Parameterization: a map of a surface to the plane, with its certificate."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, Integers, as_function, as_indices, read_only, rectangular
from beltrami._carded import Carded
from beltrami.errors import DimensionError, FoldedMapError
from beltrami.mesh.cut import Cut
from beltrami.mesh.mesh import Mesh
from beltrami.parameterization.certificate import Certificate, as_map, certify
from beltrami.parameterization.distortion import Distortion, measured
from beltrami.parameterization.location import Locator, locator


@dataclass(frozen=True, eq=False, repr=False)
class Parameterization(Carded):
    r"""A map :math:`\psi` of a surface to the plane, linear on the faces (l. 661 and 663).

    ``parameterize`` and ``flatten`` make it.

    Chapter items: U38, P70.

    Attributes
    ----------
    uv : (n, 2)
        The images of the vertices of ``mesh``, in float64.
    mesh : Mesh
        The surface, cut where it had to be; its faces are those of ``source``, in their order.
    vertex_map : (n,) int
        The vertex of ``source`` that each vertex of ``mesh`` is a copy of.
    cut_edges : (q, 2) int
        The edges of ``source`` that were cut.
    source : Mesh
        The surface as it was given.
    method : str
        What made the map, in words.
    certificate : Certificate
        Exact facts: flipped faces, crossings of the boundary.
    """

    uv: Floats
    mesh: Mesh
    vertex_map: Integers
    cut_edges: Integers
    source: Mesh
    method: str
    certificate: Certificate

    def __repr__(self) -> str:
        cut = f", {len(self.cut_edges)} edges cut" if len(self.cut_edges) else ""
        verdict = "a bijection" if self.is_bijective else "NOT a bijection"
        return (
            f"<Parameterization: {self.mesh.n_vertices} vertices{cut}, {self.method}; {verdict}, "
            f"{len(self.flipped)} flipped faces>"
        )

    @property
    def flipped(self) -> Integers:
        """The faces whose image is turned over or has no area."""
        return self.certificate.flipped

    @property
    def overlaps(self) -> Integers:
        """(q, 2, 2) pairs of boundary edges of ``mesh`` whose images meet where they should not."""
        return self.certificate.crossings

    @property
    def is_bijective(self) -> bool:
        """Whether the map is a bijection onto its image, decided exactly."""
        return self.certificate.is_bijective

    @cached_property
    def distortion(self) -> Distortion:
        """What the map does to lengths, angles and areas, for each face and in the mean."""
        return measured(self.mesh, self.uv)

    def image(self, faces: ArrayLike, barycentric: ArrayLike) -> Floats:
        r"""Return :math:`\psi` at points inside faces: the linear interpolation of ``uv``.

        Chapter items: P70.

        Parameters
        ----------
        faces
            (q,) indices of faces.
        barycentric
            (q, 3) coordinates in them, which add to 1.
        """
        at = as_indices(faces, self.mesh.n_faces, "faces", repeated=True)
        weights = as_function(barycentric, len(at), "the barycentric coordinates")
        if weights.shape != (len(at), 3):
            raise DimensionError(f"barycentric coordinates are ({len(at)}, 3)")
        return np.asarray(np.einsum("qc,qci->qi", weights, self.uv[self.mesh.faces[at]]))

    def original(self, points: ArrayLike) -> tuple[Integers, Floats]:
        r"""Return :math:`\psi^{-1}` at points of the plane: faces and barycentric coordinates.

        -1 and NaN outside the image. See ``Locator``; where the map is no bijection, one of the
        originals. Cost: O(m log² m) the first time, then O(log m) for each point.

        Chapter items: U38, P70.

        Examples
        --------
        >>> from beltrami.mesh.shapes import icosphere
        >>> from beltrami.parameterization.parameterize import parameterize
        >>> psi = parameterize(icosphere(2))
        >>> faces, inside = psi.original([[0.25, 0.5], [2.0, 2.0]])
        >>> psi.image(faces[:1], inside[:1]).round(12).tolist(), int(faces[1])
        ([[0.25, 0.5]], -1)
        """
        given = np.atleast_1d(rectangular(points))
        return self._locator.locate(as_map(given, len(given)))

    @cached_property
    def _locator(self) -> Locator:
        return locator(self.uv[self.mesh.faces])

    def evaluate(self, f: ArrayLike, points: ArrayLike) -> Floats:
        r"""Return :math:`f \circ \psi^{-1}` at points of the plane: NaN outside the image.

        With the positions as f it is the inverse of the map in space.

        Chapter items: U38, P70.

        Parameters
        ----------
        f
            (n,) or (n, c) values at the vertices of ``source``, or of ``mesh``.
        points
            (q, 2) points of the plane.

        Returns
        -------
        (q,) or (q, c): linear on each face.

        Examples
        --------
        >>> from beltrami.mesh.shapes import icosphere
        >>> from beltrami.parameterization.parameterize import parameterize
        >>> psi = parameterize(icosphere(3))
        >>> x = psi.evaluate(psi.source.vertices, [[0.0, 0.0], [0.0, 0.5], [2.0, 0.0]])
        >>> (x**2).sum(axis=1).round(1).tolist()  # on the sphere, on the sphere, nowhere
        [1.0, 1.0, nan]
        """
        values = self.to_map(f)
        faces, inside = self.original(points)
        found = np.einsum("qc,qc...->q...", inside, values[self.mesh.faces[faces]])
        return np.asarray(found)

    def to_map(self, f: ArrayLike) -> Floats:
        """Return a function on ``source`` as one on ``mesh``, and on ``flat``: copies are alike.

        A function that is on ``mesh`` already is returned as it is.

        Raises
        ------
        DimensionError, NonFiniteError
            If it is no function on either.
        """
        if len(np.atleast_1d(rectangular(f))) == self.mesh.n_vertices:
            return as_function(f, self.mesh.n_vertices)
        return np.asarray(as_function(f, self.source.n_vertices)[self.vertex_map])

    def from_map(self, g: ArrayLike) -> Floats:
        """Return a function on ``mesh``, or on ``flat``, as one on ``source``.

        At vertices on a cut it is the mean over the copies, which may differ.

        Examples
        --------
        >>> from beltrami.mesh.shapes import icosphere
        >>> from beltrami.parameterization.parameterize import parameterize
        >>> psi = parameterize(icosphere(2))
        >>> distance = np.linalg.norm(psi.uv, axis=1)  # from the middle of the disk
        >>> psi.from_map(distance).shape, psi.source.n_vertices
        ((162,), 162)
        """
        values = as_function(g, self.mesh.n_vertices)
        total = np.zeros((self.source.n_vertices, *values.shape[1:]))
        np.add.at(total, self.vertex_map, values)
        copies = np.bincount(self.vertex_map, minlength=len(total))
        return np.asarray((total.T / copies).T)

    @cached_property
    def textured(self) -> Mesh:
        """The source with ``corner_uv``: seams are in the corners, no vertex is doubled.

        Chapter items: P71.
        """
        source = self.source
        uv = self.uv[self.mesh.faces]
        return Mesh(source.vertices, source.topology, dict(source.vertex_data), uv)

    @cached_property
    def flat(self) -> Mesh:
        """The image: the faces of ``mesh`` with ``uv`` as positions in the plane.

        Functions on ``mesh`` are functions on it, and the reverse.

        Chapter items: P71.
        """
        return Mesh(self.uv, self.mesh.topology, dict(self.mesh.vertex_data))


def certified(source: Mesh, cut: Cut, uv: Floats, method: str, *, strict: bool) -> Parameterization:
    """Make the result; with ``strict`` raise FoldedMapError if it is not a bijection."""
    read_only(uv)
    certificate = certify(cut.mesh.topology, uv)
    found = Parameterization(uv, cut.mesh, cut.vertex_map, cut.edges, source, method, certificate)
    if strict and not found.is_bijective:
        crossed = len(certificate.crossings)
        raise FoldedMapError(
            f"the map folds: {len(found.flipped)} of {source.n_faces} faces are turned over or "
            f"have no area, and {crossed} pairs of boundary edges cross",
            faces=found.flipped,
            remedy='method="auto" folds less; strict=False returns the map as it is.',
        )
    return found
