"""Holes closed for the time of a map: no cut, the right faces, a certified image with holes."""

import numpy as np
import pytest

from beltrami.errors import NotADiskError, UnknownNameError
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import cylinder, disk, icosphere, torus
from beltrami.parameterization.certificate import certify
from beltrami.parameterization.holes import fill_holes
from beltrami.parameterization.parameterize import parameterize
from meshes_of_the_errata import cur

pytestmark = pytest.mark.chapter("P69")


def pierced(mesh, *vertices):
    """Take the faces around some vertices away."""
    around = np.unique(np.concatenate([mesh.face_ring(v) for v in vertices]))
    used, local = np.unique(np.delete(mesh.faces, around, axis=0), return_inverse=True)
    data = {name: values[used] for name, values in mesh.vertex_data.items()}
    return Mesh(mesh.vertices[used], local.reshape(-1, 3), data)


SURFACES = {
    "sphere with holes": pierced(icosphere(3), 0, 3, 7, 11),
    "flat with a hole": pierced(disk(5), 0),
    "cylinder": cylinder(24, 6),
    "torus with two holes": pierced(torus(16, 12), 0, 90),
}


@pytest.mark.parametrize("method", ["auto", "free", "tutte"])
@pytest.mark.parametrize("name", SURFACES)
def test_holes_stay_holes(name, method):
    mesh = SURFACES[name]
    psi = parameterize(mesh, method, holes="fill")
    assert psi.is_bijective
    assert certify(psi.mesh.topology, psi.uv).is_bijective
    np.testing.assert_array_equal(psi.vertex_map[psi.mesh.faces], mesh.faces)
    np.testing.assert_array_equal(psi.mesh.vertices, mesh.vertices[psi.vertex_map])
    np.testing.assert_array_equal(psi.vertex_map[: mesh.n_vertices], np.arange(mesh.n_vertices))
    if name.startswith("torus"):
        assert len(psi.cut_edges) > 10
        assert np.isin(psi.cut_edges @ [10**6, 1], mesh.edges @ [10**6, 1]).all()
    else:
        assert len(psi.cut_edges) == 0
        assert len(psi.mesh.boundary_loops) == len(mesh.boundary_loops) > 1


def test_the_outer_boundary_is_the_one_that_was_asked_for():
    mesh = SURFACES["flat with a hole"]
    psi = parameterize(mesh, holes="fill")
    radii = [np.linalg.norm(psi.uv[loop], axis=1) for loop in psi.mesh.boundary_loops]
    np.testing.assert_allclose(radii[0], 1, atol=1e-15)
    assert radii[1].max() < 0.5
    free = parameterize(mesh, "free", holes="fill")  # flat already
    np.testing.assert_allclose(free.distortion.singular_values, 1, atol=1e-3)


def test_relaxation_lets_the_holes_move():
    """The fans are gone by then: they do not hold what they closed."""
    mesh = SURFACES["sphere with holes"]
    solved = parameterize(mesh, "tutte", "clamped", holes="fill")
    psi = parameterize(mesh, holes="fill")
    assert psi.distortion.symmetric_dirichlet < 0.5 * solved.distortion.symmetric_dirichlet


def test_without_holes_nothing_changes():
    mesh = cur()
    np.testing.assert_array_equal(parameterize(mesh, holes="fill").uv, parameterize(mesh).uv)
    assert fill_holes(mesh) is None


def test_filled_surfaces_and_their_components():
    two = pierced(icosphere(2), 0, 3), pierced(icosphere(2), 5, 7, 9)
    shift = two[0].n_vertices
    x = np.concatenate([two[0].vertices, two[1].vertices + 5])
    mesh = Mesh(x, np.concatenate([two[0].faces, two[1].faces + shift]))
    filling = fill_holes(mesh)
    assert len(filling.mesh.boundary_loops) == 2
    assert filling.mesh.euler_characteristic == 2
    assert filling.mesh.n_vertices == mesh.n_vertices + 3
    psi = parameterize(mesh, holes="fill", cut=False)
    assert psi.is_bijective
    with pytest.raises(NotADiskError):
        parameterize(mesh, cut=False)


def test_functions_stay_on_the_surface():
    mesh = icosphere(2)
    mesh = pierced(mesh.with_data(height=mesh.vertices[:, 2]), 0, 5)
    psi = parameterize(mesh, holes="fill")
    np.testing.assert_array_equal(
        psi.mesh.vertex_data["height"], mesh.vertex_data["height"][psi.vertex_map]
    )


def test_bad_input():
    with pytest.raises(UnknownNameError, match="fill"):
        parameterize(cur(), holes="filled")
