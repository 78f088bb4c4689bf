"""A mesh, and what calls of the library need besides it: each is made once, when it is asked for.

What the mesh is not fit for raises a ``BeltramiError`` here already, as it does to a user.
"""

from __future__ import annotations

import itertools
import tempfile
import weakref
from functools import cached_property
from pathlib import Path

import numpy as np

import beltrami as bt

PAIRS = (
    ("cotangent", "voronoi"),
    ("combinatorial", "degree"),
    ("tufted", "voronoi"),
    ("distance", "unit"),
    ("intrinsic_delaunay", "barycentric"),
    ("cotangent", "consistent"),
    ("clamped", "barycentric"),
)


class Scene:
    """A mesh and random companions; the same seed gives the same."""

    def __init__(self, mesh, seed=0, pair=("cotangent", "voronoi")):
        self.mesh, self.seed, self.kinds = mesh, seed, pair
        self.n = mesh.n_vertices
        self._count = itertools.count()
        self._folder = tempfile.TemporaryDirectory()
        weakref.finalize(self, self._folder.cleanup)

    def rng(self):
        return np.random.default_rng(self.seed)

    def path(self, name):
        """A place for a file that no other call uses."""
        folder = Path(self._folder.name, str(next(self._count)))
        folder.mkdir()
        return folder / name

    @cached_property
    def f(self):
        return self.rng().normal(size=self.n)

    @cached_property
    def fields(self):
        return self.rng().normal(size=(self.n, 2))

    @cached_property
    def pair(self):
        return bt.laplacian(self.mesh, *self.kinds)

    @cached_property
    def time(self):
        """A time of the scale of the mesh."""
        return 3 / self.pair.spectral_bound()

    @cached_property
    def basis(self):
        return bt.fourier_basis(self.pair, min(6, self.n))

    @cached_property
    def matrix(self):
        """A positive definite matrix."""
        return (self.pair.stiffness / self.pair.spectral_bound() + self.pair.mass).tocsr()

    @cached_property
    def factor(self):
        return bt.factorize(self.matrix)

    @cached_property
    def held(self):
        return np.arange(min(2, self.n))

    @cached_property
    def map(self):
        return bt.parameterize(self.mesh, strict=False)

    @cached_property
    def same(self):
        return bt.functional_map_from_points(self.basis, self.basis, np.arange(self.n))

    @cached_property
    def heat_method(self):
        return bt.HeatMethod(self.mesh)

    @cached_property
    def frame(self):
        return bt.meyer_frame(self.pair.spectral_bound(), 2)

    @cached_property
    def compressed(self):
        return bt.compress(self.mesh, bits=8, effort="fast")

    @cached_property
    def grid(self):
        return bt.Grid((3 + self.seed % 4, 4), periodic=self.seed % 2 == 0)

    @cached_property
    def on_grid(self):
        return self.rng().normal(size=self.grid.n_vertices)

    @cached_property
    def surface(self):
        big = 1 + self.rng().random()
        return bt.ParametricSurface(
            lambda u, v: (
                (big + np.cos(v) / 2) * np.cos(u),
                (big + np.cos(v) / 2) * np.sin(u),
                np.sin(v) / 2,
            ),
            ((0, 2 * np.pi), (0, 2 * np.pi)),
            periodic=(True, True),
        )

    @cached_property
    def atlas(self):
        return bt.Atlas([self.surface])

    @cached_property
    def uv(self):
        return self.rng().random((3, 2))
