"""The heat equation ∂F/∂t = s - B⁻¹ L F (definition 17, equations 3.6, 3.7 and 3.10)."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, as_function
from beltrami._kinds import checked
from beltrami._progress import Progress
from beltrami.diffusion.exponential import diffuse_exactly
from beltrami.diffusion.heat_steps import crank_nicolson_steps, explicit_steps, implicit_steps
from beltrami.diffusion.held import (
    FreePart,
    free_part,
    held_vertices,
    like_columns,
    positions_of,
)
from beltrami.diffusion.modes import Modes, find_modes
from beltrami.diffusion.steady import steady_state
from beltrami.errors import BeltramiError, StepTooLongError, check_name
from beltrami.operators.domain import require_laplacian
from beltrami.operators.pair import Laplacian
from beltrami.spectrum.basis import FourierBasis

HEAT_METHODS = ("implicit", "explicit", "crank_nicolson", "spectral", "exact")
_IN_STEPS = HEAT_METHODS[:3]
_LONG = 1e4
_MOST_STEPS = 10_000_000  # of the explicit scheme, if the caller does not insist


@checked
def heat(
    laplacian: Laplacian,
    f: ArrayLike,
    time: float,
    method: str = "implicit",
    steps: int | None = None,
    *,
    source: ArrayLike | None = None,
    hold: ArrayLike = (),
    damped_steps: int | None = None,
    basis: FourierBasis | None = None,
    tolerance: float | None = None,
    progress: Progress | None = None,
) -> Floats:
    r"""Diffuse a function for a time t: :math:`\partial F/\partial t = s - B^{-1} L F`, F_0 = f.

    Chapter items: D17, T15, T16, Q3.6, Q3.7, Q3.10, U30, U31, U32, R3, R4, P40, P47.

    Parameters
    ----------
    laplacian
        The pair (L, B). With area masses the time has the unit length²; with the degree mass it
        has none, and :math:`B^{-1}L = \mathrm{Id} - \tilde W` (E50).
    f
        (n,) or (n, c): each column is diffused.
    time
        Total time, >= 0.
    method
        ``"implicit"``: :math:`(B + \delta L) F_{k+1} = B F_k` (equation 3.7 made symmetric, E54),
        stable for every step; one factorisation serves all steps and columns.
        ``"explicit"``: :math:`F_{k+1} = F_k - \delta B^{-1} L F_k` (equation 3.6, E51), stable for
        :math:`\delta \le 2 / \lambda_n` (E52).
        ``"crank_nicolson"``: :math:`(B + \frac\delta2 L) F_{k+1} = (B - \frac\delta2 L) F_k`, of
        second order and stable, for smooth f; what is rough rings: frequencies with δλ > 2
        change sign in each step, and those with δλ >> 2 hardly decay. See ``damped_steps``.
        ``"spectral"``: :math:`\hat F_t = e^{-\lambda t} \hat f` (equation 3.10), with ``basis``.
        ``"exact"``: :math:`e^{-t B^{-1} L} f` to 1e-12 of the norm of f, by one factorisation and
        30 solves (see ``diffuse_exactly``); one more factorisation with a source or held values.
    steps
        Number of steps of length δ = time / steps. Default: 10, or the fewest explicit ones for
        which no mode is overshot (δ <= 1 / bound).
    source
        (n,) or (n, c) heat s that comes in per unit of time, at all times.
    hold
        Vertices (indices or a mask) whose values stay as they are.
    damped_steps
        How many of the first steps of Crank and Nicolson are made as two implicit half steps,
        which damp what is rough, by the same factor and still at second order (Rannacher 1984).
        Default 0; 2 suffice for a point of heat.
    basis
        Eigenpairs of this pair, from the smallest on, zero at held vertices. Default: all of
        them, for small meshes.
    tolerance
        Of the spectral method: how much of the norm of the result the frequencies beyond the
        basis may be, at most. Default 1e-3.
    progress
        Called with (steps done, steps in all).

    Returns
    -------
    (n,) or (n, c), as f. Implicit and explicit steps are of first order in δ, with errors of
    opposite sign. The mean of B is kept to rounding by every method if nothing is held, and moved
    by t times that of s.

    Raises
    ------
    StepTooLongError
        If an explicit step is beyond 2 over ``laplacian.spectral_bound()``, the proven bound;
        ``error.longest`` is the longest allowed.
    TruncationError
        If the basis may leave out more than the tolerance.
    SingularMatrixError
        If the time is so long that nothing of the mass is left beside δL (more than 1e12 or so
        times the area).
    NegativeWeightError
        With the exact and the spectral method, if L is not known to be positive semi-definite.
    DimensionError, NonFiniteError, UnknownNameError, MeshError, BeltramiError
        If f, s, the method, its options, the basis or the numbers are not valid, or all vertices
        are held.

    Examples
    --------
    >>> from beltrami.mesh.mesh import Mesh
    >>> from beltrami.operators.laplacian import laplacian
    >>> mesh = Mesh([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1, 2], [0, 2, 3]])
    >>> pair = laplacian(mesh)
    >>> spread = heat(pair, [1, 0, 0, 0], time=0.1)
    >>> spread.round(3).tolist(), pair.mean(spread).round(12).tolist()
    ([0.704, 0.134, 0.028, 0.134], 0.25)
    >>> for method in ("explicit", "crank_nicolson", "exact"):
    ...     print(heat(pair, [1, 0, 0, 0], 0.1, method).round(3))
    [0.6 0.2 0.  0.2]
    [0.697 0.138 0.027 0.138]
    [0.697 0.138 0.027 0.138]
    """
    check_name("method of heat", method, HEAT_METHODS)
    _refuse(method, _IN_STEPS, steps=steps)
    _refuse(method, ("crank_nicolson",), damped_steps=damped_steps)
    _refuse(method, ("spectral",), basis=basis, tolerance=tolerance)
    require_laplacian(laplacian, "heat")
    values = as_function(f, laplacian.n)
    inflow = None if source is None else like_columns(source, values, "the source")
    held = held_vertices(hold, laplacian.n)
    if not (math.isfinite(time) and time >= 0):
        raise BeltramiError(f"time must be finite and >= 0, not {time}")
    for name, count, least in (("steps", steps, 1), ("damped_steps", damped_steps, 0)):
        if count is not None and (count < least or count != int(count)):
            raise BeltramiError(f"{name} must be a whole number >= {least}, not {count}")
    if method == "explicit":
        steps = _explicit_count(laplacian, time, steps)
    if method in ("spectral", "exact"):
        laplacian.require_semi_definite(f"the {method} method")
    if time == 0:
        return values.copy()
    part = free_part(laplacian.stiffness, laplacian.mass, held, positions_of(laplacian))
    load = -(part.stiffness_border @ values[held]) + np.zeros_like(values[part.free])
    if inflow is not None:
        load += (laplacian.mass @ inflow)[part.free]
    flow = _flow(method, part, time, steps or 10, damped_steps or 0, basis, tolerance, progress)
    result = values.copy()
    if method == "explicit" or (method == "implicit" and not _is_long(part, time / (steps or 10))):
        result[part.free] = flow(values[part.free], load)  # keeps far values positive, if tiny
    else:
        result[part.free] = _evolved(part, values[part.free], load, time, flow)
    return result


def _is_long(part: FreePart, step: float) -> bool:
    """Say whether the mass is so little beside δ times the stiffness that means lose digits."""
    return bool(step * part.stiffness.trace() > _LONG * part.mass.trace())


def _evolved(
    part: FreePart,
    u: Floats,
    load: Floats,
    time: float,
    flow: Callable[[Floats, Floats], Floats],
) -> Floats:
    """Let the means of the components that float drift by themselves, and the rest flow.

    So no digit of the means is lost, however long the time.
    """
    level, drift = part.level(np.asarray(part.mass @ u)), part.level(load)
    rest = flow(u - level, load - part.mass @ drift)
    return np.asarray(part.centred(rest) + (level + time * drift))


def _flow(
    method: str,
    part: FreePart,
    time: float,
    steps: int,
    damped: int,
    basis: FourierBasis | None,
    tolerance: float | None,
    progress: Progress | None,
) -> Callable[[Floats, Floats], Floats]:
    """Return the map (u, load) to the state after the time."""
    if method == "implicit":
        return lambda u, load: implicit_steps(part, u, load, time, steps, progress)
    if method == "explicit":
        return lambda u, load: explicit_steps(part, u, load, time, steps, progress)
    if method == "crank_nicolson":
        return lambda u, load: crank_nicolson_steps(part, u, load, time, steps, damped, progress)
    modes: Modes | None = find_modes(part, basis) if method == "spectral" else None

    def towards_rest(u: Floats, load: Floats) -> Floats:
        rest = steady_state(part, load)
        if modes is None:
            return rest + diffuse_exactly(part, u - rest, time, progress)
        return rest + modes.decayed(u - rest, time, 1e-3 if tolerance is None else tolerance)

    return towards_rest


def _explicit_count(laplacian: Laplacian, time: float, steps: int | None) -> int:
    """Return a number of explicit steps that is stable, or raise."""
    bound = laplacian.spectral_bound()
    count = steps or math.ceil(min(max(1.0, time * bound), _MOST_STEPS + 1))
    if steps is None and count > _MOST_STEPS:
        raise BeltramiError(
            f"a time of {time:g} takes more than {_MOST_STEPS:.0e} explicit steps here: the "
            f"longest allowed is {2 / bound:.6g}. Use the implicit method, or give the steps"
        )
    if time / count * bound > 2 * (1 + 1e-12):
        raise StepTooLongError(time / count, 2 / bound)
    return count


def _refuse(method: str, owners: tuple[str, ...], **options: object) -> None:
    """Raise if an option is given that the method has not."""
    for name, value in options.items():
        if value is not None and method not in owners:
            raise BeltramiError(f"the method {method!r} has no {name}")
