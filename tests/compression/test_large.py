"""A million vertices: there and back, in memory that grows with them."""

import sys

import numpy as np
import pytest

import beltrami as bt
from beltrami.mesh.mesh import Mesh

KIB = 1 if sys.platform == "darwin" else 1024  # bytes of a unit of ru_maxrss


@pytest.mark.heavy
@pytest.mark.parametrize(("mode", "bits"), [("grid", 14), ("spectral", 7)])
def test_a_million_vertices(mode, bits):
    resource = pytest.importorskip("resource")
    torus = bt.shapes.torus(1000, 1000)
    x = torus.vertices
    x = x * (1 + 0.02 * np.sin(40 * x[:, :1]) * np.sin(37 * x[:, 1:2]) * np.cos(23 * x[:, 2:]))
    shuffle = np.random.default_rng(0).permutation(len(x))
    mesh = Mesh(x[shuffle], np.argsort(shuffle)[torus.faces])
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * KIB
    data = bt.compress(mesh, bits=bits, mode=mode, effort="fast", verify=False)
    back = bt.decompress(data)
    more = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * KIB - before
    order = bt.vertex_order(mesh)
    step = np.ptp(x, axis=0).max() / (2**bits - 1)
    steps = 0.501 if mode == "grid" else 3.0
    assert abs(back.vertices - mesh.vertices[order]).max() <= steps * step
    assert len(data) < mesh.n_vertices  # 8 bits for a vertex, of 192 and more
    assert more < 1500 * mesh.n_vertices
