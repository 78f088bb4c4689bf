"""Diagnosis: every defect of a mesh, where it is, and what to do about it."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from beltrami._arrays import Booleans, Integers, read_only
from beltrami._carded import Carded
from beltrami.mesh.door import require_mesh
from beltrami.mesh.duplicates import duplicate_faces, duplicate_vertices
from beltrami.mesh.geometry import degenerate_faces
from beltrami.mesh.mesh import Mesh


@dataclass(frozen=True)
class Defect:
    """One kind of defect: what it is called, which elements have it, and the remedy."""

    name: str
    element: str
    indices: Integers
    remedy: str

    @property
    def count(self) -> int:
        """How many elements have it."""
        return len(self.indices)

    def __str__(self) -> str:
        shown = ", ".join(str(index) for index in self.indices[:5].tolist())
        more = f", ... ({self.count} in all)" if self.count > 5 else ""
        return f"{self.count} {self.name}: {self.element} {shown}{more}. {self.remedy}"


@dataclass(frozen=True, eq=False)
class Diagnosis(Carded):
    """What is wrong with a mesh, as indices; every array is empty for a clean mesh.

    Attributes
    ----------
    non_finite_vertices, unreferenced_vertices, duplicate_vertices, non_manifold_vertices
        Vertices with a NaN or infinite coordinate; in no face; with exactly the coordinates of
        an earlier vertex; whose faces form more than one fan.
    degenerate_faces, duplicate_faces
        Faces without area (or naming a vertex twice); with the same vertices as an earlier face.
    non_manifold_edges, inconsistent_edges, boundary_edges
        Pairs of vertices: edges of more than two faces; whose two faces disagree about the
        outside; with one face. A boundary is a fact, not a defect.
    """

    n_vertices: int
    n_faces: int
    n_edges: int
    n_components: int
    n_boundary_loops: int | None
    euler_characteristic: int
    genus: int | None
    is_closed: bool
    is_manifold: bool
    is_oriented: bool
    is_orientable: bool
    area: float
    volume: float | None
    non_finite_vertices: Integers
    unreferenced_vertices: Integers
    duplicate_vertices: Integers
    non_manifold_vertices: Integers
    degenerate_faces: Integers
    duplicate_faces: Integers
    non_manifold_edges: Integers
    inconsistent_edges: Integers
    boundary_edges: Integers

    @property
    def defects(self) -> tuple[Defect, ...]:
        """The defects found, the worst first, each with its remedy."""
        cures = {"inconsistent_edges": _ONE_SIDED} if not self.is_orientable else {}
        found = (
            Defect(name, kind, getattr(self, key), cures.get(key, cure))
            for key, name, kind, cure in _CURES
        )
        return tuple(defect for defect in found if defect.count)

    @property
    def is_clean(self) -> bool:
        """Whether nothing is wrong; a boundary or several components are nothing wrong."""
        return not self.defects

    def report(self) -> str:
        """Return the diagnosis as text, a line for each fact and each defect."""
        return "\n".join([*self._facts(), *(f"- {defect}" for defect in self.defects)])

    def to_dict(self) -> dict[str, Any]:
        """Return everything as plain numbers and lists, for JSON."""
        values = {field.name: getattr(self, field.name) for field in fields(self)}
        plain = {
            key: value.tolist() if isinstance(value, np.ndarray) else value
            for key, value in values.items()
        }
        remedies = {defect.name: defect.remedy for defect in self.defects}
        return plain | {"is_clean": self.is_clean, "remedies": remedies}

    def _facts(self) -> list[str]:
        boundary = f"boundary of {len(self.boundary_edges)} edges that meet non-manifold ones"
        if self.is_closed:
            boundary = "closed"
        elif self.n_boundary_loops is not None:
            boundary = f"boundary of {_counted(self.n_boundary_loops, 'loop')}"
        genus = "genus undefined" if self.genus is None else f"genus {self.genus}"
        inside = "" if self.volume is None else f", volume {self.volume:.6g}"
        return [
            f"{_counted(self.n_vertices, 'vertex', 'vertices')}, "
            f"{_counted(self.n_edges, 'edge')}, {_counted(self.n_faces, 'face')}, "
            f"{_counted(self.n_components, 'component')}",
            f"{boundary}, {genus}, Euler characteristic {self.euler_characteristic}",
            f"{'manifold' if self.is_manifold else 'not manifold'}, "
            + ("oriented" if self.is_oriented else "not consistently oriented")
            + ("" if self.is_orientable else " (and not orientable)"),
            f"area {self.area:.6g}{inside}",
            "no defects"
            if self.is_clean
            else f"{_counted(len(self.defects), 'kind of defect', 'kinds of defects')}:",
        ]


_ONE_SIDED = "repair: none gives an outside to a component with one side."
_CURES = (
    (
        "non_finite_vertices",
        "vertices with NaN or infinite coordinates",
        "vertices",
        "repair: remove_non_finite drops them and their faces.",
    ),
    (
        "non_manifold_edges",
        "non-manifold edges (more than two faces)",
        "edges",
        "repair: split_non_manifold cuts the surface there; remove_duplicate_faces first.",
    ),
    (
        "non_manifold_vertices",
        "non-manifold vertices (more than one fan of faces)",
        "vertices",
        "repair: split_non_manifold gives each fan a copy of the vertex.",
    ),
    (
        "degenerate_faces",
        "degenerate faces (no area)",
        "faces",
        "repair: remove_degenerate_faces; merge_duplicate_vertices too where that opens holes.",
    ),
    (
        "duplicate_faces",
        "duplicate faces",
        "faces",
        "repair: remove_duplicate_faces keeps the first of each.",
    ),
    (
        "inconsistent_edges",
        "inconsistently oriented edges",
        "edges",
        "repair: orient turns faces until neighbours agree.",
    ),
    (
        "unreferenced_vertices",
        "unreferenced vertices (in no face)",
        "vertices",
        "repair: remove_unreferenced drops them.",
    ),
    (
        "duplicate_vertices",
        "duplicate vertices (same coordinates as an earlier one)",
        "vertices",
        "repair: merge_duplicate_vertices welds them, if they are cracks and not meant.",
    ),
)


def _counted(count: int, one: str, many: str | None = None) -> str:
    return f"{count} {one if count == 1 else many or one + 's'}"


def diagnose(mesh: Mesh) -> Diagnosis:
    """Name every defect of a mesh with its indices, and say what to do.

    Nothing is changed, and no defect is an error here. Cost: O(n log n + m).

    Chapter items: U4, P10.

    Examples
    --------
    >>> stray = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [5, 5, 5]], [[0, 1, 2]])
    >>> print(diagnose(stray).report())
    4 vertices, 3 edges, 1 face, 1 component
    boundary of 1 loop, genus 0, Euler characteristic 1
    manifold, oriented
    area 0.5
    1 kind of defect:
    - 1 unreferenced vertices (in no face): vertices 3. repair: remove_unreferenced drops them.
    """
    topology = require_mesh(mesh, "a diagnosis").topology
    finite: Booleans = np.asarray(np.isfinite(mesh.vertices).all(axis=1))
    whole = finite[mesh.faces].all(axis=1)
    areas = mesh.face_areas[whole]
    simple = topology.is_edge_manifold
    loops = len(topology.boundary_loops) if simple else None
    orientable = topology.is_orientable
    inside = topology.is_closed and simple and topology.is_oriented and whole.all()
    return Diagnosis(
        n_vertices=mesh.n_vertices,
        n_faces=mesh.n_faces,
        n_edges=topology.n_edges,
        n_components=topology.n_components,
        n_boundary_loops=loops,
        euler_characteristic=topology.euler_characteristic,
        genus=topology.genus if topology.is_manifold and orientable else None,
        is_closed=topology.is_closed,
        is_manifold=topology.is_manifold,
        is_oriented=topology.is_oriented,
        is_orientable=orientable,
        area=float(areas.sum()),
        volume=mesh.volume if inside and mesh.dimension <= 3 else None,
        non_finite_vertices=read_only(np.flatnonzero(~finite)),
        unreferenced_vertices=read_only(np.flatnonzero(~topology.referenced)),
        duplicate_vertices=read_only(duplicate_vertices(mesh.vertices)),
        non_manifold_vertices=topology.non_manifold_vertices,
        degenerate_faces=read_only(degenerate_faces(mesh.vertices, mesh.faces)),
        duplicate_faces=read_only(duplicate_faces(mesh.faces)),
        non_manifold_edges=topology.non_manifold_edges,
        inconsistent_edges=topology.inconsistent_edges,
        boundary_edges=topology.boundary_edges,
    )
