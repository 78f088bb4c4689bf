"""The operators as tensors of torch."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
from scipy.sparse import csr_array

from beltrami._arrays import Floats
from beltrami._optional import require
from beltrami.errors import MeshError, check_name

_DTYPES = ("float32", "float64")


@dataclass(frozen=True, eq=False, repr=False)
class Tensors:
    """The fields of ``LearningOperators`` as tensors; matrices are sparse (COO, coalesced)."""

    frames: Any
    masses: Any
    stiffness: Any
    eigenvalues: Any
    eigenvectors: Any
    gradient_x: Any
    gradient_y: Any
    face_gradient: Any

    def __repr__(self) -> str:
        n, k = self.eigenvectors.shape
        return f"<Tensors: {n} vertices, {k} eigenpairs, {self.masses.dtype}, {self.masses.device}>"

    def to(self, device: Any) -> Tensors:
        """Return the same on another device: loaded where the files are, used on the card."""
        return Tensors(*(getattr(self, field.name).to(device) for field in fields(Tensors)))

    @property
    def arguments(self) -> dict[str, Any]:
        """What the ``forward`` of DiffusionNet takes, by its names."""
        return {
            "mass": self.masses,
            "L": self.stiffness,
            "evals": self.eigenvalues,
            "evecs": self.eigenvectors,
            "gradX": self.gradient_x,
            "gradY": self.gradient_y,
        }


def as_tensors(arrays: Mapping[str, Any], device: Any, dtype: str) -> Tensors:
    """Return the tensors of arrays and of sparse matrices, which they share no memory with.

    Raises
    ------
    UnknownNameError, MissingExtraError, MeshError
        As ``LearningOperators.to`` says.
    """
    check_name("dtype", dtype, _DTYPES)
    torch = require("torch", "learning", "tensors")

    def tensor(name: str) -> Any:
        value = arrays[name]
        if not isinstance(value, csr_array):
            return torch.from_numpy(_rounded(value, name, dtype)).to(device)
        matrix = value.tocoo()
        places = torch.from_numpy(np.stack(matrix.coords).astype(np.int64))
        numbers = torch.from_numpy(_rounded(matrix.data, name, dtype))
        with torch.sparse.check_sparse_tensor_invariants():  # torch 2.11 warns of the argument
            made = torch.sparse_coo_tensor(places, numbers, matrix.shape, is_coalesced=True)
        return made.to(device)

    return Tensors(*(tensor(field.name) for field in fields(Tensors)))


def _rounded(values: Floats, name: str, dtype: str) -> Any:
    """Return a copy in this precision; MeshError if it overflows, or a mass vanishes."""
    with np.errstate(over="ignore", under="ignore"):
        result = values.astype(dtype)
    if not np.isfinite(result).all() or (name == "masses" and not result.all()):
        raise MeshError(
            f"{name} of this unit of length do not fit into {dtype}",
            remedy='Scale the mesh to an area near 1, or take dtype="float64".',
        )
    return result
