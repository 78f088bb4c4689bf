"""Frame: several kernels that together keep everything, and the way back (wavelets on meshes)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, as_floats, as_function, rectangular
from beltrami._kinds import checked
from beltrami._progress import Progress
from beltrami.errors import BeltramiError, DimensionError, NonFiniteError
from beltrami.operators.pair import Laplacian
from beltrami.spectrum.basis import FourierBasis
from beltrami.spectrum.chebyshev import chebyshev_series
from beltrami.spectrum.interval import spectral_interval
from beltrami.spectrum.kernel import Kernel
from beltrami.spectrum.recurrence import chebyshev_sums


@dataclass(frozen=True)
class Frame:
    r"""Kernels :math:`g_j` on [0, bound], with :math:`A \le \sum_j g_j(\lambda)^2 \le B` there.

    Then :math:`A\|f\|^2 \le \sum_j \|g_j(B^{-1}L) f\|^2 \le B\|f\|^2` in the norm of the mass, and
    f comes back from its parts. A frame is tight where A = B: then energies are kept.

    Parameters
    ----------
    kernels
        The kernels; a number is no kernel.
    bound
        Largest eigenvalue covered, > 0: ``laplacian.spectral_bound()``, or the last eigenvalue.
    """

    kernels: tuple[Kernel, ...]
    bound: float

    def __post_init__(self) -> None:
        if not self.kernels or not all(isinstance(g, Kernel) for g in self.kernels):
            raise BeltramiError("a frame is made of one kernel or more")
        if not (self.bound > 0 and math.isfinite(self.bound)):
            raise BeltramiError(f"the bound of a frame must be finite and > 0, not {self.bound}")

    def power(self, eigenvalues: ArrayLike) -> Floats:
        r"""Return :math:`\sum_j g_j(\lambda)^2`, in the shape of λ."""
        values = as_floats(eigenvalues)
        if not np.isfinite(values).all():
            raise NonFiniteError("eigenvalues are NaN or infinite")
        return np.asarray(sum(g(values) ** 2 for g in self.kernels))

    @property
    def bounds(self) -> tuple[float, float]:
        """The frame bounds (A, B): the extremes of ``power`` at 30000 points of [0, bound].

        Half of the points are evenly spaced, half geometric, down to 1e-12 of the bound, and 0.
        """
        points = self.bound * np.concatenate(
            [[0.0], np.linspace(0, 1, 15000), np.geomspace(1e-12, 1, 15000)]
        )
        power = self.power(points)
        return float(power.min()), float(power.max())

    @checked
    def analyze(
        self,
        operator: Laplacian | FourierBasis,
        f: ArrayLike,
        *,
        tolerance: float = 1e-8,
        progress: Progress | None = None,
    ) -> Floats:
        r"""Return the parts :math:`g_j(B^{-1}L) f`: (j, n) or (j, n, c).

        Parameters
        ----------
        operator
            A Laplacian: by Chebyshev, all kernels in one recurrence. A FourierBasis: by its
            eigenvectors, exact if it is complete.
        tolerance
            As for ``bt.filter``, for each part.

        Raises
        ------
        DimensionError, NonFiniteError
            If f is not a function of the mesh.
        BeltramiError
            If the spectrum goes beyond the bound of the frame.
        ConvergenceError
            If the tolerance is not reached.
        """
        if isinstance(operator, FourierBasis):
            self._require(float(operator.eigenvalues.max(initial=0.0)))
            return np.stack([operator.filter(f, g) for g in self.kernels])
        values = as_function(f, operator.n)
        return self._filtered(operator, self.kernels, values, tolerance, progress)

    @checked
    def synthesize(
        self,
        operator: Laplacian | FourierBasis,
        parts: ArrayLike,
        *,
        tolerance: float = 1e-8,
        progress: Progress | None = None,
    ) -> Floats:
        r"""Return :math:`\sum_j (g_j / \sum_i g_i^2)(B^{-1}L)\, c_j` for the parts c_j.

        Of (j, n) or (j, n, c) parts it makes (n,) or (n, c). It gives back what was analysed; of
        other parts, such as thresholded ones, the function whose parts are nearest to them in the
        norm of the mass.

        Raises
        ------
        DimensionError, NonFiniteError, BeltramiError, ApproximationError
            As ``analyze``; also if the frame loses a frequency (A = 0).
        """
        given = rectangular(parts)
        if given.ndim not in (2, 3) or len(given) != len(self.kernels):
            raise DimensionError(
                f"parts have the shape {given.shape} where ({len(self.kernels)}, n) or "
                f"({len(self.kernels)}, n, c) is needed"
            )
        if not self.bounds[0] > 0:
            raise BeltramiError("the kernels of this frame are all 0 somewhere: no way back")
        power = _Power(self.kernels)
        duals: list[Kernel] = [g / power for g in self.kernels]
        if isinstance(operator, FourierBasis):
            self._require(float(operator.eigenvalues.max(initial=0.0)))
            found = [operator.filter(part, g) for part, g in zip(given, duals, strict=True)]
        else:
            found = [
                self._filtered(operator, [g], as_function(part, operator.n), tolerance, progress)[0]
                for part, g in zip(given, duals, strict=True)
            ]
        return np.asarray(sum(found))

    def _filtered(
        self,
        laplacian: Laplacian,
        kernels: Sequence[Kernel],
        values: Floats,
        tolerance: float,
        progress: Progress | None,
    ) -> Floats:
        """Apply kernels by Chebyshev, in one recurrence."""
        interval = spectral_interval(laplacian)
        self._require(interval.high)
        series = [chebyshev_series(g, interval, tolerance) for g in kernels]
        found = chebyshev_sums(laplacian, values.reshape(laplacian.n, -1), series, progress)
        return found.reshape(len(kernels), *values.shape)

    def _require(self, largest: float) -> None:
        if largest > self.bound * (1 + 1e-9):
            raise BeltramiError(
                f"the frame covers eigenvalues up to {self.bound:g}, and here they go up to "
                f"{largest:g}: make it with laplacian.spectral_bound()"
            )


@dataclass(frozen=True)
class _Power(Kernel):
    """The sum of the squares of kernels."""

    kernels: tuple[Kernel, ...]

    @property
    def jumps(self) -> tuple[float, ...]:
        return tuple(sorted({jump for g in self.kernels for jump in g.jumps}))

    def _at(self, x: Floats) -> Floats:
        return np.asarray(sum(g(x) ** 2 for g in self.kernels))
