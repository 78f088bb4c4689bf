"""h(B⁻¹L) f in the Krylov space of f, by Lanczos in the inner product of B."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Floats
from beltrami._progress import Progress
from beltrami.errors import ApproximationError
from beltrami.operators.pair import Laplacian
from beltrami.spectrum.interval import Interval
from beltrami.spectrum.kernel import Response
from beltrami.spectrum.operator import Operator, as_operator
from beltrami.spectrum.ritz import Watch, ritz_pairs

_MOST = 500  # vectors, if the caller does not say
_EPS = float(np.finfo(np.float64).eps)


def lanczos_filter(
    laplacian: Laplacian,
    f: Floats,
    h: Response,
    interval: Interval,
    *,
    tolerance: float = 1e-8,
    order: int | None = None,
    progress: Progress | None = None,
) -> Floats:
    r"""Return :math:`h(B^{-1}L) f \approx \|f\|_B V h(T) e_1`, column by column of (n, c).

    V is the B-orthonormal basis of f, B⁻¹Lf, (B⁻¹L)²f ..., T the tridiagonal matrix of the
    operator in it. The space grows until neither its last quarter changed the result, nor would one
    more Ritz value, put where it does the most: at an end of the interval, at a jump of h, and in
    the six gaps where h is farthest from what the Ritz values show of it. That is an estimate, no
    bound. The space closes early, and nothing is left out, for a function made of q eigenspaces
    after q steps. Where h jumps at an eigenvalue, rounding decides.

    Parameters
    ----------
    tolerance
        Change allowed in the norm of B, beside \|f\|_B times the largest \|h\| in the interval.
    order
        Number of vectors: then nothing is promised. Default: as many as needed, up to 500.

    Raises
    ------
    ApproximationError
        If 500 vectors do not do; ``error.estimate`` is what was reached.

    Notes
    -----
    Each vector is made orthogonal to all earlier ones, again where much was cancelled, so that
    rounding brings no ghosts.
    Cost for N vectors: N products with L, O(n N²) operations, O(n N) memory. Sources: Saad,
    *Analysis of some Krylov subspace approximations to the matrix exponential operator* (1992);
    for the Ritz value put somewhere, the rules of Gauss-Radau in Golub and Meurant, *Matrices,
    Moments and Quadrature with Applications* (2010).

    Examples
    --------
    >>> from beltrami.mesh.topology import Topology
    >>> from beltrami.operators.laplacian import laplacian
    >>> pair = laplacian(Topology([[0, 1, 2]]))  # eigenvalues 0, 3/2, 3/2
    >>> f = np.array([[1.0], [0.0], [0.0]])
    >>> lanczos_filter(pair, f, lambda x: x**2, Interval(0.0, 1.5)).round(9).ravel().tolist()
    [1.5, -0.75, -0.75]
    """
    apply = as_operator(laplacian)
    result = np.empty_like(f)
    columns = f.shape[1]
    for c in range(columns):
        space = _Space(laplacian, f[:, c], apply, interval)
        result[:, c] = space.filter(h, tolerance, order)
        if progress is not None:
            progress(c + 1, columns)
    return result


class _Space:
    """The Krylov space of one function, which grows vector by vector."""

    def __init__(
        self, laplacian: Laplacian, f: Floats, apply: Operator, interval: Interval
    ) -> None:
        self.apply = apply
        self.mass = laplacian.mass
        self.interval = interval
        self.closed = 4 * _EPS * max(abs(interval.low), abs(interval.high))
        scale = float(np.abs(f).max(initial=0.0))
        self.norm = scale * self._norm(f / scale) if scale else 0.0
        self.vectors = np.empty((16, len(f)))
        self.alpha: list[float] = []
        self.beta: list[float] = []
        self.next = f / self.norm if self.norm else f

    def _norm(self, x: Floats) -> float:
        return float(np.sqrt(max(np.vdot(x, self.mass @ x), 0.0)))

    def filter(self, h: Response, tolerance: float, order: int | None) -> Floats:
        """Grow until the result stands still, or to the given order."""
        watch = Watch(h, self.interval)
        n = len(self.next)
        if not self.norm:
            return np.zeros(n)
        most = min(n, _MOST if order is None else order)
        look, error = 8, 0.0
        while len(self.alpha) < most:
            self._grow()
            size = len(self.alpha)
            if not self.beta[-1] or size == n:
                error = 0.0
                break
            if order is None and (size >= look or size == most):
                look = size + max(4, size // 3)
                error = watch.error(self.alpha, self.beta, tolerance)
                if error <= tolerance:
                    break
        if error > tolerance:
            raise ApproximationError(
                f"{most} vectors of Lanczos leave an error of about {error:.1g} beside the largest "
                f"|h|, and {tolerance:.1g} is wanted",
                error,
                'Use method="chebyshev", method="exact" on a small mesh, a smoother kernel (with a '
                "width) or a larger tolerance; fourier_basis(laplacian, k).filter(f, h) if h is "
                "small beyond the first k eigenvalues; or give the order, and nothing is promised.",
            )
        coordinates = watch.coordinates(*ritz_pairs(self.alpha, self.beta[:-1]))
        return np.asarray(self.norm * (coordinates @ self.vectors[: len(coordinates)]))

    def _grow(self) -> None:
        """Add a vector; β = 0 says that the space has closed."""
        size = len(self.alpha)
        if size == len(self.vectors):
            self.vectors = np.concatenate([self.vectors, np.empty_like(self.vectors)])
        self.vectors[size] = self.next
        known = self.vectors[: size + 1]
        w = self.apply(self.next)
        self.alpha.append(float(np.vdot(self.mass @ self.next, w)))
        w -= self.alpha[-1] * self.next
        if size:
            w -= self.beta[-1] * self.vectors[size - 1]
        before, length = np.inf, self._norm(w)
        while length < 0.7 * before and length > self.closed:  # cancelled: once more
            before = length
            w -= (known @ (self.mass @ w)) @ known
            length = self._norm(w)
        self.beta.append(length if length > self.closed else 0.0)
        if self.beta[-1]:
            self.next = w / length
