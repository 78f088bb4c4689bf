"""Quadratic regularisation: near to f, and smooth (definition 20, theorems 17 and 18)."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array

from beltrami._arrays import Floats, as_function
from beltrami._kinds import checked
from beltrami.diffusion.held import FreePart, free_part, held_vertices, positions_of
from beltrami.diffusion.steady import steady_state
from beltrami.errors import BeltramiError, DimensionError, MeshError, check_name
from beltrami.operators.areas import diagonal_matrix
from beltrami.operators.domain import require_laplacian
from beltrami.operators.pair import Laplacian
from beltrami.solvers.factorize import factorize

FORMS = ("mass", "identity", "normalized")


@checked
def regularize(
    laplacian: Laplacian,
    f: ArrayLike,
    t: float,
    form: str = "mass",
    *,
    hold: ArrayLike = (),
    weights: ArrayLike | None = None,
) -> Floats:
    r"""Return the function g that is near to f and smooth: the minimum of a sum of two squares.

    Chapter items: D20, T17, T18, U34.

    Parameters
    ----------
    laplacian
        The pair (L, B).
    f
        (n,) or (n, c): each column is regularised.
    t
        How much smoothness counts, from 0 to ``math.inf``, which gives the limit.
    form
        ``"mass"``: :math:`\min \|f - g\|_B^2 + t \langle Lg, g\rangle`, so
        :math:`(B + tL) g = B f`: one implicit step of heat, and t has its unit (length² with area
        masses). Frequencies of the pair are attenuated by :math:`1/(1 + t\lambda)`, constants are
        kept, and the limit is the mean of B.
        ``"identity"``: :math:`\min \|f - g\|^2 + t \langle Lg, g\rangle`, so
        :math:`(\mathrm{Id} + tL) g = f`; keeps constants, and the limit is the plain mean that
        theorem 18 prints. Vertices count alike, however small their cells.
        ``"normalized"``: :math:`\min \|f - g\|^2 + t \|G D^{-1/2} g\|^2`, so
        :math:`(\mathrm{Id} + t \tilde L) g = f`: definition 20 and theorem 17 to the letter. It
        does not keep constants: the limit is the profile :math:`D^{1/2} 1` (E77). Frequencies are
        attenuated by :math:`1/(1 + t\lambda)` in :math:`U^T f`, not in definition 19's
        :math:`U^T D^{1/2} f` (E76).
    hold
        Vertices (indices or a mask) where g = f: hard constraints.
    weights
        (n,) factors >= 0 of the squares :math:`(f_i - g_i)^2`: soft constraints. With 0 the value
        f_i is not used, as where nothing was measured; :math:`\sqrt w_i b_{ij} \sqrt w_j` for the
        consistent mass. Default 1.

    Returns
    -------
    (n,) or (n, c), as f

    Raises
    ------
    SingularMatrixError
        If t is so large, or a weight so small, that it counts for nothing: see t = inf.
    MeshError
        If a component has neither a weight nor a held vertex, all vertices are held, or a weight
        is negative.
    NegativeWeightError
        If L is not known to be positive semi-definite.
    UnknownNameError, DimensionError, NonFiniteError, BeltramiError
        If the form, f, t or the weights are not valid.

    Notes
    -----
    The three are one problem, :math:`(C + tL) y = c`: with C = B, Id or D, and in the third
    :math:`g = D^{1/2} y`. Cost: one factorisation for all columns.

    Examples
    --------
    >>> from beltrami.mesh.mesh import Mesh
    >>> from beltrami.operators.laplacian import laplacian
    >>> pair = laplacian(Mesh([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1, 2], [0, 2, 3]]), "distance")
    >>> for form in FORMS:  # the corners 0 and 2 have the degree 2.5, the others 2
    ...     print(regularize(pair, [1.0, 0, 0, 0], math.inf, form).round(3))
    [0.278 0.278 0.278 0.278]
    [0.25 0.25 0.25 0.25]
    [0.278 0.248 0.278 0.248]
    """
    check_name("form", form, FORMS)
    require_laplacian(laplacian, "regularisation")
    laplacian.require_semi_definite("regularisation")
    values = as_function(f, laplacian.n)
    held = held_vertices(hold, laplacian.n)
    if not t >= 0:
        raise BeltramiError(f"t must be >= 0, not {t}")
    soft = _checked_weights(weights, laplacian.n)
    root = np.ones(laplacian.n)
    if form == "normalized":
        root = np.sqrt(_positive_degrees(laplacian))
    scale = root[(...,) + (None,) * (values.ndim - 1)]
    closeness, load = _closeness(laplacian, form, soft, values / scale)
    part = free_part(laplacian.stiffness, closeness, held, positions_of(laplacian))
    _require_weights(part, "neither a weight nor a held vertex")
    result = values.copy()
    y = _minimum(part, load[part.free], (values / scale)[held], t)
    result[part.free] = y * scale[part.free]
    return result


def _closeness(
    laplacian: Laplacian, form: str, soft: Floats, y: Floats
) -> tuple[csr_array, Floats]:
    """Return C and C y, for y that is near to the function."""
    if form == "mass" and laplacian.mass_kind == "consistent":
        root = diagonal_matrix(np.sqrt(soft))
        C = csr_array(root @ laplacian.mass @ root)
    else:
        own = {
            "mass": laplacian.masses,
            "identity": np.ones(laplacian.n),
            "normalized": laplacian.degrees,
        }
        C = diagonal_matrix(soft * own[form])
    return C, np.asarray(C @ y)


def _minimum(part: FreePart, load: Floats, fixed: Floats, t: float) -> Floats:
    """Solve (C + tL) y = c on the free vertices; what floats has the mean of c whatever t is."""
    pull = part.stiffness_border @ fixed
    level = part.level(load)
    if math.isinf(t):
        return level + steady_state(part, np.asarray(-pull))
    load = load - part.mass @ level - part.mass_border @ fixed - t * pull
    matrix = csr_array(part.mass + t * part.stiffness)
    return level + factorize(matrix, part.positions).solve(load)


def _checked_weights(weights: ArrayLike | None, n: int) -> Floats:
    if weights is None:
        return np.ones(n)
    given = as_function(weights, n, "the weights")
    if given.ndim != 1:
        raise DimensionError(f"the weights have the shape {given.shape} where ({n},) is needed")
    if (given < 0).any():
        raise MeshError("weights are negative", vertices=np.flatnonzero(given < 0))
    return given


def _positive_degrees(laplacian: Laplacian) -> Floats:
    alone = np.flatnonzero(laplacian.degrees <= 0)
    if len(alone):
        raise MeshError(
            "the normalised form divides by degrees, which are not positive",
            vertices=alone,
            remedy='Use the form "mass" or "identity".',
        )
    return laplacian.degrees


def _require_weights(part: FreePart, problem: str) -> None:
    """Raise if nothing fixes a component that floats."""
    nothing = part.weights <= 0
    if nothing.any():
        raise MeshError(
            f"a component has {problem}",
            vertices=np.flatnonzero(part.free)[part.pins][nothing],
            remedy="Give a positive weight to one of its vertices at least.",
        )
