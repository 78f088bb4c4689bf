"""segment_into_disks: part any surface into cells that are disks (l. 657 of the chapter)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from beltrami._arrays import Floats, Integers, read_only, whole
from beltrami.errors import check_name
from beltrami.geodesics.edge_paths import edge_distance
from beltrami.geodesics.heat_method import HeatMethod
from beltrami.mesh.cut import cut_along
from beltrami.mesh.door import require_mesh
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.requirements import require_oriented
from beltrami.operators.laplacian import laplacian
from beltrami.operators.soundness import refuse_unreferenced, require_sound
from beltrami.parameterization.cells import (
    Neighbours,
    hanging_together,
    into_disks,
    largest_of_each,
    merged,
    smoothed,
)
from beltrami.spectrum.fourier_basis import fourier_basis
from beltrami.spectrum.k_means import in_order_of_appearance
from beltrami.spectrum.segment import segment

CELL_METHODS = ("farthest", "spectral")
_WARM = 600.0  # square roots of the time within which heat arrives


@dataclass(frozen=True, eq=False, repr=False)
class DiskCells:
    """A surface parted into disks.

    Attributes
    ----------
    labels : (m,) int
        The cell of each face, 0 to count - 1 in the order of the first face of each.
    areas : (count,) float
        The area of each cell.
    halved : int
        How often a cell was cut in two because it was no disk.
    """

    labels: Integers
    areas: Floats
    halved: int

    def __post_init__(self) -> None:
        read_only(self.labels)
        read_only(self.areas)

    def __repr__(self) -> str:
        return f"<DiskCells: {len(self.labels)} faces in {self.count} disks>"

    @property
    def count(self) -> int:
        """Number of cells."""
        return len(self.areas)


def segment_into_disks(mesh: Mesh, count: int = 8, *, method: str = "farthest") -> DiskCells:
    """Part a surface into cells, each of which is a disk: connected, one boundary, no handle.

    The chapter asks for it where a surface is no disk (l. 657). ``cut_to_disk`` makes one disk of
    a component instead, with a longer seam for its area; charts with little distortion need
    cells. What a cell has of pieces that do not hang together by edges goes to neighbours; a cell
    that is then no disk is cut in two, and again if need be: a single face is a disk.

    Chapter items: P69.

    Parameters
    ----------
    mesh
        Any oriented surface: open or closed, of any genus, of several components, and with edges
        and vertices that are not manifold, along which cells end.
    count
        How many cells to begin with. There are more where components or handles ask for it.
    method
        ``"farthest"``: each cell has the faces that are nearest to its seed in geodesic distance,
        by heat, and each seed is the vertex farthest from those before (Eldar et al. 1997;
        Peyré and Cohen 2006). ``"spectral"``: the clusters of ``segment``, which part a shape
        at its necks.

    Raises
    ------
    EmptyMeshError, NonFiniteError, DegenerateFaceError, UnreferencedVertexError
        If the mesh is not sound.
    NotOrientableError
        If neighbouring faces disagree on the outside.
    MeshError
        If the count is not between 1 and the number of faces.
    UnknownNameError
        If there is no such method.

    Notes
    -----
    Cost: two solves for each seed; for the spectral method that of ``count`` eigenpairs.

    Examples
    --------
    >>> from beltrami.mesh.shapes import torus
    >>> ring = torus(24, 16)
    >>> cells = segment_into_disks(ring, 6)
    >>> patch = Mesh(ring.vertices, ring.faces[cells.labels == 0])
    >>> cells.count >= 6, patch.euler_characteristic, len(patch.boundary_loops)
    (True, 1, 1)
    """
    check_name("method of segmentation", method, CELL_METHODS)
    require_sound(require_mesh(mesh, "a segmentation"))
    if not mesh.topology.referenced.all():
        refuse_unreferenced(mesh.topology)
    require_oriented(
        mesh.topology,
        "neighbouring faces disagree on which side is outside",
        "The surface has one side only: its cells would have none in common.",
    )
    whole("the number of cells", count, least=1, most=mesh.n_faces)
    apart = cut_along(mesh, np.zeros(mesh.topology.n_edges, np.bool_)).mesh
    near = Neighbours.of(apart)
    seeded = _by_seeds if method == "farthest" else _by_eigenvectors
    labels = seeded(apart, count) if count > 1 else np.zeros(mesh.n_faces, np.int64)
    labels = smoothed(hanging_together(labels, near), apart)
    labels, halved = into_disks(in_order_of_appearance(labels), apart.topology, near)
    labels = in_order_of_appearance(merged(labels, apart, near, count))
    areas = np.bincount(labels, mesh.face_areas).astype(np.float64)
    return DiskCells(labels, areas, halved)


def _by_seeds(mesh: Mesh, count: int) -> Integers:
    """Give each face to the nearest of seeds that are as far from each other as can be.

    Each component has one to begin with, far out.
    """
    labels = mesh.components().copy()
    components, start = np.unique(labels, return_index=True)
    of_vertex = np.empty(mesh.n_vertices, np.int64)
    of_vertex[mesh.faces.ravel()] = np.repeat(labels, 3)
    seeds = largest_of_each(of_vertex, edge_distance(mesh, mesh.faces[start, 0]))
    method = HeatMethod(mesh, time=_time(mesh))
    nearest = method.distance(seeds)
    nearest[seeds] = 0
    best = nearest[mesh.faces].sum(axis=1)
    for cell in range(len(components), count):
        seed = int(nearest.argmax())
        if nearest[seed] <= 0:
            break
        distance = method.distance(seed)
        of_faces = distance[mesh.faces].sum(axis=1)
        labels[of_faces < best] = cell
        best = np.minimum(best, of_faces)
        nearest = np.minimum(nearest, distance)
        nearest[seed] = 0
    return labels


def _time(mesh: Mesh) -> float:
    """Return the time for the heat: the usual one, or longer lest some faces stay cold."""
    labels = mesh.components()
    _, first = np.unique(labels, return_index=True)
    radius = float(edge_distance(mesh, mesh.faces[first, 0]).max())
    return max(float(mesh.edge_lengths.mean()), 2 * radius / _WARM) ** 2


def _by_eigenvectors(mesh: Mesh, count: int) -> Integers:
    """Give each face to the cluster that most of its corners are in."""
    components = int(mesh.components().max()) + 1
    basis = fourier_basis(laplacian(mesh), min(mesh.n_vertices, count + components))
    labels = segment(basis, min(count, mesh.n_vertices)).labels[mesh.faces]
    a, b, c = labels.T
    return np.where(b == c, b, a)
