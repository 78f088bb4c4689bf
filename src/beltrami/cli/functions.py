"""Functions on the vertices, in and out of files."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from beltrami._arrays import Floats
    from beltrami.mesh.mesh import Mesh


def read_data(
    path: Path, mesh: Mesh, name: str | None = None, option: str = "--data-name"
) -> Floats:
    """Read a function from a file, by its name if the file has several; check it.

    ``option`` is the one that gives the name, "" if there is none.
    """
    from beltrami._arrays import as_function
    from beltrami.io.function import read_function

    with _a_name_is_asked_for(path, option):
        values = read_function(path, name)
    return as_function(values, mesh.n_vertices, f"the function of {path}")


@contextmanager
def _a_name_is_asked_for(path: Path, option: str) -> Iterator[None]:
    """Say by which option one of several functions is chosen."""
    from beltrami.errors import BeltramiError, UnknownNameError

    try:
        yield
    except UnknownNameError as error:
        if error.name is not None:
            raise
        names = ", ".join(map(repr, error.choices))
        wanted = f"choose one with {option}" if option else "a file with one is needed"
        raise BeltramiError(f"{path} has several functions ({names}): {wanted}") from error


def read_drawn(path: Path, mesh: Mesh, name: str | None = None, missing: bool = False) -> Floats:
    """Read numbers or colours to be drawn, (n,) or (n, 3), as ``render`` asks for them.

    Colours may be bytes, as in most files; of four columns the last one, opacity, is left out.
    """
    import numpy as np

    from beltrami._arrays import as_function
    from beltrami.display.values import as_values
    from beltrami.io.function import read_values

    with _a_name_is_asked_for(path, "--data-name"):
        held = read_values(path, name, missing=missing)
    shown = held[:, :3] if held.ndim == 2 and held.shape[1] == 4 else held
    kept = np.uint8 if held.dtype == np.uint8 else np.float64
    as_function(np.where(np.isnan(held), 0, held), mesh.n_vertices, f"the function of {path}")
    values = as_values(mesh, shown.astype(kept), missing)
    return values[:, 0] if values.shape[1] == 1 else values


def write_values(path: Path, mesh: Mesh, name: str, values: Floats) -> None:
    """Write values to a file, or the mesh with the values as a named function to .ply.

    The suffix was checked before the work, by ``check_values_output``.
    """
    from beltrami.io.function_write import write_results
    from beltrami.io.registry import write_mesh

    if path.suffix.lower() == ".ply":
        write_mesh(path, mesh.with_data(**{name: values}))
    else:
        write_results(path, values)
