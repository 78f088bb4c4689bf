"""Gauss-Bonnet: defects inside and turnings on the boundary add to 2πχ (l. 35 of the chapter)."""

import numpy as np
import pytest
from hypothesis import given

import strategies
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import cylinder, torus
from beltrami.operators.curvature import curvature
from meshes_of_the_errata import MESHES

pytestmark = pytest.mark.chapter("P3")


def _without_faces(mesh, drop):
    kept = np.delete(mesh.faces, drop, axis=0)
    return Mesh(mesh.vertices, kept)


CASES = {
    "closed": (MESHES["closed"], 2),
    "obt": (MESHES["obt"], 2),
    "open": (MESHES["open"], 1),
    "bad": (MESHES["bad"], 1),
    "cur": (MESHES["cur"], 1),
    "tor": (MESHES["tor"], 0),
    "annulus": (lambda: cylinder(20, 7), 0),
    "torus with a hole": (lambda: _without_faces(torus(20, 12), [0]), -1),
    "sphere with two holes": (lambda: _without_faces(MESHES["closed"](), [0, 300]), 0),
}


@pytest.mark.parametrize("name", CASES)
def test_total(name):
    make, chi = CASES[name]
    mesh = make()
    found = curvature(mesh)
    total = found.angle_defect.sum() + found.turning.sum()
    assert mesh.euler_characteristic == chi
    assert total == pytest.approx(2 * np.pi * chi, abs=1e-10)
    boundary = np.unique(mesh.topology.boundary_edges)
    if len(boundary):  # with 2π at the boundary too it would be off by π for each vertex there
        assert abs(total + np.pi * len(boundary) - 2 * np.pi * chi) > 3
        inside = np.delete(found.turning, boundary)
        assert not inside.any()
        assert not found.angle_defect[boundary].any()


@given(strategies.arrays(strategies.hull, strategies.sheet, strategies.ring_torus))
def test_any_clean_mesh(pair):
    points, faces = pair
    used, faces = np.unique(faces, return_inverse=True)
    mesh = Mesh(points[used], faces.reshape(-1, 3))
    found = curvature(mesh)
    total = found.angle_defect.sum() + found.turning.sum()
    assert total == pytest.approx(2 * np.pi * mesh.euler_characteristic, abs=1e-9)
