"""Shapes made by formula: meshes whose size, area and spectrum are known, and one creature."""

from beltrami.mesh.shapes.blob import blob as blob
from beltrami.mesh.shapes.cylinder import cylinder as cylinder
from beltrami.mesh.shapes.disk import disk as disk
from beltrami.mesh.shapes.icosphere import icosphere as icosphere
from beltrami.mesh.shapes.polyhedra import cube as cube
from beltrami.mesh.shapes.polyhedra import octahedron as octahedron
from beltrami.mesh.shapes.polyhedra import tetrahedron as tetrahedron
from beltrami.mesh.shapes.rectangle import grid as grid
from beltrami.mesh.shapes.torus import torus as torus

__all__ = [
    "blob",
    "cube",
    "cylinder",
    "disk",
    "grid",
    "icosphere",
    "octahedron",
    "tetrahedron",
    "torus",
]
