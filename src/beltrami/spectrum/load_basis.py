"""load_basis: a basis from a file, checked against the pair that it is used with."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from beltrami._arrays import Floats
from beltrami.errors import DimensionError, FileFormatError, MeshError
from beltrami.io.npz import read_arrays
from beltrami.operators.pair import Laplacian
from beltrami.spectrum.basis import FILE_KIND, FILE_VERSION, FourierBasis

_MASS = 1e-9  # relative difference of masses that another machine may make
_ROUNDING = 1e-11  # of L f, beside |L| |f|
_SEED = 577_215_664


def load_basis(path: str | os.PathLike[str], laplacian: Laplacian | None = None) -> FourierBasis:
    r"""Read a basis that ``FourierBasis.save`` wrote.

    Parameters
    ----------
    path
        The file.
    laplacian
        The pair that the basis is to be used with. It is then proven that the basis is one of
        this pair: the masses are those of the file, and :math:`L\Phi c = B\Phi\Lambda c`, for
        random c, as exactly as when the basis was made. (Bits are not compared, since another
        machine may round differently.) Rows of vertices that were held are left out.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    FileFormatError
        If it is not a whole and unchanged file of a basis. Nothing in it is executed.
    DimensionError
        If the pair has another number of vertices.
    MeshError
        If the basis belongs to another pair; ``error.vertices`` are those with other masses.

    Notes
    -----
    Cost: the file is read once, and each array is checked in one pass; the proof takes n k
    operations.

    Examples
    --------
    >>> import tempfile, pathlib
    >>> from beltrami.mesh.shapes import icosphere
    >>> from beltrami.operators.laplacian import laplacian
    >>> from beltrami.spectrum.fourier_basis import fourier_basis
    >>> pair = laplacian(icosphere(2))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     place = pathlib.Path(folder) / "sphere.npz"
    ...     fourier_basis(pair, 9).save(place)
    ...     load_basis(place, pair)
    <FourierBasis: 9 of 162 eigenpairs>
    """
    place = Path(path)
    arrays = read_arrays(place, FILE_KIND, FILE_VERSION)
    try:
        basis = _basis(arrays)
    except (KeyError, ValueError) as cause:
        raise FileFormatError(place, f"expected the arrays of a basis ({cause})") from cause
    if laplacian is not None:
        _require_same(basis, laplacian)
    return basis


def _basis(arrays: dict[str, NDArray[Any]]) -> FourierBasis:
    """Make the basis; KeyError or ValueError if its arrays do not belong together."""
    values, vectors, residuals, data = (
        _floats(arrays[name]) for name in ("eigenvalues", "eigenvectors", "residuals", "mass")
    )
    if vectors.ndim != 2 or not (values.shape == residuals.shape == vectors.shape[1:]):
        raise ValueError(f"shapes {values.shape}, {vectors.shape} and {residuals.shape}")
    if (np.diff(values) < 0).any():
        raise ValueError("eigenvalues that do not ascend")
    n = len(vectors)
    starts, columns = arrays["mass_starts"], arrays["mass_columns"]
    if data.ndim != 1 or columns.shape != data.shape or starts.shape != (n + 1,):
        raise ValueError("the mass has other shapes")
    if starts.dtype.kind != "i" or columns.dtype.kind != "i":
        raise ValueError("the indices of the mass are no integers")
    steps = np.diff(starts)
    if starts[0] != 0 or starts[-1] != len(data) or (steps < 0).any():
        raise ValueError("the rows of the mass are out of order")
    inside = (columns >= 0) & (columns < n)
    follows = np.diff(columns, prepend=-1) > 0
    follows[starts[:-1][steps > 0]] = True  # the first of each row
    if not (inside & follows).all():
        raise ValueError("the columns of the mass are out of order")
    return FourierBasis(values, vectors, csr_array((data, columns, starts), (n, n)), residuals)


def _floats(array: NDArray[Any]) -> Floats:
    if array.dtype != np.float64:
        raise ValueError(f"numbers of the type {array.dtype}")
    if not np.isfinite(array).all():
        raise ValueError("numbers that are NaN or infinite")
    return array


def _require_same(basis: FourierBasis, laplacian: Laplacian) -> None:
    """Raise if the basis does not belong to the pair: other masses, or other eigenvectors."""
    if basis.n != laplacian.n:
        raise DimensionError(
            f"the basis in the file has {basis.n} vertices, and the pair has {laplacian.n}",
            remedy="Make the basis again, or load the mesh that it was made of.",
        )
    difference = abs(basis.mass - laplacian.mass).max(axis=1).toarray().ravel()
    other = np.flatnonzero(difference > _MASS * laplacian.masses)
    if len(other):
        raise MeshError(
            "the basis in the file was made of a pair with other masses",
            vertices=other,
            remedy="Take the same mesh and the same mass, or make the basis again.",
        )
    c = np.random.default_rng(_SEED).standard_normal(basis.k)
    forces = basis.eigenvalues * np.linalg.norm(basis.mass @ basis.eigenvectors, axis=0)
    allowed = 2 * np.abs(c) @ (basis.residuals * np.abs(forces))
    f = basis.eigenvectors @ c
    rest = laplacian.stiffness @ f - basis.mass @ (basis.eigenvectors @ (basis.eigenvalues * c))
    rounding = _ROUNDING * np.linalg.norm(abs(laplacian.stiffness) @ np.abs(f))
    free = basis.eigenvectors.any(axis=1)
    if np.linalg.norm(rest[free]) > allowed + rounding:
        raise MeshError(
            "the basis in the file was made of another pair: its vectors are no eigenvectors of "
            "this stiffness",
            remedy="Take the same mesh and the same weights, or make the basis again.",
        )
