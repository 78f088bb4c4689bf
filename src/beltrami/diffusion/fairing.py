"""Fairing of the small faces of a denoised mesh, whose normals the error that is left spoils."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array, eye_array

from beltrami._arrays import Floats
from beltrami.mesh.edge_matrix import laplacian_matrix
from beltrami.mesh.mesh import Mesh
from beltrami.solvers.conjugate_gradients import conjugate_gradients

_REACH = 1.2  # errors: the length that fairing has
_LONGEST = 0.15  # mean edges, beyond which it would bend the shape
_SHORT = 20.0  # errors: if all edges are longer, their faces are large enough
_POWER = 1.5  # of 1/length: with 1 more is bent, with 2 more slides
_TOLERANCE = 1e-9  # of the solver


def faired(mesh: Mesh, error: float) -> Floats:
    r"""Even out what is shorter than the error of the positions.

    An error e of the positions turns the normal of a face of the size h by about e/h: where the
    sampling is uneven, most of the error of the normals is in the small faces, which the positions
    hardly know of. The result x makes :math:`|x - y|^2 + |L x|^2` least, y the positions of the
    mesh: an implicit step of the bi-Laplacian, :math:`(Id + L^2) x = y`, with the weights

    .. math:: w_{ij} = (1 + |y_i - y_j|^2 / r^2)^{-3/4}

    and r = 1.2 e. Long edges hardly weigh anything, so nothing moves there; small faces become as
    even as they can, in shape too: to slide so little costs less than it gains.

    Parameters
    ----------
    mesh
        In space.
    error
        e >= 0, in the unit of length. If it is large, r is 0.15 mean edges. If no edge is shorter
        than 20 e, nothing moves.

    Returns
    -------
    (n, 3); vertices of no edge stay. Cost: O(n) for each of some ten steps of conjugate gradients.

    Notes
    -----
    The implicit step is that of Desbrun, Meyer, Schröder and Barr 1999, with the square of L.

    Examples
    --------
    >>> from beltrami.mesh.shapes import grid
    >>> flat = grid(30, 30, dimension=3)
    >>> x = flat.vertices ** [3, 3, 1]  # small faces near the origin
    >>> small = (x < 0.04).all(axis=1)
    >>> x[:, 2] = 0.003 * np.random.default_rng(0).standard_normal(len(x))
    >>> z = faired(flat.with_vertices(x), 0.003)[:, 2]
    >>> [round(float(part.std()), 4) for part in (z[small], z[~small])]
    [0.0014, 0.0025]
    """
    lengths = mesh.edge_lengths
    r = min(_REACH * error, _LONGEST * float(lengths.mean())) if len(lengths) else 0.0
    if not r > 0 or float(lengths.min()) > _SHORT * error:
        return mesh.vertices
    weights = np.asarray((r / np.hypot(r, lengths)) ** _POWER)  # hypot: squares might overflow
    L = laplacian_matrix(mesh.edges, weights, mesh.n_vertices)
    system = csr_array(eye_array(mesh.n_vertices, format="csr") + L @ L)
    force = -(L @ (L @ mesh.vertices))
    moved = conjugate_gradients(system, force, tolerance=_TOLERANCE, kernel=None).solution
    return np.asarray(mesh.vertices + moved)
