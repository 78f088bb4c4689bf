"""Inverse iteration: powers of the inverse of a shifted matrix (equation 3.9, theorem 10)."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.sparse import csr_array

from beltrami._arrays import Floats, Integers, read_only
from beltrami.errors import ConvergenceError, MeshError
from beltrami.solvers.shifted import ShiftedSolver
from beltrami.solvers.sign_rule import fix_signs

_ROUNDING = 1e-14  # a change of the line that is no change
_MEASURED = 1e-8  # the changes below are too near to rounding to tell a rate
_APART = 1e-6  # likewise for directions
_SOLVE = 0.01  # residuals of a solve beside the last change of the line
_COPY = 1e-6  # relative distance at which an eigenvalue is the same one again
_NEXT = 1e-4  # relative accuracy of the next distance
_STEPS = 40  # of Lanczos, at most, for it


@dataclass(frozen=True, eq=False, repr=False)
class InverseIteration:
    r"""An eigenpair :math:`L\varphi = \lambda B\varphi` next to a shift, and how it was found.

    ``inverse_iteration`` makes it. Histories have one entry for each iteration, the start not
    counted.

    Attributes
    ----------
    eigenvalue : Rayleigh quotient :math:`\langle L\varphi, \varphi\rangle`, of the last iterate
    eigenvector : (n,) with :math:`\varphi^T B\varphi = 1`; of the entries that are largest, up to
        1e-6, the first is positive
    shift : σ
    quotients : (k,) Rayleigh quotients; their errors fall like :math:`\rho^{2k}` (E66)
    changes : (k,) sines of the angles between iterates: signs do not count, which alternate
        where σ > λ (E65). They fall like :math:`\rho^k`
    residuals : (k,) norms of :math:`Lv - \theta Bv` beside :math:`\max(|\theta|, |\sigma|) Bv`
    rate : the measured ρ, from the last changes above rounding; NaN where there were too few
    predicted_rate : :math:`|\lambda - \sigma| / |\lambda^+ - \sigma|`, where λ⁺ is the next
        nearest eigenvalue of which the start has a part, another copy of λ not counted; NaN where
        there is none
    solver : ``"lu"``, ``"ldl"``, ``"cholesky"`` or ``"minres"``
    inner_iterations : (k,) steps of MINRES; zeros where the matrix was factorised
    """

    eigenvalue: float
    eigenvector: Floats
    shift: float
    quotients: Floats
    changes: Floats
    residuals: Floats
    rate: float
    predicted_rate: float
    solver: str
    inner_iterations: Integers

    def __post_init__(self) -> None:
        histories = (self.quotients, self.changes, self.residuals, self.inner_iterations)
        for array in (self.eigenvector, *histories):
            read_only(array)

    def __repr__(self) -> str:
        return (
            f"<InverseIteration: eigenvalue {self.eigenvalue:.6g} next to {self.shift:.6g}, "
            f"{self.iterations} iterations, {self.solver}>"
        )

    @property
    def iterations(self) -> int:
        """How many iterations were made."""
        return len(self.changes)

    @property
    def residual(self) -> float:
        """The residual of the eigenpair, the last one of the history."""
        return float(self.residuals[-1])


def iterate(
    L: csr_array,
    B: csr_array,
    shift: float,
    start: Floats,
    solver: ShiftedSolver,
    *,
    tolerance: float,
    max_iterations: int,
) -> InverseIteration:
    r"""Iterate :math:`(L - \sigma B) w_{k+1} = B v_k`, :math:`v_{k+1} = w_{k+1} / |w_{k+1}|_B`.

    It stops when the distance of the line from its limit, estimated by the last two changes and
    their ratio r as :math:`c\,r / (1 - r)`, is below the tolerance.

    Raises
    ------
    ConvergenceError
        If it does not get there.
    MeshError
        If the start is zero.
    """
    v = apart = _normalised(B, start)
    changes: list[float] = []
    looks: list[tuple[float, float]] = []
    inner: list[int] = []
    while not changes or _distance(changes) > tolerance:
        if len(changes) == max_iterations:
            raise _not_converged(changes, shift)
        allowed = _SOLVE * min(changes[-1] if changes else 1, 1)
        guess = v / (looks[-1][0] - shift) if looks and looks[-1][0] != shift else None
        w, steps = solver.solve(B @ v, allowed, guess)
        w = w / _norm(B, w)
        across = v - (w @ (B @ v)) * w
        changes.append(_norm(B, across))
        inner.append(steps)
        if changes[-1] > _APART or len(changes) == 1:
            apart = across
        v = w
        looks.append(_look(L, B, v, shift))
    quotients, residuals = np.array(looks).T.copy()
    return InverseIteration(
        eigenvalue=float(quotients[-1]),
        eigenvector=_signed(v),
        shift=shift,
        quotients=quotients,
        changes=np.array(changes),
        residuals=residuals,
        rate=_measured(changes),
        predicted_rate=_next_ratio(B, solver, v, apart, float(quotients[-1]) - shift),
        solver=solver.name,
        inner_iterations=np.array(inner, dtype=np.int64),
    )


def _look(L: csr_array, B: csr_array, v: Floats, shift: float) -> tuple[float, float]:
    """Return the Rayleigh quotient of v, and its residual beside λ B v."""
    Lv, Bv = L @ v, B @ v
    theta = float(v @ Lv)
    scale = max(abs(theta), abs(shift)) * np.linalg.norm(Bv)
    return theta, float(np.linalg.norm(Lv - theta * Bv) / scale)


def _norm(B: csr_array, v: Floats) -> float:
    return float(np.sqrt(v @ (B @ v)))


def _signed(v: Floats) -> Floats:
    column = v[:, None].copy()
    fix_signs(column)
    return column[:, 0].copy()


def _normalised(B: csr_array, start: Floats) -> Floats:
    """Return v_0; the largest entry is taken out first, so that squares do not overflow."""
    largest = np.abs(start).max()
    if largest == 0:
        raise MeshError("the start is zero", remedy="Leave it out for a random one.")
    v = start / largest
    return np.asarray(v / _norm(B, v))


def _distance(changes: list[float]) -> float:
    """Estimate how far the line is from its limit, if changes fall like a geometric series."""
    if changes[-1] <= _ROUNDING:
        return 0.0
    if len(changes) < 2 or changes[-1] >= changes[-2]:
        return np.inf
    r = changes[-1] / changes[-2]
    return max(changes[-1], changes[-1] * r / (1 - r))


def _measured(changes: list[float]) -> float:
    """Return the last ratio of two changes that are above rounding; NaN without one."""
    told = [b / a for a, b in pairwise(changes) if b > _MEASURED]
    return told[-1] if told else np.nan


def _not_converged(changes: list[float], shift: float) -> ConvergenceError:
    rate = changes[-1] / changes[-2] if len(changes) > 1 and changes[-2] > 0 else np.nan
    return ConvergenceError(
        f"after {len(changes)} inverse iterations with the shift {shift:.6g} the vector still "
        f"changes by {changes[-1]:.1e}, at a rate of {rate:.4f}. Take a shift nearer to one "
        "eigenvalue than to the others, or allow more iterations"
    )


def _next_ratio(
    B: csr_array, solver: ShiftedSolver, v: Floats, start: Floats, distance: float
) -> float:
    r"""Return :math:`|\lambda - \sigma| / |\lambda^+ - \sigma|` by Lanczos beside v.

    All of what Lanczos sees is in the span of the iterates, so an eigenvector that the start has
    no part of is not seen, and neither is the rest of the eigenspace of v; but rounding may bring
    another copy of λ back, which is told by its value.
    """
    rows = [v]
    alphas: list[float] = []
    betas: list[float] = []
    w = _orthogonal(B, start, rows)
    size = _norm(B, w)
    if size <= _ROUNDING or not distance:
        return np.nan
    for _ in range(_STEPS):
        rows.append(w / size)
        w, _ = solver.solve(B @ rows[-1], _NEXT * _SOLVE, None)
        alphas.append(float(rows[-1] @ (B @ w)))
        w = _orthogonal(B, w, rows)
        size = _norm(B, w)
        T = np.diag(alphas) + np.diag(betas, 1) + np.diag(betas, -1)
        values, vectors = np.linalg.eigh(T)
        others = np.flatnonzero(np.abs(values * distance - 1) > _COPY)
        if len(others):
            best = others[np.abs(values[others]).argmax()]
            error = size * abs(vectors[-1, best])
            if error <= _NEXT * abs(values[best]):
                return float(abs(values[best] * distance))
        if size <= _ROUNDING / abs(distance):
            return np.nan
        betas.append(size)
    return np.nan


def _orthogonal(B: csr_array, w: Floats, rows: list[Floats]) -> Floats:
    """Return w without its parts along the rows; twice is enough (Kahan)."""
    Q = np.array(rows)
    for _ in range(2):
        w = w - Q.T @ (Q @ (B @ w))
    return w
