"""LearningOperators: what networks on surfaces are given of a mesh, as arrays."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from scipy.sparse import csr_array

from beltrami._arrays import Floats, read_only, read_only_matrix
from beltrami.errors import check_name
from beltrami.learning.tensors import Tensors, as_tensors


@dataclass(frozen=True, eq=False, repr=False)
class LearningOperators:
    r"""The operators of a mesh for a network; ``learning_operators`` makes them.

    Attributes
    ----------
    frames : (n, 3, 3) rows X, Y and normal of each vertex
    masses : (n,) diagonal of B
    stiffness : (n, n) csr_array L, positive semi-definite
    eigenvalues : (k,) ascending, of :math:`L\varphi = \lambda B\varphi`
    eigenvectors : (n, k), B-orthonormal
    gradient_x, gradient_y : (n, n) csr_array, the gradient at the vertices in their frames
    face_gradient : (d m, n) csr_array, the gradient in the faces, stacked by coordinate
    """

    frames: Floats
    masses: Floats
    stiffness: csr_array
    eigenvalues: Floats
    eigenvectors: Floats
    gradient_x: csr_array
    gradient_y: csr_array
    face_gradient: csr_array

    def __post_init__(self) -> None:
        for array in (self.frames, self.masses, self.eigenvalues, self.eigenvectors):
            read_only(array)
        for matrix in (self.stiffness, self.gradient_x, self.gradient_y, self.face_gradient):
            read_only_matrix(matrix)

    def __repr__(self) -> str:
        return f"<LearningOperators: {self.n} vertices, {self.k} eigenpairs>"

    @property
    def n(self) -> int:
        """Number of vertices n."""
        return len(self.masses)

    @property
    def k(self) -> int:
        """Number of eigenpairs k."""
        return len(self.eigenvalues)

    @cached_property
    def gradient(self) -> csr_array:
        """(n, n) complex csr_array, X + i Y: a turned frame is a factor of length 1 in a row."""
        real, imaginary = self.gradient_x, self.gradient_y
        data = real.data + 1j * imaginary.data
        indices, starts = real.indices.copy(), real.indptr.copy()
        return read_only_matrix(csr_array((data, indices, starts), shape=real.shape))

    def to(self, target: str, *, device: Any = "cpu", dtype: Any = "float32") -> Tensors:
        """Return the same as tensors of ``"torch"``; sparse ones are coalesced COO.

        Parameters
        ----------
        target
            ``"torch"``.
        device
            As torch calls it: ``"cpu"``, ``"cuda:0"``, ``torch.device(...)``.
        dtype
            ``"float32"`` or ``"float64"``, or ``torch.float32`` or ``torch.float64``.

        Raises
        ------
        UnknownNameError
            If the target or the dtype is another.
        MissingExtraError
            If torch is not installed.
        MeshError
            If the unit of length is such that numbers do not fit into float32.

        Notes
        -----
        ``network(features, **operators.to("torch").arguments)`` is a call of DiffusionNet.
        """
        check_name("target", target, ("torch",))
        return as_tensors(vars(self), device, str(dtype).removeprefix("torch."))
