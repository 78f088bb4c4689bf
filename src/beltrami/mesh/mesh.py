"""Mesh: a topology and a position for each of its vertices."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beltrami._arrays import Floats, Integers, frozen, read_only, rectangular
from beltrami._carded import Carded
from beltrami._frozen import Frozen
from beltrami.errors import DimensionError, MeshError, NotClosedError, shown
from beltrami.mesh import geometry
from beltrami.mesh.export import export
from beltrami.mesh.requirements import require_edge_manifold, require_oriented
from beltrami.mesh.topology import Topology


class Mesh(Frozen, Carded):
    """A triangle mesh: the topology M = (V, E, F) and positions x_i (section 3.1.2).

    Nothing is reordered, merged or repaired. Shapes and indices are checked here; defects
    (NaN, flat faces, unreferenced vertices ...) are named by ``diagnose``.

    Chapter items: D5, U5, U6, U9, U10, U12, P4.

    Parameters
    ----------
    vertices
        (n, d) positions, d >= 2. Lists, float32 and integers are accepted.
    faces
        (m, 3) integers, 0-based, counter-clockwise seen from outside; or a Topology to share.
    vertex_data
        Named functions on the vertices: (n,) or (n, c) arrays, kept through files and verbs.
    corner_uv
        (m, 3, 2) texture coordinates of the corners of the faces.

    Raises
    ------
    DimensionError
        If an array has the wrong shape.
    MeshError
        If a face names a vertex that does not exist; ``error.faces`` lists them.

    Examples
    --------
    >>> mesh = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
    ...             [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    >>> mesh
    <Mesh: 4 vertices in R³, 4 faces>
    >>> round(mesh.volume, 12), mesh.euler_characteristic, mesh.genus
    (0.166666666667, 2, 0)
    """

    vertices: Floats
    topology: Topology
    vertex_data: Mapping[str, NDArray[Any]]
    corner_uv: Floats | None

    def __init__(
        self,
        vertices: ArrayLike,
        faces: ArrayLike | Topology,
        vertex_data: Mapping[str, ArrayLike] | None = None,
        corner_uv: ArrayLike | None = None,
    ) -> None:
        positions = frozen(vertices, np.float64)
        if positions.size == 0 and positions.ndim == 1:
            positions = frozen(np.zeros((0, 3)), np.float64)
        if positions.ndim != 2 or positions.shape[1] < 2:
            raise DimensionError(
                f"vertices have the shape {positions.shape} where (n, d) with d >= 2 is needed"
            )
        topology = faces if isinstance(faces, Topology) else Topology(faces, len(positions))
        if topology.n_vertices != len(positions):
            raise DimensionError(
                f"{len(positions)} vertices for a topology of {topology.n_vertices}"
            )
        uv = None if corner_uv is None else frozen(corner_uv, np.float64)
        if uv is not None and uv.shape != (topology.n_faces, 3, 2):
            raise DimensionError(
                f"corner_uv has the shape {uv.shape} where ({topology.n_faces}, 3, 2) is needed"
            )
        self.__dict__.update(
            vertices=positions,
            topology=topology,
            vertex_data=_checked_data({} if vertex_data is None else vertex_data, len(positions)),
            corner_uv=uv,
        )

    def __reduce__(self) -> Any:  # what is derived is not stored
        return Mesh, (self.vertices, self.topology, dict(self.vertex_data), self.corner_uv)

    def __repr__(self) -> str:
        space = f"R{'⁰¹²³⁴⁵⁶⁷⁸⁹'[self.dimension] if self.dimension < 10 else self.dimension}"
        data = f", data {', '.join(map(repr, self.vertex_data))}" if self.vertex_data else ""
        uv = ", uv" if self.corner_uv is not None else ""
        return f"<Mesh: {self.n_vertices} vertices in {space}, {self.n_faces} faces{data}{uv}>"

    def with_vertices(self, vertices: ArrayLike) -> Mesh:
        """Return the mesh with other positions, sharing the topology and what it has computed.

        Data and texture coordinates are kept, except data named "normal", which would no longer
        be true.

        Chapter items: X2.
        """
        kept = {name: data for name, data in self.vertex_data.items() if name != "normal"}
        return Mesh(vertices, self.topology, kept, self.corner_uv)

    def with_data(self, **functions: ArrayLike) -> Mesh:
        """Return the mesh with more functions on its vertices, in ``vertex_data``."""
        return Mesh(self.vertices, self.topology, {**self.vertex_data, **functions}, self.corner_uv)

    def to(self, target: str) -> Any:
        """Return this mesh as an object of another library, in order; ``as_mesh`` is the way back.

        "trimesh", "pyvista" and "meshio" take ``vertex_data`` along, "open3d" (its newer kind of
        mesh) and "polyscope" (registered as "beltrami mesh") ``corner_uv`` too, "arrays" neither.
        See ``mesh.export``.
        """
        return export(self, target)

    # ---------------------------------------------------------------- topology

    @property
    def faces(self) -> Integers:
        """(m, 3) int: the vertices of each face, counter-clockwise seen from outside."""
        return self.topology.faces

    @property
    def n_vertices(self) -> int:
        """Number of vertices n."""
        return len(self.vertices)

    @property
    def n_faces(self) -> int:
        """Number of faces m."""
        return len(self.faces)

    @property
    def n_edges(self) -> int:
        """Number of edges p."""
        return self.topology.n_edges

    @property
    def dimension(self) -> int:
        """Number of coordinates d of a vertex."""
        return int(self.vertices.shape[1])

    @property
    def edges(self) -> Integers:
        """(p, 2) int: each edge once, i < j, in lexicographic order."""
        return self.topology.edges

    @property
    def boundary_loops(self) -> tuple[Integers, ...]:
        """The vertices of each boundary loop in order, the longest first."""
        return self.topology.boundary_loops

    @property
    def euler_characteristic(self) -> int:
        """V - E + F, over the vertices that faces name."""
        return self.topology.euler_characteristic

    @property
    def genus(self) -> int:
        """Number of handles; raises where the mesh is not an orientable manifold."""
        return self.topology.genus

    @property
    def is_closed(self) -> bool:
        """Whether there are faces, and every edge has at least two of them."""
        return self.topology.is_closed

    @property
    def is_manifold(self) -> bool:
        """Whether the faces around each vertex form one disk or one half disk (E9)."""
        return self.topology.is_manifold

    @property
    def is_oriented(self) -> bool:
        """Whether neighbouring faces agree on which side is outside."""
        return self.topology.is_oriented

    def components(self, through: str = "vertices") -> Integers:
        """Label of the component of each face, through common vertices or common ``"edges"``."""
        return self.topology.components(through)

    def ring(self, i: int, s: int = 1, kind: str = "exact") -> Integers:
        """Vertices of the s-ring of i: at distance s ("exact"), within it ("ball"), or "walk"."""
        return self.topology.ring(i, s, kind)

    def face_ring(self, i: int) -> Integers:
        """Faces around vertex i."""
        return self.topology.face_ring(i)

    # ---------------------------------------------------------------- geometry

    @cached_property
    def face_areas(self) -> Floats:
        """(m,) areas of the faces, in length²."""
        return read_only(geometry.face_areas(self.vertices, self.faces))

    @cached_property
    def face_normals(self) -> Floats:
        """(m, 3) unit normals of the faces (l. 101); zero where a face is flat."""
        self._require_space("normals")
        vertices, _ = geometry.well_scaled(self.vertices)
        return read_only(geometry.unit(geometry.face_vectors(vertices, self.faces)))

    @cached_property
    def vertex_normals(self) -> Floats:
        """(n, 3) unit normals at the vertices, weighted by the angles (E10)."""
        return read_only(self.weighted_normals("angle"))

    def weighted_normals(self, weights: str) -> Floats:
        """(n, 3) unit normals at the vertices, with "uniform" (l. 105), "area" or "angle" weights.

        They are zero at a vertex of no face, and where the mean vanishes.
        """
        self._require_space("normals")
        return geometry.vertex_normals(self.vertices, self.faces, weights)

    @cached_property
    def corner_angles(self) -> Floats:
        """(m, 3) angles of the faces at their corners, in radians; they add to π in a face."""
        return read_only(geometry.corner_angles(self.vertices, self.faces))

    @cached_property
    def edge_lengths(self) -> Floats:
        """(p,) lengths of the edges."""
        i, j = self.edges.T
        scaled, unit = geometry.well_scaled(self.vertices)
        return read_only(np.linalg.norm(scaled[j] - scaled[i], axis=1) * unit)

    @property
    def area(self) -> float:
        """Area of the surface."""
        return float(self.face_areas.sum())

    @property
    def volume(self) -> float:
        """Volume enclosed, positive if the normals point outwards; the unit is length³.

        Raises NotClosedError on a surface with boundary, and NotManifoldError or
        NotOrientableError where inside and outside are not told apart.
        """
        self._require_space("a volume")
        self._require_inside()
        x, _ = geometry.in_space(self.vertices, self.faces)
        x = x - x[self.faces[0, 0]]  # near by, so that digits are kept
        vectors = geometry.face_vectors(x, self.faces)
        i, j, k = self.faces.T
        middle = (x[i] + x[j] + x[k]) / 3
        return float(np.einsum("fc,fc->", middle, vectors) / 6)

    def _require_space(self, what: str) -> None:
        if self.dimension > 3:
            raise DimensionError(
                f"{what} need vertices with 2 or 3 coordinates, and these have {self.dimension}",
                remedy="Keep three of them: mesh.with_vertices(mesh.vertices[:, :3]).",
            )

    def _require_inside(self) -> None:
        topology = self.topology
        if not topology.is_closed:
            raise NotClosedError(
                "the surface has a boundary, so it encloses no volume",
                edges=topology.boundary_edges,
            )
        require_edge_manifold(
            topology, "edges with more than two faces leave inside and outside undefined"
        )
        require_oriented(
            topology,
            "neighbouring faces disagree on which side is outside",
            one_sided="The surface has one side and encloses nothing.",
        )


def _checked_data(data: Mapping[str, ArrayLike], n: int) -> Mapping[str, NDArray[Any]]:
    """Freeze the functions on the vertices; each has n rows and one or two axes."""
    if not isinstance(data, Mapping):
        raise MeshError(f"vertex_data maps names to arrays, and is not {shown(data)}")
    arrays = {name: frozen(values, rectangular(values).dtype) for name, values in data.items()}
    for name, values in arrays.items():
        if values.ndim not in (1, 2) or len(values) != n:
            raise MeshError(
                f"vertex_data[{name!r}] has the shape {values.shape} where ({n},) or ({n}, c) "
                "is needed"
            )
    return MappingProxyType(arrays)
