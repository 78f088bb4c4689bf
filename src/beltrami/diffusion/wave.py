"""The wave equation ∂²F/∂t² = -B⁻¹ L F, frame by frame (equation 3.8)."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, as_function, rectangular
from beltrami._kinds import checked
from beltrami._progress import Progress
from beltrami.diffusion.held import (
    FreePart,
    free_part,
    held_vertices,
    like_columns,
    positions_of,
)
from beltrami.diffusion.modes import find_modes, norm, require_complete
from beltrami.diffusion.steady import steady_state
from beltrami.diffusion.wave_steps import implicit_states, leapfrog_states
from beltrami.errors import BeltramiError, StepTooLongError, check_name
from beltrami.operators.domain import require_laplacian
from beltrami.operators.pair import Laplacian
from beltrami.spectrum.basis import FourierBasis

WAVE_METHODS = ("leapfrog", "implicit", "spectral")
_UNCOUNTABLE = 2.0**53
_MOST_STEPS = 10_000_000  # of leapfrog, if the caller does not insist


@checked
def wave(
    laplacian: Laplacian,
    f: ArrayLike,
    g: ArrayLike | None,
    times: ArrayLike,
    method: str = "leapfrog",
    *,
    step: float | None = None,
    hold: ArrayLike = (),
    basis: FourierBasis | None = None,
    tolerance: float | None = None,
    progress: Progress | None = None,
) -> Iterator[tuple[float, Floats]]:
    r"""Yield :math:`\partial^2 F/\partial t^2 = -B^{-1} L F`, F_0 = f, F'_0 = g, frame by frame.

    Chapter items: Q3.8, U26, U33, P47.

    Parameters
    ----------
    laplacian
        The pair (L, B). With area masses and cotangents waves have the speed 1, and the time is a
        length; with the degree mass it has no unit.
    f, g
        (n,) or (n, c): the wave at the time 0, and its velocity; None: at rest.
    times
        When to look: not negative, in ascending order, some equal if you like.
    method
        ``"leapfrog"``: :math:`F_{k+1} = 2F_k - F_{k-1} - \delta^2 B^{-1} L F_k` for k >= 1 (E57),
        from :math:`F_1 = f + \delta g - \frac{\delta^2}2 B^{-1} L f`, without whose last term all
        would be of first order (E58). Stable for :math:`\delta < 2/\sqrt{\lambda_n}` (E59).
        ``"implicit"``: the trapezoidal rule (Newmark with β = 1/4), stable for every step; one
        factorisation for all steps of one length.
        ``"spectral"``: :math:`\hat F_t = \cos(\sqrt\lambda t) \hat f + \frac{\sin \sqrt\lambda t}
        {\sqrt\lambda} \hat g`, where the factor of g is t for λ = 0: the mean drifts (E60).
    step
        The longest step δ of leapfrog or implicit steps. Default: half of what is stable, for
        leapfrog; the time in which a wave crosses an edge of middling length, for implicit ones.
    hold
        Vertices (indices or a mask) whose values stay as they are in f: waves are reflected there.
        At a boundary that is not held they are too, without a change of sign.
    basis
        Eigenpairs of this pair, from the smallest on, zero at held vertices. Default: all of
        them, for small meshes.
    tolerance
        Of the spectral method: how much the frequencies beyond the basis may be, at most, beside
        the norm of f plus the last time times that of g. Default 1e-3.
    progress
        Called with (frames done, frames in all).

    Yields
    ------
    time, F
        The time asked for, and F (n,) or (n, c): yours. Two states are kept, however many are
        asked for.

    Raises
    ------
    StepTooLongError
        If a step of leapfrog is not below 2 over the root of ``laplacian.spectral_bound()``, a
        proven bound; ``error.longest`` is the longest allowed.
    TruncationError
        If the basis may leave out more than the tolerance.
    NegativeWeightError
        If L is not known to be positive semi-definite: such waves explode.
    DimensionError, NonFiniteError, UnknownNameError, MeshError, BeltramiError
        If f, g, the times, the method, its options or the basis are not valid, or all vertices
        are held.

    Notes
    -----
    All is checked when ``wave`` is called, before the first frame. Both schemes are of second
    order in δ, and conserve a discrete energy to rounding:

    - leapfrog :math:`\frac12 \|(F_{k+1} - F_k)/\delta\|_B^2 + \frac12 \langle LF_k, F_{k+1}
      \rangle`. All its steps have one length; a time between two of them is reached by a part of
      a step, from which the scheme does not go on.
    - implicit :math:`\frac12 \|F'_k\|_B^2 + \frac12 \langle LF_k, F_k\rangle`, also with steps of
      several lengths, which end at the times asked for.

    Examples
    --------
    >>> from beltrami.mesh.shapes import icosphere
    >>> from beltrami.operators.laplacian import laplacian
    >>> sphere = icosphere(3)
    >>> z = sphere.vertices[:, 2]  # -Δz = 2z: it swings as cos(√2 t)
    >>> for time, F in wave(laplacian(sphere), z, None, [0, 1, 2]):
    ...     print(time, round(float(F @ z / (z @ z)), 2), round(float(np.cos(time * 2**0.5)), 2))
    0.0 1.0 1.0
    1.0 0.16 0.16
    2.0 -0.95 -0.95
    """
    check_name("method of wave", method, WAVE_METHODS)
    require_laplacian(laplacian, "waves")
    position = as_function(f, laplacian.n)
    velocity = np.zeros_like(position) if g is None else like_columns(g, position, "the velocity")
    held = held_vertices(hold, laplacian.n)
    frames = _checked_times(times)
    laplacian.require_semi_definite("the wave equation")
    if method == "spectral" and step is not None:
        raise BeltramiError("the method 'spectral' has no step")
    if method != "spectral" and not (basis is None and tolerance is None):
        raise BeltramiError(f"the method {method!r} has no basis and no tolerance")
    part = free_part(laplacian.stiffness, laplacian.mass, held, positions_of(laplacian))
    u, v = position[part.free], velocity[part.free]
    level, drift = part.level(part.mass @ u), part.level(part.mass @ v)
    load = -(part.stiffness_border @ position[held]) + np.zeros_like(u)
    start = (part, u - level, v - drift, load, frames)
    if method == "spectral":
        states = _spectral(*start, basis, 1e-3 if tolerance is None else tolerance)
    else:
        scheme = leapfrog_states if method == "leapfrog" else implicit_states
        states = scheme(*start, _checked_step(laplacian, part, method, step, frames))
    return _framed(part, position, states, frames, level, drift, progress)


def _framed(
    part: FreePart,
    position: Floats,
    states: Iterator[Floats],
    times: Floats,
    level: Floats,
    drift: Floats,
    progress: Progress | None,
) -> Iterator[tuple[float, Floats]]:
    """Put the states among the held values, and let the means drift by themselves (E60)."""
    for k, (time, state) in enumerate(zip(times.tolist(), states, strict=True)):
        frame = position.copy()
        if time > 0:
            frame[part.free] = part.centred(state) + (level + time * drift)
        if progress is not None:
            progress(k + 1, len(times))
        yield time, frame


def _spectral(
    part: FreePart,
    u: Floats,
    v: Floats,
    load: Floats,
    times: Floats,
    basis: FourierBasis | None,
    tolerance: float,
) -> Iterator[Floats]:
    """Swing around the state at rest, each frequency by itself."""
    modes = find_modes(part, basis)
    rest = steady_state(part, load)
    roots = np.sqrt(modes.values)
    last = float(times.max(initial=0.0))
    longest = min(last, 1 / roots[-1]) if roots[-1] > 0 else last
    out = modes.left_out(u - rest) + longest * modes.left_out(v)
    require_complete(out, norm(part, u - rest) + last * norm(part, v), tolerance, len(roots))
    a, b = modes.forward(u - rest), modes.forward(v)
    return (
        rest
        + modes.multiplied(a, np.cos(roots * time))
        + modes.multiplied(b, time * np.sinc(roots * time / np.pi))  # sin(√λ t)/√λ, and t at 0
        for time in times
    )


def _checked_step(
    laplacian: Laplacian, part: FreePart, method: str, step: float | None, times: Floats
) -> float:
    """Return the length of steps that was asked for, or a good one."""
    if step is not None and not (math.isfinite(step) and step > 0):
        raise BeltramiError(f"step must be positive and finite, not {step}")
    last = float(times.max(initial=0.0)) or 1.0
    if step is not None and last / step > _UNCOUNTABLE:
        raise BeltramiError(f"a step of {step:g} is too short for a time of {last:g}")
    if method == "implicit":
        q = part.stiffness.shape[0]
        ratio = part.stiffness.diagonal() / (part.mass @ np.ones(q))
        typical = float(np.median(ratio)) if q else 0.0
        return step or (1 / math.sqrt(typical) if typical > 0 else last)
    root = math.sqrt(laplacian.spectral_bound())
    if step is None and root * last > _MOST_STEPS:
        raise BeltramiError(
            f"a time of {last:g} takes more than {_MOST_STEPS:.0e} steps of leapfrog here: the "
            f"longest allowed is {2 / root:.6g}. Use the implicit method, or give the step"
        )
    if step is None:
        return 1 / root if root > 0 else last
    if step * root >= 2:  # at the bound itself the fastest mode grows with the time
        raise StepTooLongError(step, 2 / root * (1 - 1e-6))
    return step


def _checked_times(times: ArrayLike) -> Floats:
    given = np.atleast_1d(np.asarray(rectangular(times), np.float64))
    if given.ndim != 1 or not np.isfinite(given).all() or (given < 0).any():
        raise BeltramiError("times must be a list of finite numbers >= 0")
    if (np.diff(given) < 0).any():
        raise BeltramiError("times must be in ascending order: a wave is followed forwards")
    return given
