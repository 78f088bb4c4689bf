"""The file of a basis: its arrays, and whether they belong together."""

from __future__ import annotations

import json
import os
from dataclasses import asdict
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from beltrami._arrays import Floats
from beltrami.errors import FileFormatError
from beltrami.io.matrices import finite_floats, matrix_arrays, matrix_from
from beltrami.io.npz import read_arrays, write_arrays
from beltrami.solvers.computation import Computation

KIND: Final = "Fourier basis"
VERSION: Final = 1


def write_basis(
    path: str | os.PathLike[str],
    eigenvalues: Floats,
    eigenvectors: Floats,
    mass: csr_array,
    residuals: Floats,
    computation: Computation,
) -> None:
    """Write the arrays of a basis, as a whole or not at all."""
    arrays = {
        "eigenvalues": eigenvalues,
        "eigenvectors": eigenvectors,
        "residuals": residuals,
        **matrix_arrays("mass", mass),
        "computation": np.array(json.dumps(asdict(computation))),
    }
    write_arrays(path, KIND, VERSION, arrays)


def read_basis(
    path: str | os.PathLike[str],
) -> tuple[Floats, Floats, csr_array, Floats, Computation]:
    """Return the fields of a basis, in their order; the arrays are read-only.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    FileFormatError
        If it is not a whole and unchanged file of a basis.
    """
    arrays = read_arrays(path, KIND, VERSION)
    try:
        values, vectors, residuals = (
            finite_floats(arrays[name]) for name in ("eigenvalues", "eigenvectors", "residuals")
        )
        if vectors.ndim != 2 or not (values.shape == residuals.shape == vectors.shape[1:]):
            raise ValueError(f"shapes {values.shape}, {vectors.shape} and {residuals.shape}")
        if (np.diff(values) < 0).any():
            raise ValueError("eigenvalues that do not ascend")
        mass = matrix_from(arrays, "mass", (len(vectors), len(vectors)))
        return values, vectors, mass, residuals, _computation(arrays["computation"])
    except (LookupError, TypeError, ValueError, OverflowError, RecursionError) as cause:
        raise FileFormatError(Path(path), f"expected the arrays of a basis ({cause})") from cause


def _computation(array: NDArray[Any]) -> Computation:
    """Return how the basis was found; an error if a field is missing or of another type."""
    given = json.loads(str(array[()]))
    return Computation(
        method=str(given["method"]),
        precision=str(given["precision"]),
        shift=float(given["shift"]),
        basis=int(given["basis"]),
        solves=int(given["solves"]),
        history=tuple(float(size) for size in given["history"]),
        counted_within=float(given["counted_within"]),
        seconds=tuple((str(stage), float(time)) for stage, time in given["seconds"]),
    )
