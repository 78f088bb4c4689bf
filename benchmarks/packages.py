"""The libraries measured, ours included: found by name, so that a missing one can be told."""

from __future__ import annotations

import importlib
import importlib.metadata
from typing import Any

DISTRIBUTIONS = (
    "beltrami",
    "DracoPy",
    "cholespy",
    "gpytoolbox",
    "lapy",
    "libigl",
    "meshio",
    "meshoptimizer",
    "potpourri3d",
    "pyamg",
    "pygsp",
    "pymeshlab",
    "pyvista",
    "robust_laplacian",
    "scikit-sparse",
    "trimesh",
    "vtk",
    "xatlas",
    "zstandard",
    "numpy",
    "scipy",
    "numba",
)


def package(name: str) -> Any:
    """Import a package when a contender needs it; an ImportError is reported, not hidden."""
    return importlib.import_module(name)


def versions() -> list[tuple[str, str]]:
    """List what is installed, and say of each one that is not that it is not."""
    found = []
    for name in DISTRIBUTIONS:
        try:
            found.append((name, importlib.metadata.version(name)))
        except importlib.metadata.PackageNotFoundError:
            found.append((name, "not installed"))
    return found
