"""Fundamental forms, curvature and the Laplacian at a point, from the derivatives of φ.

All are pure functions of a Jacobian (..., k, 2) and a Hessian (..., k, 2, 2) of rank 2.
"""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Floats


def metric(jacobian: Floats) -> Floats:
    """(..., 2, 2) first fundamental form g_ij = <∂_i φ, ∂_j φ> (definition 2)."""
    return np.einsum("...ci,...cj->...ij", jacobian, jacobian)


def area_element(jacobian: Floats) -> Floats:
    """(...,) sqrt(g), g = det I: area of the surface for area of the domain."""
    g = metric(jacobian)
    return np.sqrt(np.maximum(g[..., 0, 0] * g[..., 1, 1] - g[..., 0, 1] ** 2, 0))


def christoffel(jacobian: Floats, hessian: Floats) -> Floats:
    """(..., 2, 2, 2) symbols Γ^m_ij = g^ml <∂_l φ, ∂_ij φ>: the tangent part of the Hessian."""
    products = np.einsum("...cl,...cij->...lij", jacobian, hessian)
    return np.einsum("...ml,...lij->...mij", np.linalg.inv(metric(jacobian)), products)


def normal_bending(jacobian: Floats, hessian: Floats) -> Floats:
    """(..., k, 2, 2) second fundamental form: the part of the Hessian normal to the surface."""
    symbols = christoffel(jacobian, hessian)
    return hessian - np.einsum("...cm,...mij->...cij", jacobian, symbols)


def laplacian(jacobian: Floats, hessian: Floats, slope: Floats, bend: Floats) -> Floats:
    """(...,) Laplace-Beltrami g^ij (∂_ij f - Γ^m_ij ∂_m f) of f with these derivatives in (u, v).

    Definition 16 with its outer derivatives carried out: they fall on f and on the metric, and
    those of the metric are the Christoffel symbols.
    """
    covariant = bend - np.einsum("...mij,...m->...ij", christoffel(jacobian, hessian), slope)
    return np.einsum("...ij,...ij->...", np.linalg.inv(metric(jacobian)), covariant)


def gaussian_curvature(jacobian: Floats, hessian: Floats) -> Floats:
    """(...,) K = (<b_11, b_22> - |b_12|²) / g, by Gauss's equation, in any dimension k."""
    b = normal_bending(jacobian, hessian)
    b11, b12, b22 = b[..., 0, 0], b[..., 0, 1], b[..., 1, 1]
    return ((b11 * b22).sum(-1) - (b12**2).sum(-1)) / area_element(jacobian) ** 2


def mean_curvature_vector(jacobian: Floats, hessian: Floats) -> Floats:
    """(..., k) vector g^ij b_ij / 2 = (Δ φ) / 2, normal to the surface."""
    inverse = np.linalg.inv(metric(jacobian))
    return 0.5 * np.einsum("...ij,...cij->...c", inverse, normal_bending(jacobian, hessian))


def unit_normal(jacobian: Floats) -> Floats:
    """(..., 3) unit vectors along ∂_u φ x ∂_v φ, for k = 3."""
    across = np.cross(jacobian[..., 0], jacobian[..., 1])
    return across / np.linalg.norm(across, axis=-1, keepdims=True)
