"""The bi-Laplacian flow ∂F/∂t = -(B⁻¹ L)² F: thin plates instead of membranes."""

from __future__ import annotations

from scipy.sparse import csr_array

from beltrami._arrays import Booleans, Floats
from beltrami._progress import Progress, stages
from beltrami.errors import MeshError
from beltrami.operators.areas import diagonal_matrix
from beltrami.operators.pair import Laplacian
from beltrami.solvers.factorize import factorize


def bilaplacian_flow(
    laplacian: Laplacian,
    f: Floats,
    time: float,
    steps: int,
    held: Booleans,
    progress: Progress | None = None,
) -> Floats:
    r"""Solve :math:`(B + \delta L B^{-1} L) F_{k+1} = B F_k` in ``steps`` steps of δ = time/steps.

    Frequency λ is multiplied by :math:`1/(1 + \delta\lambda^2)` at each step: what is slow stays
    better, and what is fast goes sooner, than by heat. One factorisation serves all steps and
    columns. With area masses the time has the unit length⁴.

    Raises
    ------
    MeshError
        If the mass is not diagonal.
    SingularMatrixError
        If the time is so long that nothing of the mass is left beside the rest.

    Examples
    --------
    >>> import numpy as np
    >>> from beltrami.mesh.shapes import icosphere
    >>> from beltrami.operators.laplacian import laplacian
    >>> mesh = icosphere(3)
    >>> z = mesh.vertices[:, 2]
    >>> free = np.zeros(mesh.n_vertices, bool)
    >>> flown = bilaplacian_flow(laplacian(mesh), z, 0.5, 1, free)
    >>> round(float(flown @ z / (z @ z)), 2)  # 1 / (1 + 0.5 * 2²)
    0.33
    """
    if laplacian.mass_kind == "consistent":
        raise MeshError(
            "the bi-Laplacian needs a diagonal mass, and the consistent mass is not",
            remedy='Use mass="voronoi".',
        )
    L, delta = laplacian.stiffness, time / steps
    matrix = csr_array(laplacian.mass + delta * (L @ diagonal_matrix(1 / laplacian.masses) @ L))
    free = ~held
    inner = matrix if free.all() else csr_array(matrix[free][:, free])
    outer = matrix[free][:, held] @ f[held]
    positions = getattr(laplacian.domain, "vertices", None)
    factor = factorize(inner, None if positions is None else positions[free])
    masses = laplacian.masses[free][(...,) + (None,) * (f.ndim - 1)]
    result = f.copy()
    for _ in stages(steps, progress):
        result[free] = factor.solve(masses * result[free] - outer)
    return result
