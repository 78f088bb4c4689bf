"""Functions on the vertices, in and out of files."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from beltrami._arrays import Floats
    from beltrami.mesh.mesh import Mesh


def read_data(path: Path, mesh: Mesh, name: str | None = None, missing: bool = False) -> Floats:
    """Read a function from a file, by its name if the file has several; check it."""
    import numpy as np

    from beltrami._arrays import as_function
    from beltrami.io.function import read_function

    f = read_function(path, name, missing=missing)
    as_function(np.where(np.isnan(f), 0, f), mesh.n_vertices, f"the function of {path}")
    return f


def write_values(path: Path, mesh: Mesh, name: str, values: Floats) -> None:
    """Write values to a file, or the mesh with the values as a named function to .ply.

    The suffix was checked before the work, by ``check_values_output``.
    """
    from beltrami.io.function_write import write_function
    from beltrami.io.registry import write_mesh

    if path.suffix.lower() == ".ply":
        write_mesh(path, mesh.with_data(**{name: values}))
    else:
        write_function(path, values)
