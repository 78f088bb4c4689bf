"""The intrinsic Delaunay triangulation: other edges on the same surface, no negative cotangents."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats, Integers, read_only
from beltrami._kinds import checked
from beltrami.errors import ConvergenceError, NotOrientableError
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.topology import Topology
from beltrami.operators.cover import BACK, tufted_cover
from beltrami.operators.face_parts import FaceNumbers, face_numbers
from beltrami.operators.flips import flip_to_delaunay
from beltrami.operators.soundness import refuse_unreferenced, require_sound

_KEPT = 1e-6  # of the area: what rounding may change
_MOST = 1000  # flips for each edge: far more than needles take


@dataclass(frozen=True, eq=False, repr=False)
class IntrinsicTriangulation:
    """Triangles that know lengths, not positions; ``intrinsic_delaunay`` makes it.

    Its edges are straight lines inside the surface, which may cross several faces of the mesh.
    Two vertices may be joined by several edges, and a vertex to itself, so that a face may name a
    vertex twice. The half-edge 3 f + c is the side opposite corner c of face f.

    Attributes
    ----------
    faces : (m, 3) int
        Vertices of the corners. All faces are oriented alike.
    twins : (m, 3) int32
        The half-edge across each side; negative on the boundary, and where more than two faces
        share an edge.
    side_edges : (m, 3) int32
        The edge of each side. Without a cover, an edge that was flipped keeps its number in the
        mesh.
    flips : int
        How many flips were made.
    n_vertices : int
    """

    faces: Integers
    twins: NDArray[np.int32]
    side_edges: NDArray[np.int32]
    flips: int
    n_vertices: int
    dots: Floats = field(repr=False)  # (m, 3) dot products of the sides at the corners, in unit²
    double_areas: Floats = field(repr=False)  # (m,) in unit²
    unit: float = 1.0  # of length: a power of two, 1 but for extreme coordinates
    sheets: int = 1  # how often the surface is covered: what faces bring is divided by it

    def __repr__(self) -> str:
        return (
            f"<IntrinsicTriangulation: {self.n_vertices} vertices, {len(self.faces)} faces, "
            f"{self.flips} flips>"
        )

    @property
    def numbers(self) -> FaceNumbers:
        """The four numbers of each face."""
        return FaceNumbers(self.dots, self.double_areas, self.unit)

    @property
    def lengths(self) -> Floats:
        """(m, 3) lengths of the sides, each opposite its corner."""
        squared = np.roll(self.dots, -1, axis=1) + np.roll(self.dots, -2, axis=1)
        return np.asarray(np.sqrt(squared) * self.unit)

    @property
    def face_areas(self) -> Floats:
        """(m,) areas of the faces, in length²."""
        return self.numbers.areas

    @property
    def area_parts(self) -> Floats:
        """(m,) areas over the number of sheets: they add to the area of the surface."""
        return np.asarray(self.face_areas / self.sheets)

    @property
    def half_cotangents(self) -> Floats:
        """(m, 3) half the cotangents, over the number of sheets: the parts of the weights."""
        return np.asarray(self.dots / (2 * self.sheets * self.double_areas[:, None]))


@checked
def intrinsic_delaunay(mesh: Mesh, *, cover: bool = False) -> IntrinsicTriangulation:
    r"""Flip edges inside the surface until :math:`\cot\alpha + \cot\beta \ge 0` at each.

    An edge of two faces is flipped where the angles opposite it add to more than π: the two
    triangles are laid flat, and the other diagonal replaces it. The surface, its area and its
    vertices stay. It ends with a Delaunay triangulation of the surface, which is unique but for
    circles through more than three vertices (Bobenko and Springborn 2007).

    Edges of one face stay, also opposite an obtuse angle, where their weight is negative (S6 of
    the errata); so do edges of more than two faces. With ``cover`` there are none of these: the
    surface is taken twice, as the front and back of a closed one (see ``tufted_cover``).

    Parameters
    ----------
    mesh
        A sound mesh without unreferenced vertices.
    cover
        Whether to triangulate the tufted cover instead of the surface itself.

    Raises
    ------
    EmptyMeshError, NonFiniteError, DegenerateFaceError, UnreferencedVertexError
        If the mesh is not sound.
    NotOrientableError
        Without a cover, if the faces cannot be oriented alike. Faces that merely are not, are
        turned.
    ConvergenceError
        If it takes more than 1000 flips for each edge (it always stops), or if faces are so
        thin that rounding changed their area on the way.

    Notes
    -----
    Cost: O(m) and the flips, of which there are fewer than edges on usual meshes. Sums of
    cotangents count as negative below -1e-13 (1 + |cot α| + |cot β|), so edges whose four
    vertices lie on a circle are left alone.

    Examples
    --------
    >>> kite = Mesh([[0, 0], [4, 0], [2, 1], [2, -1]], [[0, 1, 2], [1, 0, 3]])
    >>> triangles = intrinsic_delaunay(kite)
    >>> triangles
    <IntrinsicTriangulation: 4 vertices, 2 faces, 1 flips>
    >>> triangles.faces.tolist(), triangles.lengths[0].round(3).tolist()
    ([[0, 3, 2], [1, 2, 3]], [2.0, 2.236, 2.236])
    """
    require_sound(mesh)
    if not mesh.topology.referenced.all():
        refuse_unreferenced(mesh.topology)
    topology = mesh.topology if cover else _oriented(mesh.topology)
    dots, double, unit = face_numbers(Mesh(mesh.vertices, topology))
    faces, twins, sides = topology.faces.copy(), topology.twins.copy(), topology.face_edges.copy()
    p = topology.n_edges
    if cover:
        faces, twins, sides = tufted_cover(topology)
        dots, double = np.concatenate([dots, dots[:, BACK]]), np.tile(double, 2)
        p = 3 * mesh.n_faces
    before = float(double.sum())
    flips = int(flip_to_delaunay(faces, twins, sides, dots, double, p, _MOST * p))
    if flips == -1:
        raise ConvergenceError(
            f"{_MOST * p} flips of {p} edges have not made the triangulation Delaunay"
        )
    _require_area(double, before, flips == -2)
    tables = (read_only(faces), read_only(twins), read_only(sides))
    numbers = (read_only(dots), read_only(double))
    sheets = 2 if cover else 1
    return IntrinsicTriangulation(*tables, flips, mesh.n_vertices, *numbers, unit, sheets)


def _require_area(double: Floats, before: float, stuck: bool) -> None:
    """Raise ConvergenceError if flips of needles stuck, or lost the area, which flips keep."""
    after = float(double.sum())
    if stuck or not (double.min() > 0 and abs(after - before) <= _KEPT * before):
        lost = f"twice the area went from {before:.6g} to {after:.6g}"
        lost = "an edge stays as it is" if stuck else lost
        raise ConvergenceError(
            f"faces are too thin to be flipped in floating point: {lost}. Make the thinnest faces "
            "less thin, or use cotangents of the faces as they are"
        )


def _oriented(topology: Topology) -> Topology:
    """Return the topology with all faces oriented like the first one of their component."""
    if topology.is_oriented:
        return topology
    turned = topology.orientation
    if turned is None:
        raise NotOrientableError(
            "the surface cannot be oriented, and flips of edges need an orientation",
            edges=topology.inconsistent_edges,
            remedy='Use cover=True, which is weights="tufted".',
        )
    faces = np.where(turned[:, None], topology.faces[:, ::-1], topology.faces)
    return Topology(faces, topology.n_vertices)
