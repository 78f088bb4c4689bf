"""Maps to the plane against libigl, where it is installed."""

import numpy as np
import pytest

from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import icosphere, torus
from beltrami.parameterization.boundary import place_boundary
from beltrami.parameterization.certificate import certify
from beltrami.parameterization.conformal import least_squares_conformal
from beltrami.parameterization.distortion import distortion
from beltrami.parameterization.harmonic import harmonic
from beltrami.parameterization.parameterize import parameterize
from made_once import creature
from meshes_of_the_errata import bad, cur, open_

igl = pytest.importorskip("igl")


def arrays(mesh):
    x = np.pad(mesh.vertices, ((0, 0), (0, 3 - mesh.dimension)))
    return np.asfortranarray(x), np.asfortranarray(mesh.faces.astype(np.int32))


@pytest.mark.chapter("U39", "P72")
@pytest.mark.parametrize("make", [open_, cur, bad], ids=lambda make: make.__name__)
def test_harmonic_maps_are_the_same(make):
    mesh = make()
    x, faces = arrays(mesh)
    (loop,) = mesh.boundary_loops
    np.testing.assert_array_equal(np.sort(igl.boundary_loop(faces)), np.sort(loop))
    placed = place_boundary(mesh, loop)
    theirs = igl.harmonic(x, faces, loop.astype(np.int32), placed, 1)
    np.testing.assert_allclose(harmonic(mesh, loop, placed, "cotangent"), theirs, atol=1e-12)


@pytest.mark.chapter("P73")
def test_the_circle_by_arc_length_is_the_same():
    mesh = cur()
    (loop,) = mesh.boundary_loops
    theirs = igl.map_vertices_to_circle(arrays(mesh)[0], loop.astype(np.int32))
    np.testing.assert_allclose(place_boundary(mesh, loop), theirs, atol=1e-12)


@pytest.mark.chapter("P76")
@pytest.mark.parametrize("make", [open_, cur, bad], ids=lambda make: make.__name__)
def test_least_squares_conformal_maps_are_the_same(make):
    mesh = make()
    x, faces = arrays(mesh)
    ends = np.array([0, mesh.n_vertices // 2])
    ours = least_squares_conformal(mesh, ends)
    theirs = igl.lscm(x, faces, ends.astype(np.int32), np.asfortranarray(ours[ends]))[0]
    np.testing.assert_allclose(ours, theirs, atol=1e-9)


@pytest.mark.chapter("P74")
@pytest.mark.parametrize(
    "make",
    [
        lambda: torus(24, 16),
        lambda: creature(1500),
        lambda: Mesh(icosphere(3).vertices, icosphere(3).faces[1:]),
    ],
    ids=["torus", "creature", "sphere less a triangle"],
)
def test_free_boundaries_are_as_good_as_slim(make):
    """From the same start, 20 steps of SLIM; ours is proven to be a bijection."""
    mesh = make()
    start, ours = parameterize(mesh), parameterize(mesh, "free")
    x, faces = arrays(start.mesh)
    unit = np.sqrt(mesh.area)
    held = np.zeros(0, np.int32), np.asfortranarray(np.zeros((0, 2)))
    (energy,) = (e for e in igl.MappingEnergyType if str(e).endswith(".SYMMETRIC_DIRICHLET"))
    begin = np.asfortranarray(start.uv * np.sqrt(1 / np.pi))
    data = igl.slim_precompute(x / unit, faces, begin, energy, *held, 0.0)
    theirs = np.array(igl.slim_solve(data, 20))[:, :2]
    assert ours.is_bijective
    reached = distortion(start.mesh, theirs).symmetric_dirichlet
    assert ours.distortion.symmetric_dirichlet < 1.001 * reached
    assert len(certify(start.mesh.topology, theirs).flipped) == 0
