"""Operators kept on disk: the name of the file is the digest of all that they depend on."""

from __future__ import annotations

import hashlib
import os
import warnings
from pathlib import Path
from typing import Any, Final

import numpy as np

from beltrami.errors import FileFormatError
from beltrami.io.matrices import finite_floats, matrix_arrays, matrix_from
from beltrami.io.npz import read_arrays, write_arrays
from beltrami.learning.operators import LearningOperators
from beltrami.mesh.mesh import Mesh

KIND: Final = "set of learning operators"
VERSION: Final = 1  # of the file, and of how the operators are made: part of the digest
_ARRAYS = ("frames", "masses", "eigenvalues", "eigenvectors")
_MATRICES = ("stiffness", "gradient_x", "gradient_y", "face_gradient")


def entry(folder: str | os.PathLike[str], mesh: Mesh, k: int, weights: str, mass: str) -> Path:
    """Return the file of these operators: SHA-256 of positions, faces and parameters."""
    x, f = mesh.vertices, mesh.faces
    sha = hashlib.sha256(f"{KIND} {VERSION}; {x.shape} {f.shape} {k} {weights} {mass};".encode())
    sha.update(np.ascontiguousarray(x, "<f8").data)
    sha.update(np.ascontiguousarray(f, "<i8").data)
    return Path(folder) / f"{sha.hexdigest()}.npz"


def kept(place: Path, mesh: Mesh, k: int) -> LearningOperators | None:
    """Return the operators of a file, or None without one; a damaged one is told by a warning."""
    try:
        arrays = read_arrays(place, KIND, VERSION)
        n, rows = mesh.n_vertices, mesh.n_faces * mesh.dimension
        shapes = {"frames": (n, 3, 3), "masses": (n,), "eigenvalues": (k,), "eigenvectors": (n, k)}
        try:
            for name, shape in shapes.items():
                if finite_floats(arrays[name]).shape != shape:
                    raise ValueError(f"the {name} have another shape")
            sides = {name: rows if name == "face_gradient" else n for name in _MATRICES}
            found: dict[str, Any] = {name: arrays[name] for name in shapes}
            found |= {name: matrix_from(arrays, name, (p, n)) for name, p in sides.items()}
        except (LookupError, ValueError) as cause:
            raise FileFormatError(place, f"expected the arrays of a {KIND} ({cause})") from cause
    except FileNotFoundError:
        return None
    except FileFormatError as error:
        warnings.warn(f"{error}. It is made anew.", RuntimeWarning, stacklevel=3)
        return None
    return LearningOperators(**found)


def keep(place: Path, operators: LearningOperators) -> None:
    """Write the operators, as a whole or not at all; OSError if the folder cannot be written."""
    place.parent.mkdir(parents=True, exist_ok=True)
    arrays = {name: getattr(operators, name) for name in _ARRAYS}
    for name in _MATRICES:
        arrays |= matrix_arrays(name, getattr(operators, name))
    write_arrays(place, KIND, VERSION, arrays)
