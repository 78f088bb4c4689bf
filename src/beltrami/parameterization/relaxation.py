"""Relaxation: a bijection with a free boundary, as isometric as it gets, no fold on the way."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from beltrami._arrays import Floats
from beltrami.mesh.mesh import Mesh
from beltrami.parameterization.crossings import crossings
from beltrami.parameterization.distortion import measured, slopes
from beltrami.parameterization.predicates import orientation
from beltrami.solvers.factorize import factorize

_SETTLED = 1e-4  # relative decrease of the energy at which it stops
_SHORTEST = 1e-8  # of a step, before it is given up
_SHIFT = 1e-9  # of the Hessian, over its mean diagonal: moving and turning cost nothing


def relax(mesh: Mesh, uv: Floats, steps: int) -> tuple[Floats, int]:
    r"""Lower the symmetric Dirichlet energy of a bijection of a disk; return it and the steps.

    The energy :math:`\sum_f A_f (\sigma_1^2 + \sigma_2^2 + \sigma_1^{-2} + \sigma_2^{-2})` is
    infinite where a face collapses. Each step is one of Newton, with the Hessian of each face
    projected to the semi-definite matrices by its known eigenvectors (B. Smith, F. de Goes, T.
    Kim, Analytic eigensystems for isotropic distortion energies, 2019). It is shortened so that
    no face turns over (J. Smith, S. Schaefer, Bijective parameterization with free boundaries,
    2015), the boundary does not cross itself, both decided exactly, and the energy falls.

    Parameters
    ----------
    mesh
        A disk of n vertices.
    uv
        (n, 2) a bijection to start from.
    steps
        How many, at most; it stops when the energy falls by less than 1e-4 of itself.

    Returns
    -------
    (n, 2) positions, in the unit of length of the mesh, and the number of steps. What folds at
    the start is only scaled.
    """
    size = float(np.sqrt(mesh.area))
    g = slopes(mesh) * size
    areas = mesh.face_areas / mesh.area
    x = uv / _best_scale(mesh, uv) / size
    energy = _energy(g, areas, x[mesh.faces])
    done = 0
    while done < steps and np.isfinite(energy):
        gradient, hessian = _derivatives(mesh, g, areas, x)
        ends = np.repeat(mesh.vertices, 2, axis=0)
        direction = factorize(hessian, ends).solve(-gradient).reshape(-1, 2)
        slope = float((gradient.reshape(-1, 2) * direction).sum())
        found = _shortened(mesh, g, areas, x, energy, direction, slope)
        if found is None:
            break
        done += 1
        decrease = (energy - found[1]) / energy
        x, energy = found
        if decrease < _SETTLED:
            break
    return x * size, done


def _best_scale(mesh: Mesh, uv: Floats) -> float:
    """Return by how much the map is too large: the energy is least for uv over it."""
    squares = measured(mesh, uv).singular_values ** 2
    areas = mesh.face_areas
    with np.errstate(divide="ignore", over="ignore"):
        ratio = (areas @ squares.sum(axis=1)) / (areas @ (1 / squares).sum(axis=1))
    return float(ratio**0.25) if ratio > 0 else 1.0


def _jacobians(g: Floats, corners: Floats) -> Floats:
    """Return the (m, 2, 2) matrices J[i, p], coordinate i along direction p."""
    sides = corners[:, 1:] - corners[:, :1]
    return np.einsum("fci,fcp->fip", sides, g[:, 1:])


def _energy(g: Floats, areas: Floats, corners: Floats) -> float:
    """Return the energy over 4: 1 for an isometry; infinite if a face is turned over."""
    J = _jacobians(g, corners)
    squares = (J**2).sum(axis=(1, 2))
    determinant = J[:, 0, 0] * J[:, 1, 1] - J[:, 0, 1] * J[:, 1, 0]
    if not (determinant > 0).all():
        return np.inf
    with np.errstate(over="ignore"):
        return float(areas @ (squares * (1 + 1 / determinant**2))) / 4


def _derivatives(mesh: Mesh, g: Floats, areas: Floats, x: Floats) -> tuple[Floats, csr_array]:
    """Return the gradient (2n,) of the energy times 4, and its projected Hessian."""
    U, s, V = np.linalg.svd(_jacobians(g, x[mesh.faces]))
    first, second = 2 * s - 2 * s**-3, 2 + 6 * s**-4
    P = np.einsum("fik,fk,fkp->fip", U, first, V)
    twist = (first[:, 0] + first[:, 1]) / (s[:, 0] + s[:, 1])
    third = s[:, 0] * s[:, 1]
    flip = 2 + 2 * (s[:, 0] ** 2 + third + s[:, 1] ** 2) / third**3  # quotient of differences
    root = np.sqrt(0.5)
    modes = np.array(
        [[[1, 0], [0, 0]], [[0, 0], [0, 1]], [[0, -root], [root, 0]], [[0, root], [root, 0]]]
    )
    curved = np.stack([second[:, 0], second[:, 1], np.maximum(twist, 0), flip], axis=1)
    D = np.einsum("fik,ekl,flp->feip", U, modes, V)
    on_corners = np.einsum("fcp,feip->feci", g, D).reshape(len(g), 4, 6)
    blocks = np.einsum("feu,fe,fev->fuv", on_corners, curved * areas[:, None], on_corners)
    unknowns = (2 * mesh.faces[:, :, None] + np.arange(2)).reshape(-1, 6)
    size = 2 * mesh.n_vertices
    rows, columns = np.repeat(unknowns, 6, axis=1), np.tile(unknowns, (1, 6))
    H = csr_array((blocks.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size))
    H = (H + H.T) / 2
    shift = _SHIFT * H.diagonal().mean()
    diagonal = np.arange(size)
    H = csr_array(H + csr_array((np.full(size, shift), (diagonal, diagonal)), shape=(size, size)))
    pull = np.einsum("fip,fcp,f->fci", P, g, areas).reshape(-1, 6)
    gradient = np.bincount(unknowns.ravel(), pull.ravel(), size)
    return np.asarray(gradient, dtype=np.float64), H


def _shortened(
    mesh: Mesh,
    g: Floats,
    areas: Floats,
    x: Floats,
    energy: float,
    direction: Floats,
    slope: float,
) -> tuple[Floats, float] | None:
    """Return the positions after the longest allowed of the steps tried, and their energy."""
    step = min(1.0, 0.9 * _first_collapse(x[mesh.faces], direction[mesh.faces]))
    edges = mesh.topology.boundary_edges
    while step > _SHORTEST:
        moved = x + step * direction
        new = _energy(g, areas, moved[mesh.faces])
        if new < energy + 1e-4 * step * slope / 4:
            a, b, c = moved[mesh.faces].transpose(1, 0, 2)
            if (orientation(a, b, c) > 0).all() and not len(crossings(moved, edges)):
                return moved, new
        step /= 2
    return None


def _first_collapse(x: Floats, d: Floats) -> float:
    """Return the smallest t > 0 at which a face of the corners x + t d has no area.

    The area is a quadratic polynomial c + bt + at² with c > 0.
    """
    u, v = x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]
    p, q = d[:, 1] - d[:, 0], d[:, 2] - d[:, 0]
    c = _cross(u, v)
    b = _cross(u, q) + _cross(p, v)
    a = _cross(p, q)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        root = np.sqrt(b * b - 4 * a * c)
        t = 2 * c / (-b + root)  # the form without cancellation where b < 0
        other = 2 * c / (-b - root)
    times = np.concatenate([t, other])
    times = times[np.isfinite(times) & (times > 0)]
    return float(times.min()) if len(times) else np.inf


def _cross(u: Floats, v: Floats) -> Floats:
    return np.asarray(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
