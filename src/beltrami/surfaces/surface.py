"""ParametricSurface: curvature and Laplacian of a chart (definitions 1, 2 and 16)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats
from beltrami._kinds import checked
from beltrami.errors import DimensionError
from beltrami.surfaces import checks, forms
from beltrami.surfaces.chart import SAMPLES, Chart
from beltrami.surfaces.functions import in_parameters
from beltrami.surfaces.immersion import Derivatives, Map, derivatives_of


class ParametricSurface(Chart):
    r"""A surface :math:`u \in D \subset R^2 \mapsto \varphi(u) \in R^k` (definition 1, E2).

    First and second derivatives of φ are exact to rounding: φ is called with numbers that carry
    them (``jets.Jet``), so no step is chosen. All methods take u and v of any shape, broadcast
    against each other, and put the coordinates last.

    Chapter items: D1.

    Parameters
    ----------
    phi
        ``phi(u, v)`` with arrays u and v of one shape, written with the elementary functions of
        numpy; returns k >= 2 coordinates, as a sequence (or first axis), or along the last axis.
    domain
        ((u0, u1), (v0, v1)), or a ``Rectangle`` or ``Disk``.
    periodic
        Whether u, and whether v, goes around (for two intervals only). A side of the rectangle
        that φ maps to one point is a pole, and need not be declared.
    jacobian
        ``jacobian(u, v)``: k rows of 2, or an array (..., k, 2). φ may then be any code. It is
        checked against differences of φ, and differentiated itself by jets.
    hessian
        ``hessian(u, v)``: k x 2 x 2, for a Jacobian that is not written with numpy.

    Raises
    ------
    SurfaceError
        If the domain is empty, φ is not finite on it, or the given derivatives are not those of φ.
    DimensionError
        If φ does not return k >= 2 coordinates.

    Examples
    --------
    >>> torus = ParametricSurface(
    ...     lambda u, v: ((2 + np.cos(v)) * np.cos(u), (2 + np.cos(v)) * np.sin(u), np.sin(v)),
    ...     ((0, 2 * np.pi), (0, 2 * np.pi)), periodic=(True, True))
    >>> torus
    <ParametricSurface in R³ on [0, 6.28319) x [0, 6.28319)>
    >>> torus.first_fundamental_form(1.0, 0.0).round(12).tolist()
    [[9.0, 0.0], [0.0, 1.0]]
    >>> torus.mesh(30, 20)
    <Mesh: 600 vertices in R³, 1200 faces, data 'parameters'>
    """

    # ---------------------------------------------------------------- curvature

    def gaussian_curvature(self, u: ArrayLike, v: ArrayLike) -> Floats:
        """(...,) Gaussian curvature K, in any dimension k; unit 1/length².

        By Gauss's equation from the second derivatives of φ; it depends on I alone (section
        3.1.1), so bending changes it nowhere.

        Chapter items: P3.

        Raises
        ------
        RankLossError
            Where φ has not rank 2, as at poles.
        """
        at, _, _, shape = self._regular(u, v)
        return forms.gaussian_curvature(at.jacobian, at.hessian).reshape(shape)

    def mean_curvature(self, u: ArrayLike, v: ArrayLike) -> Floats:
        """(...,) mean curvature, in R³: positive where the surface bends away from its normal.

        So does a sphere from an outward one. The normal is along ∂φ/∂u x ∂φ/∂v. Not intrinsic:
        rolling a sheet up changes it.

        Chapter items: P3.

        Raises
        ------
        RankLossError
            Where φ has not rank 2, as at poles.
        DimensionError
            If k is not 3.
        """
        if self.dimension != 3:
            raise DimensionError(f"the sign of a mean curvature needs R³, not R^{self.dimension}")
        at, _, _, shape = self._regular(u, v)
        vector = forms.mean_curvature_vector(at.jacobian, at.hessian)
        return -(vector * forms.unit_normal(at.jacobian)).sum(axis=-1).reshape(shape)

    @checked
    def is_flat(self, tol: float = 1e-9) -> bool:
        """Whether K = 0, at 256 parameters: the surface is locally isometric to the plane (E1).

        Chapter items: X1.
        """
        curvature = self.gaussian_curvature(*self.domain.samples(SAMPLES))
        return bool(np.abs(curvature).max() * self.size**2 <= tol)

    def laplace_beltrami(self, f: Map, of: str = "space") -> Callable[..., Floats]:
        r"""Return :math:`\Delta_M f` as a function of (u, v), by definition 16.

        .. math:: \sqrt g\,\Delta f = \partial_1\left(\frac{g_{22}}{\sqrt g}\partial_1 f
            - \frac{g_{12}}{\sqrt g}\partial_2 f\right) + \partial_2\left(\frac{g_{11}}{\sqrt g}
            \partial_2 f - \frac{g_{12}}{\sqrt g}\partial_1 f\right)

        Negative where f has a maximum: the matrices L of meshes approximate -Δ. The same in any
        parameters (P39). Unit: that of f over length².

        Chapter items: D16, P39.

        Parameters
        ----------
        f
            Written with numpy: ``f(x, y, z)`` (one argument for each of the k coordinates), or
            ``f(u, v)`` with ``of="parameters"``.
        of
            Whether f is a function of points in ``"space"`` or of the ``"parameters"``.

        Raises
        ------
        RankLossError
            When Δf is asked for where φ has not rank 2, as at poles (E2).
        NotDifferentiableError
            When f or φ is not made of functions with known derivatives.

        Examples
        --------
        >>> cylinder = ParametricSurface(lambda u, v: (2 * np.cos(u), 2 * np.sin(u), v),
        ...                              ((0, 2 * np.pi), (0, 1)), periodic=(True, False))
        >>> float(cylinder.laplace_beltrami(lambda x, y, z: x + z**2)(0.0, 0.5))
        1.5
        """
        fbar = in_parameters(self, f, of)

        def at(u: ArrayLike, v: ArrayLike) -> Floats:
            here, a, b, shape = self._regular(u, v)
            values = derivatives_of(fbar, "f", 0, a, b)
            for some in values:
                checks.require_derivatives(some, a, b, "f")
            delta = forms.laplacian(here.jacobian, here.hessian, values.jacobian, values.hessian)
            return delta.reshape(shape)

        return at

    def _regular(
        self, u: ArrayLike, v: ArrayLike
    ) -> tuple[Derivatives, Floats, Floats, tuple[int, ...]]:
        """Return the derivatives at parameters where φ has rank 2, flat, with their shape."""
        a, b, shape = self._door(u, v)
        at = self.immersion.derivatives(a, b)
        checks.require_finite(at.points, a, b)
        checks.require_derivatives(at.jacobian, a, b)
        checks.require_rank(at.jacobian, self.domain, self.size, a, b)
        checks.require_derivatives(at.hessian, a, b)
        return at, a, b, shape
