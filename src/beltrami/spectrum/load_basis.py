"""load_basis: a basis from a file, checked against the pair that it is used with."""

from __future__ import annotations

import os

import numpy as np

from beltrami._kinds import checked
from beltrami.errors import DimensionError, MeshError
from beltrami.operators.domain import require_laplacian
from beltrami.operators.pair import Laplacian
from beltrami.spectrum.basis import FourierBasis
from beltrami.spectrum.basis_file import read_basis

_MASS = 1e-9  # relative difference of masses that another machine may make
_ROUNDING = 1e-11  # of L f, beside |L| |f|
_SEED = 577_215_664


@checked
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
    basis = FourierBasis(*read_basis(path))
    if laplacian is not None:
        _require_same(basis, require_laplacian(laplacian, "load_basis"))
    return basis


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
    zero = basis.eigenvalues == 0  # whose residuals are beside |L||φ|
    part = np.abs(basis.eigenvectors[:, zero])
    forces[zero] = np.linalg.norm(abs(laplacian.stiffness) @ part, axis=0)
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
