"""The pairs of the intrinsic triangles against libigl and robust_laplacian.

On meshes without four vertices on a circle the Delaunay triangulation is unique, so the
matrices agree to rounding; libigl's is -L.
"""

import numpy as np
import pytest

from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import IRREGULAR, MESHES


def _arrays(mesh):
    V = np.pad(mesh.vertices, ((0, 0), (0, 3 - mesh.dimension)))
    return np.ascontiguousarray(V), np.array(mesh.faces)


def _stretched(name):
    mesh = MESHES[name]()
    return mesh.with_vertices(mesh.vertices * np.r_[20, np.ones(mesh.dimension - 1)])


@pytest.mark.parametrize("name", IRREGULAR)
@pytest.mark.parametrize("make", [lambda name: MESHES[name](), _stretched])
def test_stiffness_against_libigl(name, make):
    igl = pytest.importorskip("igl")
    mesh = make(name)
    expected = -igl.intrinsic_delaunay_cotmatrix(*_arrays(mesh))[0]
    ours = laplacian(mesh, "intrinsic_delaunay").stiffness
    assert abs(ours - expected).max() <= 1e-9 * abs(expected).max()


@pytest.mark.parametrize("name", [*IRREGULAR, "leaves"])
def test_cover_against_robust_laplacian(name):
    robust = pytest.importorskip("robust_laplacian")
    mesh = MESHES[name]()
    L, M = robust.mesh_laplacian(*_arrays(mesh), mollify_factor=0)
    ours = laplacian(mesh, "tufted", "barycentric")
    assert abs(ours.stiffness - L).max() <= 1e-9 * abs(L).max()
    assert abs(ours.mass - M).max() <= 1e-12 * abs(M).max()
