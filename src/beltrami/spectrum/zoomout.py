"""zoomout: refine a functional map by adding one frequency at a time (Melzi et al. 2019)."""

from __future__ import annotations

from beltrami._progress import Progress, stages
from beltrami.errors import BeltramiError
from beltrami.spectrum.correspondence import (
    FunctionalMap,
    size_of,
    unit_vectors,
    with_point_map,
)
from beltrami.spectrum.point_maps import map_of_points, nearest_points
from beltrami.spectrum.signature import as_count, total_mass


def zoomout(
    start: FunctionalMap,
    k: int | None = None,
    *,
    step: int = 1,
    progress: Progress | None = None,
) -> FunctionalMap:
    r"""Refine a small functional map to one of k eigenpairs, by going to points and back.

    Repeats: turn C into the nearest map T of points, and T into the C of ``step`` more eigenpairs,
    :math:`C = \Psi^T B \Phi[T]`. What the start tells of the low frequencies is enough to find the
    higher ones, if the surfaces are nearly isometric.

    Parameters
    ----------
    start
        A map of few eigenpairs, say 4 to 20, that need not be exact; its bases must have k.
    k
        Size of the result. Default: all eigenpairs that both bases have.
    step
        Eigenpairs that are added at a time. Larger steps are faster, and less sure.
    progress
        Called with (rounds done, rounds in all).

    Returns
    -------
    FunctionalMap
        k x k; a start that is not square keeps the difference, and its longer side becomes k.
        ``descriptor_residual`` is None.

    Raises
    ------
    BeltramiError
        If k is below the size of the start or above that of a basis, or the step is not a whole
        number >= 1.

    Notes
    -----
    Cost: a KD-tree and a query for each vertex in each round, and O(n k²) for the maps.

    References
    ----------
    S. Melzi, J. Ren, E. Rodolà, A. Sharma, P. Wonka, M. Ovsjanikov: ZoomOut: spectral upsampling
    for efficient shape correspondence, ACM TOG 38(6), 2019.

    Examples
    --------
    >>> import numpy as np
    >>> from beltrami.mesh.shapes import blob
    >>> from beltrami.operators.laplacian import laplacian
    >>> from beltrami.spectrum.fourier_basis import fourier_basis
    >>> from beltrami.spectrum.functional_map import functional_map
    >>> basis = fourier_basis(laplacian(blob(500)), 40)
    >>> start = functional_map(basis, basis, landmarks=[[v, v] for v in range(0, 500, 50)], k=8)
    >>> bool((zoomout(start).point_map == np.arange(basis.n)).all())
    True
    """
    as_count(step, "step")
    source, target = start.source, start.target
    rows, columns = start.matrix.shape
    least, most = max(rows, columns), min(source.k, target.k)
    final = most if k is None else min(size_of(basis, k) for basis in (source, target))
    if final < least:
        raise BeltramiError(f"k is {final}, below the {least} eigenpairs of the start")
    phi, psi = (unit_vectors(basis, final) for basis in (source, target))
    weighted = target.mass @ psi / total_mass(target)
    C, added = start.matrix, 0
    for size in stages(final - least, progress, step):
        k_target, k_source = C.shape
        points = nearest_points(C, phi[:, :k_source], psi[:, :k_target])
        added += size
        C = map_of_points(points, phi[:, : columns + added], weighted[:, : rows + added])
    return with_point_map(C, source, target)
