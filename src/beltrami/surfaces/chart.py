"""Chart: a map φ from parameters to Rᵏ, and what its first derivatives tell (section 3.1.1)."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats
from beltrami._frozen import Frozen
from beltrami.errors import DimensionError, SurfaceError
from beltrami.mesh.mesh import Mesh
from beltrami.surfaces import checks, curves, forms
from beltrami.surfaces.domain import Disk, Rectangle, as_domain
from beltrami.surfaces.immersion import Immersion, Map, call_at_points
from beltrami.surfaces.jets import Jet
from beltrami.surfaces.meshing import mesh_chart

SAMPLES = 256


class Chart(Frozen):
    """The first-order part of ``ParametricSurface``: points, metric, lengths, meshes.

    The parameters are those of ``ParametricSurface``, the class to use.
    """

    domain: Rectangle | Disk
    immersion: Immersion

    def __init__(
        self,
        phi: Map,
        domain: Any,
        *,
        periodic: tuple[bool, bool] = (False, False),
        jacobian: Map | None = None,
        hessian: Map | None = None,
    ) -> None:
        where = as_domain(domain, periodic)
        self.__dict__.update(domain=where, immersion=Immersion(phi, jacobian, hessian))
        if not all(callable(each) for each in (phi, jacobian or phi, hessian or phi)):
            raise SurfaceError("φ, and its Jacobian and Hessian if they are given, are functions")
        checks.require_range(
            self.size, where
        )  # calls φ, so that what is wrong with it is told here
        checks.require_true_derivatives(self.immersion, where)

    def __repr__(self) -> str:
        k = self.dimension
        return f"<{type(self).__name__} in R{'⁰¹²³⁴⁵⁶⁷⁸⁹'[k] if k < 10 else k} on {self.domain}>"

    def __call__(self, u: ArrayLike, v: ArrayLike) -> Floats:
        """(..., k) points φ(u, v)."""
        a, b, shape = self._door(u, v)
        points = self.immersion.points(a, b)
        checks.require_finite(points, a, b)
        return points.reshape(*shape, *points.shape[1:])

    @property
    def dimension(self) -> int:
        """Number of coordinates k."""
        return len(self._extremes[0])

    @property
    def size(self) -> float:
        """Diagonal of the box around samples of the surface, a length."""
        low, high = self._extremes
        with np.errstate(over="ignore"):  # told by require_range
            return float(np.hypot.reduce(high - low))  # no square that is too small for floats

    # ---------------------------------------------------------------- first order

    def jacobian(self, u: ArrayLike, v: ArrayLike) -> Floats:
        """(..., k, 2) derivatives of φ: the columns are ∂φ/∂u and ∂φ/∂v."""
        a, b, shape = self._door(u, v)
        tangents = self.immersion.tangents(a, b)
        checks.require_derivatives(tangents, a, b)
        return tangents.reshape(*shape, *tangents.shape[1:])

    def first_fundamental_form(self, u: ArrayLike, v: ArrayLike) -> Floats:
        r"""(..., 2, 2) form :math:`I_{ij} = \langle\partial_i\varphi, \partial_j\varphi\rangle`.

        Definition 2, in any dimension k. It is positive definite where φ is an immersion, and
        singular at a pole. Unit: length² over the units of the parameters.

        Chapter items: D2.
        """
        return forms.metric(self.jacobian(u, v))

    def area_element(self, u: ArrayLike, v: ArrayLike) -> Floats:
        """(...,) sqrt(g) with g = det I: area on the surface for area in the domain."""
        return forms.area_element(self.jacobian(u, v))

    def is_isometric(self, other: Chart | None = None, tol: float = 1e-9) -> bool:
        """Whether I is that of ``other`` at the same parameters: Id of the plane if None.

        A property of φ, not of the surface (E1): whether the surface is *locally* isometric to
        the plane, in some parameters, is ``is_flat``. Looks at 256 parameters, so True is no proof.

        Chapter items: X1.
        """
        if other is not None:
            checks.require_surface(other)
        u, v = self.domain.samples(SAMPLES)
        mine = self.first_fundamental_form(u, v)
        wanted = np.eye(2) if other is None else other.first_fundamental_form(u, v)
        return bool(np.abs(mine - wanted).max() <= tol * np.abs(mine).max())

    def is_conformal(self, tol: float = 1e-9) -> bool:
        """Whether I = λ(u, v) Id with λ > 0, so that angles are kept, at 256 parameters.

        Lengths are then scaled by sqrt(λ) and areas by λ (E1).

        Chapter items: X1.
        """
        g = self.first_fundamental_form(*self.domain.samples(SAMPLES))
        factor = np.trace(g, axis1=1, axis2=2) / 2
        off = np.abs(g - factor[:, None, None] * np.eye(2)).max(axis=(1, 2))
        return bool((factor > 0).all() and (off <= tol * factor).all())

    # ---------------------------------------------------------------- functions

    def pullback(self, f: Map) -> Map:
        r"""Return :math:`\bar f = f \circ \varphi`, a function of (u, v), of one of x_1, ..., x_k.

        (The chapter, l. 642, composes the other way round: E83.) f is C^α on the surface if
        f̄ is on the domain. It can be differentiated where f and φ can.

        Chapter items: P65.
        """
        checks.require_callable(f, "f")

        def fbar(u: Any, v: Any) -> Any:
            if isinstance(u, Jet) or isinstance(v, Jet):
                return call_at_points(f, self.immersion.coordinates(u, v))
            return call_at_points(f, np.moveaxis(self(u, v), -1, 0))

        return fbar

    # ---------------------------------------------------------------- curves and meshes

    def trace(self, curve: Map, t: ArrayLike) -> Floats:
        r"""(..., k) points :math:`\bar\gamma(t) = \varphi(\gamma(t))` of a curve t -> (u, v).

        Chapter items: P2.
        """
        return curves.trace(self, curve, t)

    def curve_length(
        self,
        curve: Map,
        start: float = 0.0,
        end: float = 1.0,
        *,
        route: str = "intrinsic",
        pieces: int = 256,
    ) -> float:
        r"""Length of the curve :math:`t \mapsto \gamma(t) = (u, v)`, by either route (l. 31, E3).

        ``"intrinsic"``: :math:`\int \sqrt{\gamma'^T I \gamma'}\,dt`, with γ written with numpy,
        by 8 nodes on each piece. ``"extrinsic"``: of the polyline of φ(γ(t)) in Rᵏ with this
        many pieces, which is shorter by O(pieces⁻²).

        Chapter items: U1.

        Examples
        --------
        >>> plane = Chart(lambda r, t: (r * np.cos(t), r * np.sin(t)),
        ...               ((0, 2), (0, 2 * np.pi)), periodic=(False, True))
        >>> round(plane.curve_length(lambda t: (1 + 0 * t, 2 * np.pi * t)) / np.pi, 12)
        2.0
        """
        return curves.length(self, curve, start, end, route, pieces)

    def mesh(self, nu: int, nv: int) -> Mesh:
        """Mesh the surface by nu cells along u and nv along v, each cut in two.

        Periodic sides become a seam, closed straight or, where the surface comes back mirrored
        (Möbius's band, Klein's bottle), with a flip; then the mesh has no orientation. A side
        that φ maps to one point becomes one vertex, with a fan of triangles. Faces are
        counter-clockwise in (u, v): their normals are along ∂φ/∂u x ∂φ/∂v. On a ``Disk`` there
        are nv rings of triangles, the outermost with nu vertices.

        ``vertex_data["parameters"]`` holds the (n, 2) parameters of the vertices.

        Chapter items: D1.

        Raises
        ------
        SurfaceError
            If periodic sides do not meet, or the cells are too few to close them; or if faces have
            no area, as where φ is constant along some line that is no side: with the parameters
            of a vertex of each.
        MeshError
            If nu or nv is not a whole number of 1 or more.
        """
        return mesh_chart(self, nu, nv)

    # ---------------------------------------------------------------- checks

    @cached_property
    def _extremes(self) -> tuple[Floats, Floats]:
        """Return the smallest and the largest of each coordinate over samples."""
        u, v = self.domain.samples(SAMPLES)
        points = self.immersion.points(u, v)
        if points.shape[1] < 2:
            raise DimensionError("φ returned 1 coordinate where 2 or more are needed")
        checks.require_finite(points, u, v)
        return points.min(axis=0), points.max(axis=0)

    def _door(self, u: ArrayLike, v: ArrayLike) -> tuple[Floats, Floats, tuple[int, ...]]:
        a, b, shape = checks.broadcast(u, v)
        checks.require_inside(self.domain, a, b)
        return a, b, shape
