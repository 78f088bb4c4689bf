"""Noise for the chapters that remove it."""

from __future__ import annotations

import numpy as np

from beltrami.mesh.mesh import Mesh

SEED = 871_204_663


def with_noise(mesh: Mesh, level: float) -> Mesh:
    """Move the vertices along their normals by white noise, its level in mean edges."""
    scale = level * float(mesh.edge_lengths.mean())
    noise = np.random.default_rng(SEED).normal(scale=scale, size=(mesh.n_vertices, 1))
    return mesh.with_vertices(mesh.vertices + noise * mesh.vertex_normals)
