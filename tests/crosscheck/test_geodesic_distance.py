"""Distances against libigl (exact) and potpourri3d (heat method)."""

import numpy as np
import pytest

from beltrami.geodesics.distance import geodesic_distance
from beltrami.mesh.shapes import blob, torus
from meshes_of_the_errata import IRREGULAR, MESHES
from surfaces_to_walk_on import maze

SURFACES = {name: MESHES[name] for name in (*IRREGULAR, "tor", "pl")} | {
    "maze": maze,
    "rough maze": lambda: maze(0.1),
    "torus": lambda: torus(40, 20),
    "blob": lambda: blob(3000),
}


def _arrays(mesh):
    V = np.pad(mesh.vertices, ((0, 0), (0, 3 - mesh.dimension)))
    return np.ascontiguousarray(V), np.array(mesh.faces)


@pytest.mark.parametrize("name", SURFACES)
def test_exact_distances_against_libigl(name):
    igl = pytest.importorskip("igl")
    mesh = SURFACES[name]()
    none, targets = np.zeros(0, np.int64), np.arange(mesh.n_vertices)
    for sources in ([0], [3, mesh.n_vertices // 2]):
        expected = igl.exact_geodesic(*_arrays(mesh), np.array(sources), none, targets, none)
        ours = geodesic_distance(mesh, sources, method="exact")
        assert np.allclose(ours, expected, rtol=0, atol=1e-12 * expected.max())


@pytest.mark.parametrize("name", ["obt", "open", "cur", "torus", "blob"])
def test_heat_distances_against_potpourri3d(name):
    """Its vertex areas are barycentric and its shift is another, so it is near, not equal."""
    pp3d = pytest.importorskip("potpourri3d")
    mesh = SURFACES[name]()
    expected = pp3d.MeshHeatMethodDistanceSolver(*_arrays(mesh)).compute_distance(0)
    ours = geodesic_distance(mesh, 0, intrinsic=True)
    difference = (ours - ours.mean()) - (expected - expected.mean())
    assert np.abs(difference).max() < 0.05 * expected.max()
