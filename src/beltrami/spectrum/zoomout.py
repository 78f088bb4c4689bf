"""zoomout: refine a functional map by adding one frequency at a time (Melzi et al. 2019)."""

from __future__ import annotations

from beltrami._arrays import Floats, Integers, whole
from beltrami._kinds import checked
from beltrami._progress import Progress, stages
from beltrami.errors import BeltramiError
from beltrami.spectrum.correspondence import (
    FunctionalMap,
    size_of,
    unit_vectors,
    with_point_map,
)
from beltrami.spectrum.masses import total_mass
from beltrami.spectrum.nearest import spread_rows
from beltrami.spectrum.point_maps import map_of_points, map_of_samples, nearest_points


@checked
def zoomout(
    start: FunctionalMap,
    k: int | None = None,
    *,
    step: int = 1,
    samples: int | None = None,
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
    samples
        How many target vertices, far from each other, take part in the rounds; the last map of
        points is that of all. Default: all vertices. A thousand are enough for most surfaces, and
        make a round linear in n.
    progress
        Called with (eigenpairs added, eigenpairs to add).

    Returns
    -------
    FunctionalMap
        k x k; a start that is not square keeps the difference, and its longer side becomes k.
        ``descriptor_residual`` is None.

    Raises
    ------
    BeltramiError
        If k is below the size of the start or above that of a basis, the step is not a whole
        number >= 1, or the samples are fewer than k or more than the target has vertices.

    Notes
    -----
    Cost: O(n_source n_target k) at the speed of BLAS in each round (or a KD-tree for up to 16
    eigenpairs), and O(n k²) for the maps; O(n_source q k) for q samples.

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
    whole("step", step, least=1)
    source, target = start.source, start.target
    rows, columns = start.matrix.shape
    least, most = max(rows, columns), min(source.k, target.k)
    final = most if k is None else min(size_of(basis, k) for basis in (source, target))
    if final < least:
        raise BeltramiError(f"k is {final}, below the {least} eigenpairs of the start")
    phi, psi = (unit_vectors(basis, final) for basis in (source, target))
    if samples is not None:
        psi = psi[_spread_vertices(psi, samples)]
    weighted = target.mass @ psi / total_mass(target) if samples is None else None
    C, added = start.matrix, 0
    for size in stages(final - least, progress, step):
        k_target, k_source = C.shape
        points = nearest_points(C, phi[:, :k_source], psi[:, :k_target])
        added += size
        left, right = rows + added, columns + added
        if weighted is None:
            C = map_of_samples(points, phi[:, :right], psi[:, :left])
        else:
            C = map_of_points(points, phi[:, :right], weighted[:, :left])
    return with_point_map(C, source, target)


def _spread_vertices(psi: Floats, samples: int) -> Integers:
    """Choose vertices far from each other, where the eigenvectors say where: psi[chosen] is good.

    Differences of all of the first k eigenvectors measure distances about alike everywhere.
    """
    n, k = psi.shape
    if whole("samples", samples, least=k) > n:
        raise BeltramiError(f"{samples} samples are more than the {n} target vertices")
    return spread_rows(psi, samples)
