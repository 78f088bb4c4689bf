"""Meshes over charts: seams closed, poles one vertex, orientation, refusals."""

import numpy as np
import pytest

import charts
from beltrami.errors import MeshError, NotOrientableError, SurfaceError
from beltrami.mesh.geometry import degenerate_faces
from beltrami.surfaces.domain import Disk
from beltrami.surfaces.surface import ParametricSurface

pytestmark = pytest.mark.chapter("D1")


@pytest.mark.parametrize(("nu", "nv"), [(3, 2), (3, 3), (12, 7), (40, 20)])
def test_the_sphere_is_closed_of_genus_0(nu, nv):
    mesh = charts.sphere().mesh(nu, nv)
    assert mesh.n_vertices == nu * (nv - 1) + 2
    assert mesh.n_faces == 2 * nu * (nv - 1)
    assert mesh.is_closed
    assert mesh.is_manifold
    assert mesh.is_oriented
    assert mesh.genus == 0
    assert np.allclose(np.linalg.norm(mesh.vertices, axis=1), 1, rtol=1e-14)
    assert not len(degenerate_faces(mesh.vertices, mesh.faces))
    assert mesh.volume < 0  # v runs down from the north pole: ∂u x ∂v is inward


def test_the_normals_are_those_of_the_chart():
    """∂u x ∂v outward: the volume is positive. Vertices are where their parameters say."""
    surface = ParametricSurface(
        lambda v, u: (np.sin(v) * np.cos(u), np.sin(v) * np.sin(u), np.cos(v)),
        ((0, np.pi), charts.TURN),
        periodic=(False, True),
    )
    mesh = surface.mesh(9, 14)
    assert mesh.genus == 0
    assert mesh.volume > 0
    assert (np.einsum("ij,ij->i", mesh.vertex_normals, mesh.vertices) > 0.9).all()
    assert np.array_equal(surface(*mesh.vertex_data["parameters"].T), mesh.vertices)


@pytest.mark.parametrize(("nu", "nv"), [(3, 3), (8, 5)])
def test_the_torus_has_genus_1(nu, nv):
    mesh = charts.torus().mesh(nu, nv)
    assert (mesh.n_vertices, mesh.n_faces) == (nu * nv, 2 * nu * nv)
    assert mesh.is_closed
    assert mesh.is_oriented
    assert mesh.genus == 1
    assert mesh.volume > 0


def test_the_cylinder_has_two_boundaries_and_cut_open_one():
    mesh = charts.cylinder().mesh(9, 4)
    assert (mesh.n_vertices, len(mesh.boundary_loops)) == (45, 2)
    cut = ParametricSurface(charts.cylinder().immersion.phi, (charts.TURN, (0, 3))).mesh(9, 4)
    assert (cut.n_vertices, len(cut.boundary_loops)) == (50, 1)


def test_the_polar_plane_is_a_disk():
    mesh = charts.polar_plane().mesh(4, 10)
    assert mesh.n_vertices == 4 * 10 + 1
    assert mesh.euler_characteristic == 1
    assert mesh.is_manifold
    assert mesh.face_areas.min() > 0


def test_a_pole_without_a_seam_is_a_corner():
    """A quarter of the sphere: the pole lies on the boundary, and is one vertex all the same."""
    mesh = ParametricSurface(charts.sphere().immersion.phi, ((0, 1.5), (0, 1.5))).mesh(5, 6)
    assert mesh.n_vertices == 6 * 7 - 5
    assert mesh.euler_characteristic == 1
    assert mesh.is_manifold
    assert len(mesh.boundary_loops) == 1


@pytest.mark.parametrize(("nu", "nv"), [(5, 1), (12, 3), (15, 4)])
def test_the_band_of_mobius_closes_with_a_flip(nu, nv):
    mesh = charts.mobius().mesh(nu, nv)
    assert mesh.n_vertices == nu * (nv + 1)
    assert mesh.is_manifold
    assert mesh.euler_characteristic == 0
    assert len(mesh.boundary_loops) == 1
    assert not mesh.is_oriented
    with pytest.raises(NotOrientableError):
        _ = mesh.genus


@pytest.mark.parametrize(("nu", "nv"), [(4, 4), (9, 7)])
def test_the_bottle_of_klein_is_closed_and_one_sided(nu, nv):
    mesh = charts.klein().mesh(nu, nv)
    assert mesh.n_vertices == nu * nv
    assert mesh.is_closed
    assert mesh.is_manifold
    assert mesh.euler_characteristic == 0
    assert not mesh.is_oriented


@pytest.mark.parametrize(("nu", "nv"), [(3, 1), (10, 4), (12, 2)])
def test_a_disk_is_filled_with_rings(nu, nv):
    mesh = charts.stereographic(radius=1.0).mesh(nu, nv)
    assert mesh.euler_characteristic == 1
    assert mesh.is_manifold
    assert mesh.is_oriented
    assert len(mesh.boundary_loops[0]) == nu
    assert not len(degenerate_faces(mesh.vertices, mesh.faces))
    on_rim = mesh.vertices[mesh.boundary_loops[0]]
    assert np.allclose(on_rim[:, 2], 0, atol=1e-15)
    off = ParametricSurface(lambda u, v: (u, v), Disk(2.0, center=(5.0, -1.0))).mesh(nu, nv)
    assert np.allclose(off.vertices[0], [5, -1])
    assert np.linalg.norm(off.vertices - [5, -1], axis=1).max() == pytest.approx(2)


def test_sides_that_do_not_meet_are_named():
    phi = charts.torus().immersion.phi
    with pytest.raises(SurfaceError, match="do not meet") as caught:
        ParametricSurface(phi, ((0, 6), charts.TURN), periodic=(True, True)).mesh(6, 5)
    assert len(caught.value.parameters) == 6
    assert (caught.value.parameters[:, 0] == 0).all()
    with pytest.raises(SurfaceError, match="do not meet"):
        ParametricSurface(phi, (charts.TURN, (0, 3)), periodic=(False, True)).mesh(6, 5)
    with pytest.raises(SurfaceError, match="do not meet"):  # half a turn, shifted: no seam
        ParametricSurface(phi, ((0, np.pi), charts.TURN), periodic=(True, True)).mesh(6, 5)


@pytest.mark.parametrize(("nu", "nv"), [(1, 5), (2, 5), (5, 2), (1, 1)])
def test_too_few_cells_for_a_seam(nu, nv):
    with pytest.raises(SurfaceError, match="too few"):
        charts.torus().mesh(nu, nv)


@pytest.mark.parametrize(("nu", "nv"), [(5, 1), (2, 5), (1, 1)])
def test_too_few_cells_for_poles(nu, nv):
    with pytest.raises(SurfaceError, match="too few"):
        charts.sphere().mesh(nu, nv)


@pytest.mark.parametrize("numbers", [(0, 3), (3, 0), (2.5, 3), (-1, 3)])
def test_numbers_of_cells_are_whole(numbers):
    for surface in (charts.torus(), charts.stereographic()):
        with pytest.raises(MeshError):
            surface.mesh(*numbers)


def test_a_disk_needs_three_vertices_around():
    with pytest.raises(MeshError):
        charts.stereographic().mesh(2, 3)


def test_a_map_without_area_has_no_mesh():
    line = ParametricSurface(lambda u, v: (u + v, 2 * u + 2 * v, 0), ((0, 1), (0, 2)))
    with pytest.raises(SurfaceError, match="18 of the 18 faces between") as caught:
        line.mesh(3, 3)
    assert caught.value.parameters.shape == (18, 2)
    assert "Jacobian" in caught.value.remedy


def test_a_map_that_folds_on_a_line_names_parameters_there():
    ledge = ParametricSurface(lambda u, v: (np.maximum(u, 0), v, 0), ((-1, 1), (0, 1)))
    with pytest.raises(SurfaceError, match="have no area") as caught:
        ledge.mesh(4, 2)
    assert (caught.value.parameters[:, 0] < 0.01).all()
    assert len(caught.value.parameters) == 8  # of 16: those where u < 0


@pytest.mark.parametrize("scale", [1e-12, 1e12])
def test_seams_and_poles_do_not_depend_on_the_unit(scale):
    def phi(u, v):
        return scale * np.sin(v) * np.cos(u), scale * np.sin(v) * np.sin(u), scale * np.cos(v)

    surface = ParametricSurface(phi, (charts.TURN, (0, np.pi)), periodic=(True, False))
    assert surface.mesh(7, 5).genus == 0
