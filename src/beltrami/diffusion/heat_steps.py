"""Heat in steps: M u' = -K u + b on the free vertices, for a load b that is constant in time."""

from __future__ import annotations

from collections.abc import Callable

from scipy.sparse import csr_array

from beltrami._arrays import Floats
from beltrami._progress import Progress, stages
from beltrami.diffusion.held import FreePart
from beltrami.solvers.factor import Factor
from beltrami.solvers.factorize import factorize


def implicit_steps(
    part: FreePart, u: Floats, load: Floats, time: float, steps: int, progress: Progress | None
) -> Floats:
    """Solve (M + δK) u' = M u + δ b, over and over with one factor.

    Examples
    --------
    >>> import numpy as np
    >>> from beltrami.diffusion.held import free_part
    >>> L, B = csr_array([[1.0, -1.0], [-1.0, 1.0]]), csr_array(np.eye(2))
    >>> part = free_part(L, B, np.zeros(2, bool))
    >>> implicit_steps(part, np.array([1.0, -1.0]), np.zeros(2), 0.5, 1, None).tolist()
    [0.5, -0.5]
    """
    delta = time / steps
    factor = shifted_factor(part, delta)
    for _ in stages(steps, progress):
        u = factor.solve(part.mass @ u + delta * load)
    return u


def crank_nicolson_steps(
    part: FreePart,
    u: Floats,
    load: Floats,
    time: float,
    steps: int,
    damped: int,
    progress: Progress | None,
) -> Floats:
    """Go on by 2 w - u, where w is one implicit half step; two such in the damped steps.

    Examples
    --------
    >>> import numpy as np
    >>> from beltrami.diffusion.held import free_part
    >>> L, B = csr_array([[1.0, -1.0], [-1.0, 1.0]]), csr_array(np.eye(2))
    >>> part = free_part(L, B, np.zeros(2, bool))
    >>> u, nothing = np.array([1.0, -1.0]), np.zeros(2)
    >>> crank_nicolson_steps(part, u, nothing, 2.0, 1, 0, None).round(12).tolist()  # it rings
    [-0.333333333333, 0.333333333333]
    >>> crank_nicolson_steps(part, u, nothing, 2.0, 1, 1, None).round(12).tolist()
    [0.111111111111, -0.111111111111]
    """
    half = time / steps / 2
    factor = shifted_factor(part, half)
    for k, _ in enumerate(stages(steps, progress)):
        middle = factor.solve(part.mass @ u + half * load)
        u = factor.solve(part.mass @ middle + half * load) if k < damped else 2 * middle - u
    return u


def explicit_steps(
    part: FreePart, u: Floats, load: Floats, time: float, steps: int, progress: Progress | None
) -> Floats:
    """Add δ M⁻¹ (b - K u), over and over.

    Examples
    --------
    >>> import numpy as np
    >>> from beltrami.diffusion.held import free_part
    >>> L, B = csr_array([[1.0, -1.0], [-1.0, 1.0]]), csr_array(np.eye(2))
    >>> part = free_part(L, B, np.zeros(2, bool))
    >>> explicit_steps(part, np.array([1.0, -1.0]), np.zeros(2), 0.25, 1, None).tolist()
    [0.5, -0.5]
    """
    delta = time / steps
    divide = mass_division(part, u.ndim)
    state = u.copy()
    gain = delta * divide(load) if load.any() else None
    for _ in stages(steps, progress):
        state -= delta * divide(part.stiffness @ state)
        if gain is not None:
            state += gain
    return state


def mass_division(part: FreePart, axes: int) -> Callable[[Floats], Floats]:
    """Return the map b to M⁻¹ b, for arrays of so many axes.

    Examples
    --------
    >>> import numpy as np
    >>> from beltrami.diffusion.held import free_part
    >>> L = csr_array([[1.0, -1.0], [-1.0, 1.0]])
    >>> part = free_part(L, csr_array(np.diag([2.0, 4.0])), np.zeros(2, bool))
    >>> mass_division(part, 1)(np.array([1.0, 1.0])).tolist()
    [0.5, 0.25]
    """
    if part.masses is None:
        return factorize(part.mass, part.positions).solve
    inverse = (1 / part.masses)[(...,) + (None,) * (axes - 1)]
    return lambda load: load * inverse


def shifted_factor(part: FreePart, shift: float) -> Factor:
    """Factorise M + shift K.

    Raises
    ------
    SingularMatrixError
        If the shift is so large that nothing of M is left beside it.
    """
    return factorize(csr_array(part.mass + shift * part.stiffness), part.positions)
