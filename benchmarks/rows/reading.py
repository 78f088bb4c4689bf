"""Read OBJ, OFF and binary PLY into two arrays; the file is in the memory of the system."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.cases import Case
from benchmarks.claims import Contender, Goal, Row
from benchmarks.packages import package

Arrays = tuple[NDArray[Any], NDArray[Any]]
VTK_TRIANGLE = 5
SINGLE = 1e-6  # some peers keep positions in single precision; a wrong digit is larger


def difference(a: Arrays, b: Arrays) -> float:
    """Largest distance of a coordinate, over the largest one; infinite if the faces differ."""
    if a[0].shape != b[0].shape or not np.array_equal(a[1], b[1]):
        return float("inf")
    return float(abs(a[0] - b[0]).max() / abs(a[0]).max())


def text_of(values: NDArray[Any], line: str) -> str:
    """Write one line for each row of an array."""
    return (line * len(values)) % tuple(values.ravel().tolist())


def write_obj(path: Path, V: NDArray[np.float64], F: NDArray[np.int64]) -> None:
    path.write_text(text_of(V, "v %.7g %.7g %.7g\n") + text_of(F + 1, "f %d %d %d\n"))


def write_off(path: Path, V: NDArray[np.float64], F: NDArray[np.int64]) -> None:
    head = f"OFF\n{len(V)} {len(F)} 0\n"
    path.write_text(head + text_of(V, "%.7g %.7g %.7g\n") + text_of(F, "3 %d %d %d\n"))


def write_ply(path: Path, V: NDArray[np.float64], F: NDArray[np.int64]) -> None:
    """Write little-endian floats and 32-bit indices: the common kind."""
    head = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(V)}\n"
        "property float x\nproperty float y\nproperty float z\n"
        f"element face {len(F)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    sides = np.empty(len(F), dtype=[("count", "u1"), ("face", "<i4", 3)])
    sides["count"] = 3
    sides["face"] = F
    path.write_bytes(head.encode() + V.astype("<f4").tobytes() + sides.tobytes())


WRITERS = {"obj": write_obj, "off": write_off, "ply": write_ply}


def ours(path: str) -> Arrays:
    mesh = package("beltrami").read_mesh(path)
    return mesh.vertices, mesh.faces


def pyvista(path: str) -> Arrays:
    mesh = package("pyvista").read(path)
    if hasattr(mesh, "regular_faces"):
        return mesh.points, mesh.regular_faces
    return mesh.points, mesh.cells_dict[VTK_TRIANGLE]  # what it reads through meshio


def meshio(path: str) -> Arrays:
    mesh = package("meshio").read(path)
    return mesh.points, mesh.cells_dict["triangle"]


def trimesh(path: str) -> Arrays:
    mesh = package("trimesh").load(path, process=False)
    return mesh.vertices, mesh.faces


def trimesh_loader(path: str) -> Arrays:
    """Call the loader of PLY beneath ``load``, which hashes and copies much besides."""
    with Path(path).open("rb") as file:
        read = package("trimesh.exchange.ply").load_ply(file)
    mesh = package("trimesh").Trimesh(read["vertices"], read["faces"], process=False)
    return mesh.vertices, mesh.faces


def igl(path: str) -> Arrays:
    vertices, faces = package("igl").read_triangle_mesh(path)
    return vertices, faces


def potpourri3d(path: str) -> Arrays:
    vertices, faces = package("potpourri3d").read_mesh(path)
    return vertices, faces


def pymeshlab(path: str) -> Arrays:
    meshes = package("pymeshlab").MeshSet()
    meshes.load_new_mesh(path)
    mesh = meshes.current_mesh()
    return mesh.vertex_matrix(), mesh.face_matrix()


READERS = {
    "PyVista": pyvista,
    "meshio": meshio,
    "trimesh": trimesh,
    "libigl": igl,
    "potpourri3d": potpourri3d,
    "PyMeshLab": pymeshlab,
}


def reader(read: Callable[[str], Arrays], path: str) -> Callable[[Any], Arrays]:
    """Bind one library's function to the file."""
    return lambda _: read(path)


def contenders(suffix: str, case: Case) -> Sequence[Contender]:
    file = case.folder / f"{case.name.replace(' ', '_')}.{suffix}"
    if not file.exists():
        WRITERS[suffix](file, case.vertices, case.faces)
    path = str(file)
    readers = READERS | ({"trimesh, its loader alone": trimesh_loader} if suffix == "ply" else {})
    peers = [
        Contender(name, reader(read, path), tolerance=SINGLE) for name, read in readers.items()
    ]
    return [Contender("beltrami", lambda _: ours(path), ours=True), *peers]


def row(suffix: str, limit: float, work: str) -> Row:
    """Return the row of one format."""
    return Row(
        name=f"read-{suffix}",
        work=work,
        contenders=partial(contenders, suffix),
        goals=(Goal(limit),),
        difference=difference,
        size=537_000,
        alone=True,
    )


READ_OBJ = row("obj", 0.25, "read an OBJ file")
READ_OFF = row("off", 0.25, "read an OFF file")
READ_PLY = row("ply", 1.0, "read a binary PLY file")
