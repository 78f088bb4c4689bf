"""The heat method: distances along the surface by two linear solves (Crane et al. 2013)."""

from __future__ import annotations

import math
import numbers
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.sparse import csr_array

from beltrami._arrays import Booleans, Floats, Integers
from beltrami._frozen import Frozen
from beltrami._jit import kernel
from beltrami._kinds import require_kind
from beltrami.errors import BeltramiError, ConvergenceError, check_name, shown
from beltrami.geodesics.sources import checked_sources
from beltrami.mesh.connectivity import component_labels
from beltrami.mesh.door import require_mesh
from beltrami.mesh.mesh import Mesh
from beltrami.operators.bounds import side_weights
from beltrami.operators.intrinsic import IntrinsicTriangulation
from beltrami.operators.laplacian import laplacian
from beltrami.solvers.factor import Factor
from beltrami.solvers.factorize import factorize

BOUNDARIES = ("neumann", "average")
_COLD = 1e-290  # less heat than this has lost its digits
_LOST = 1e15  # times the mass: beside so much stiffness it is rounded away


class HeatMethod(Frozen):
    r"""Distances from any sources of one mesh, prepared once.

    1. Let heat spread from the sources for a short time t: :math:`(B + tL) u = \delta`.
    2. Turn its gradient into unit vectors, :math:`X = -\nabla u / |\nabla u|` in each face.
    3. Find the function with the gradient nearest to X: :math:`L \varphi = -\mathrm{div} X`.

    Parameters
    ----------
    mesh
        Any sound mesh, closed or open, of one or several components, in any dimension.
    time
        t, in length². Default: the square of the mean length of an edge. Longer times round the
        distance off; beyond about 700 √t from the sources no heat is left.
    intrinsic
        Use the triangles of ``intrinsic_delaunay``; on a mesh with boundary, edges of more than
        two faces or one side, those of its cover. Without, heat with negative weights may flow
        the wrong way where faces are obtuse, above all from a source on the boundary.
    boundary
        ``"neumann"``: no heat leaves through the boundary, which the lines of equal distance
        meet at a right angle. ``"average"``: the mean of this and of a boundary kept cold, which
        takes that off (section 3.2 of the paper); the same on closed meshes.

    Raises
    ------
    EmptyMeshError, NonFiniteError, DegenerateFaceError, UnreferencedVertexError
        If the mesh is not sound.
    UnknownNameError, BeltramiError
        If the name of the boundary is none, or the time is not positive.

    Notes
    -----
    Cost: two factorisations (three with a cold boundary), then two solves for each call.

    Examples
    --------
    >>> from beltrami.mesh.shapes import icosphere
    >>> sphere = icosphere(3)
    >>> method = HeatMethod(sphere)
    >>> south = int(sphere.vertices[:, 2].argmin())
    >>> angle = np.arccos(np.clip(sphere.vertices @ sphere.vertices[south], -1, 1))
    >>> bool(abs(method.distance(south) - angle).max() < 0.06)
    True
    """

    mesh: Mesh
    time: float
    intrinsic: bool
    boundary: str

    def __init__(
        self,
        mesh: Mesh,
        *,
        time: float | None = None,
        intrinsic: bool = True,
        boundary: str = "neumann",
    ) -> None:
        check_name("boundary", boundary, BOUNDARIES)
        require_mesh(mesh, "the heat method")
        require_kind("intrinsic", intrinsic, ("bool",))
        pair = laplacian(mesh, _weights(mesh, intrinsic), "voronoi")
        triangles = pair.domain if isinstance(pair.domain, IntrinsicTriangulation) else mesh
        t = _mean_edge(triangles) ** 2 if time is None else _checked_time(time)
        if not t * float(pair.stiffness.data.max()) < _LOST * float(pair.masses.max()):
            raise BeltramiError(f"in a time of {t:.6g} all heat is spread evenly, as numbers go")
        if isinstance(triangles, Mesh):
            halves, areas = side_weights(mesh, np.zeros(0), "cotangent"), mesh.face_areas
        else:
            halves, areas = triangles.half_cotangents, triangles.area_parts
        labels = component_labels(pair.edges, pair.n)
        free = np.ones(pair.n, np.bool_)
        free[np.unique(labels, return_index=True)[1]] = False  # L is singular: fix one value each
        step = csr_array(pair.mass + t * pair.stiffness)
        cold = boundary == "average"
        inner = ~mesh.topology.on_boundary if cold else np.ones(pair.n, np.bool_)
        self.__dict__.update(
            mesh=mesh,
            time=t,
            intrinsic=intrinsic,
            boundary=boundary,
            _faces=triangles.faces,
            _halves=halves,
            _areas=areas,
            _labels=labels,
            _free=free,
            _inner=inner,
            _heat=factorize(step, mesh.vertices),
            _cold=None if inner.all() or not inner.any() else _restricted(step, inner, mesh),
            _poisson=_restricted(pair.stiffness, free, mesh),
        )

    _faces: Integers
    _halves: Floats
    _areas: Floats
    _labels: Integers
    _free: Booleans
    _inner: Booleans
    _heat: Factor
    _cold: Factor | None
    _poisson: Factor

    def __repr__(self) -> str:
        kind = "intrinsic" if self.intrinsic else "given"
        return f"<HeatMethod: {len(self._free)} vertices, {kind} triangles, time {self.time:.6g}>"

    def distance(self, sources: ArrayLike) -> Floats:
        """Return the (n,) distances from the nearest source; infinite where none can be reached.

        In each component the smallest value at a source is 0. The method is approximate, of
        first order in the length of the edges; values next to the sources may come out below 0.

        Raises
        ------
        MeshError
            If there are no sources, or they are not vertices.
        ConvergenceError
            If some faces are so far away that no heat arrives in the numbers of the machine.
        """
        places = checked_sources(sources, len(self._free))
        base = np.full(int(self._labels.max()) + 1, np.inf)
        base[self._labels[places]] = 0
        flux, frozen = _unit_flux(
            self._faces, self._halves, self._areas, self._spread(places), base[self._labels] == 0
        )
        if frozen:
            raise ConvergenceError(
                f"no heat arrives at {frozen} faces in the time {self.time:.6g}: give a longer "
                f"time, or use method='exact'"
            )
        phi = np.zeros(len(self._free))
        phi[self._free] = self._poisson.solve(-flux[self._free])
        base[self._labels[places]] = np.inf
        np.minimum.at(base, self._labels[places], phi[places])
        reached = np.isfinite(base)[self._labels]
        return np.where(reached, phi - np.where(reached, base[self._labels], 0), np.inf)

    def _spread(self, places: Integers) -> Floats:
        """Return the heat after the time t, of one unit at each source."""
        delta = np.zeros(len(self._free))
        delta[places] = 1
        heat = self._heat.solve(delta)
        if self._cold is not None:
            heat[self._inner] += self._cold.solve(delta[self._inner])
        return heat


def _checked_time(time: float) -> float:
    if isinstance(time, numbers.Real) and math.isfinite(time) and time > 0:
        return float(time)
    raise BeltramiError(f"the time of the heat method must be positive, not {shown(time)}")


def _weights(mesh: Mesh, intrinsic: bool) -> str:
    """Name the weights: those of the cover where the surface alone leaves negative ones."""
    if not intrinsic:
        return "cotangent"
    topology = mesh.topology
    plain = topology.is_closed and topology.is_edge_manifold and topology.is_orientable
    return "intrinsic_delaunay" if plain else "tufted"


def _restricted(matrix: csr_array, kept: Booleans, mesh: Mesh) -> Factor:
    return factorize(csr_array(matrix[kept][:, kept]), mesh.vertices[kept])


def _mean_edge(triangles: Mesh | IntrinsicTriangulation) -> float:
    """Return the mean length of the edges, each counted once."""
    if isinstance(triangles, Mesh):
        return float(triangles.edge_lengths.mean())
    numbers = triangles.side_edges.ravel()
    lengths = np.empty(int(numbers.max()) + 1)
    lengths[numbers] = triangles.lengths.ravel()
    return float(lengths.mean())


# In one face with the stiffness L_f, <L_f u, u> is |∇u|² times its area; and since the integral
# of <∇u, ∇v> is <L_f u, v>, what X = -∇u / |∇u| gives to the corners is -L_f u / |∇u|. So the
# method needs no vectors, and holds for triangles that know lengths only.


@kernel
def _unit_flux(faces: Any, halves: Any, areas: Any, u: Any, reached: Any) -> Any:
    """Sum L_f u / |∇u| over the faces; count those that were reached and yet are cold."""
    flux = np.zeros(u.size)
    frozen = 0
    for f in range(faces.shape[0]):
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        if not reached[i]:
            continue
        if max(abs(u[i]), abs(u[j]), abs(u[k])) < _COLD:
            frozen += 1
            continue
        a, b, c = u[k] - u[j], u[i] - u[k], u[j] - u[i]
        scale = max(abs(a), abs(b), abs(c))
        if scale == 0:
            continue  # a flat top: no direction
        a, b, c = a / scale, b / scale, c / scale  # squares of little heat would be zero
        p, q, r = halves[f, 0], halves[f, 1], halves[f, 2]
        energy = p * a * a + q * b * b + r * c * c
        if not energy > 0:
            continue
        slope = (energy / areas[f]) ** 0.5
        flux[i] += (q * b - r * c) / slope
        flux[j] += (r * c - p * a) / slope
        flux[k] += (p * a - q * b) / slope
    return flux, frozen
