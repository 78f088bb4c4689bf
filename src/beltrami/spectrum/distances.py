"""spectral_distance: diffusion, commute-time and biharmonic distances, and their embeddings."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, as_indices
from beltrami._kinds import checked
from beltrami.errors import BeltramiError, MeshError, check_name
from beltrami.spectrum.basis import FourierBasis
from beltrami.spectrum.null_space import ZERO, apart, positive_modes, true_zeros

SPECTRAL_DISTANCES = ("biharmonic", "commute_time", "diffusion")


@checked
def spectral_embedding(
    basis: FourierBasis,
    kind: str = "biharmonic",
    *,
    time: float | None = None,
    tolerance: float = ZERO,
) -> Floats:
    r"""Return (n, k) coordinates :math:`w_i \varphi_i(x)`, whose distances are the spectral ones.

    ===================  =============================  ========================================
    ``"biharmonic"``      :math:`1 / \lambda_i`          unit of the distance: length
    ``"commute_time"``    :math:`1 / \sqrt{\lambda_i}`   no unit (the global point signature)
    ``"diffusion"``       :math:`e^{-\lambda_i t}`       length⁻¹; needs the time t, in length²
    ===================  =============================  ========================================

    Zero eigenvalues (up to ``tolerance`` times the largest): for diffusion their weight is 1; the
    others leave them out (0), and are embeddings of each component by itself.

    Raises
    ------
    MeshError
        If no eigenvalue is above zero, or one is negative.
    BeltramiError
        If the time is missing or negative, or given where none is used.
    UnknownNameError
        If there is no such kind.

    Examples
    --------
    >>> from beltrami.mesh.mesh import Mesh
    >>> from beltrami.operators.laplacian import laplacian
    >>> from beltrami.spectrum.fourier_basis import fourier_basis
    >>> pair = laplacian(Mesh([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]]))
    >>> points = spectral_embedding(fourier_basis(pair, 3), "commute_time")
    >>> resistance = ((points[1] - points[2]) ** 2).sum()  # two resistors of 2 in a row
    >>> round(float(resistance), 9)
    4.0
    """
    check_name("spectral distance", kind, SPECTRAL_DISTANCES)
    if (kind == "diffusion") != (time is not None):
        raise BeltramiError("a time belongs to the diffusion distance, and to no other")
    zeros = positive_modes(basis, "a spectral distance", tolerance)
    values = true_zeros(basis, tolerance)
    if time is not None:
        if not (math.isfinite(time) and time >= 0):
            raise BeltramiError(f"time must be finite and >= 0, not {time}")
        with np.errstate(over="ignore"):  # e to the minus infinity is 0
            weights = np.exp(-values * time)
    else:
        weights = np.zeros(basis.k)
        weights[zeros:] = values[zeros:] ** (-1.0 if kind == "biharmonic" else -0.5)
    return basis.eigenvectors * weights


@checked
def spectral_distance(
    basis: FourierBasis,
    sources: ArrayLike,
    kind: str = "biharmonic",
    *,
    time: float | None = None,
    tolerance: float = ZERO,
) -> Floats:
    r"""Return the (n,) distances :math:`(\sum_i w_i^2 (\varphi_i(x) - \varphi_i(y))^2)^{1/2}`.

    ``"biharmonic"`` (Lipman, Rustamov, Funkhouser 2010): :math:`w_i = 1/\lambda_i`; near a source
    it behaves like the geodesic distance, far away it knows the whole shape, and it is smooth.
    ``"commute_time"``: :math:`w_i = 1/\sqrt{\lambda_i}`; its square is the resistance between x
    and y if edges are wires of the conductance w_ij, whatever the mass. On surfaces it grows
    without limit as the mesh is refined. ``"diffusion"`` (Coifman, Lafon 2006):
    :math:`w_i = e^{-\lambda_i t}`, the B-norm of the difference of the heat that x and y have
    spread for the time t.

    Parameters
    ----------
    basis
        The k smallest eigenpairs of any pair (L, B).
    sources
        One vertex, several, or a mask of n truth values: the distance is from the nearest.
    kind, time
        See ``spectral_embedding``; its (n, k) coordinates give the distances of all pairs.
    tolerance
        Eigenvalues up to this part of the largest one are zero exactly: one for each component.

    Returns
    -------
    (n,) float. Infinite in other components than the sources', where it is not diffusion.
    Modes beyond the basis are left out, so that it is too short, and vertices apart may have
    the distance 0: with :math:`s = \sum_i (\varphi_i(x) - \varphi_i(y))^2` and a diagonal mass, its
    square is too small by :math:`w_k^2 (1/b_x + 1/b_y - s)` at most.

    Raises
    ------
    MeshError
        If there are no sources or they are not vertices; if no eigenvalue is above zero, or one
        is negative.
    BeltramiError, UnknownNameError
        If the kind and the time are not valid.

    Notes
    -----
    Cost: O(nk) for each source.

    References
    ----------
    Y. Lipman, R. Rustamov, T. Funkhouser: Biharmonic distance, ACM TOG 29(3), 2010.
    R. Coifman, S. Lafon: Diffusion maps, Applied and Computational Harmonic Analysis 21, 2006.

    Examples
    --------
    >>> from beltrami.mesh.shapes import icosphere
    >>> from beltrami.operators.laplacian import laplacian
    >>> from beltrami.spectrum.fourier_basis import fourier_basis
    >>> sphere = icosphere(2)
    >>> distance = spectral_distance(fourier_basis(laplacian(sphere), 100), 0)
    >>> int(distance.argmax()) == int((sphere.vertices @ sphere.vertices[0]).argmin())
    True
    """
    points = spectral_embedding(basis, kind, time=time, tolerance=tolerance)
    places = as_indices(sources, basis.n, "sources")
    if not len(places):
        raise MeshError("a distance needs at least one source")
    result = np.full(basis.n, np.inf)
    for place in np.unique(places):
        distance = np.sqrt(((points - points[place]) ** 2).sum(axis=1))
        if kind != "diffusion":
            distance[apart(basis, int(place), tolerance)] = np.inf
        np.minimum(result, distance, out=result)
    return result
