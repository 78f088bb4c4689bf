"""Tufted Laplacians; they need robust_laplacian, and are skipped without it."""

import numpy as np
import pytest

import dense_oracles as oracle
from beltrami.errors import (
    BeltramiError,
    DimensionError,
    EmptyMeshError,
    MeshError,
    NonFiniteError,
    UnknownNameError,
    UnreferencedVertexError,
)
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import icosphere
from beltrami.operators.areas import vertex_areas
from beltrami.operators.guarantees import WEIGHT_KINDS
from beltrami.operators.laplacian import laplacian
from beltrami.operators.point_cloud import PointCloud
from meshes_of_the_errata import MESHES

pytest.importorskip("robust_laplacian")


@pytest.mark.chapter("Q3.3", "P35")
@pytest.mark.parametrize("mesh", [MESHES["closed"](), MESHES["tor"](), icosphere(3)])
def test_on_a_closed_delaunay_mesh_it_is_the_cotangent_pair(mesh):
    """With the ½ and with the lumped areas: nothing is to be multiplied."""
    found, expected = laplacian(mesh, "tufted"), laplacian(mesh, mass="barycentric")
    assert found.mass_kind == "barycentric"
    scale = abs(expected.stiffness).max()
    assert abs(found.stiffness - expected.stiffness).max() < 1e-13 * scale
    assert np.allclose(found.masses, vertex_areas(mesh, "barycentric"), rtol=1e-12)


@pytest.mark.chapter("P35")
@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("mass", ["barycentric", "degree", "unit"])
def test_what_it_promises_on_every_mesh(name, mass):
    mesh = MESHES[name]()
    pair = laplacian(mesh, "tufted", mass)
    told = pair.properties
    assert told.non_negative_weights
    assert told.maximum_principle
    assert told.kernel_dimension == 1
    L, B = pair.stiffness.toarray(), pair.mass.toarray()
    assert np.array_equal(L, L.T)
    assert np.abs(L.sum(axis=1)).max() < 1e-12 * L.max()
    true = oracle.spectrum(L, B)
    assert true[0] == pytest.approx(0, abs=1e-9 * true[-1])
    assert true[-1] <= told.spectral_bound * (1 + 1e-12)
    assert pair.spectral_bound("degree") == pytest.approx(2)
    assert pair.edge_weight.min() > -1e-12
    if mass == "barycentric":
        assert pair.masses.sum() == pytest.approx(mesh.area, rel=1e-9)
    if name in ("bad", "obt"):
        assert not laplacian(mesh).properties.non_negative_weights


@pytest.mark.chapter("P21")
def test_it_is_not_linearly_precise_at_the_boundary():
    """Its triangles reach around the border: inner vertices near it see the other side."""
    assert not WEIGHT_KINDS["tufted"].linear_precision
    mesh = MESHES["bad"]()
    pair = laplacian(mesh, "tufted")
    inner = np.setdiff1d(np.arange(mesh.n_vertices), mesh.topology.boundary_edges)
    off = np.abs((pair.stiffness @ mesh.vertices) / pair.degrees[:, None])[inner]
    assert off.max() > 1e-3
    assert np.median(off) < 1e-12


@pytest.mark.chapter("P35")
def test_meshes_that_only_it_takes():
    flat = Mesh([[0, 0], [1, 0], [2, 0], [1, 1]], [[0, 1, 3], [1, 2, 3], [0, 2, 1]])
    pair = laplacian(flat, "tufted")
    assert pair.properties.maximum_principle
    assert np.isfinite(pair.stiffness.data).all()
    leaves = laplacian(MESHES["leaves"](), "tufted")
    assert np.allclose(
        leaves.stiffness.toarray(), laplacian(MESHES["leaves"]()).stiffness.toarray()
    )


@pytest.mark.chapter("P4", "P35")
def test_points_of_the_sphere():
    """Dirichlet energies ∫|∇f|² = l(l + 1) ∫f², and areas of 4π."""
    points = MESHES["closed"]().vertices
    cloud = laplacian(PointCloud(points), "tufted")
    assert cloud.properties.maximum_principle
    assert cloud.masses.sum() == pytest.approx(4 * np.pi, rel=0.05)
    x, y, z = points.T
    for f, value in ((z, 2), (x * y, 6), (x * z, 6)):
        assert cloud.dirichlet_energy(f) / cloud.norm(f) ** 2 == pytest.approx(value, rel=0.1)
    sphere = icosphere(3)
    regular = laplacian(PointCloud(sphere.vertices), "tufted")
    L = laplacian(sphere).stiffness
    assert abs(regular.stiffness - L).max() < 1e-12 * abs(L).max()
    few = laplacian(PointCloud(points, 6), "tufted")  # the number of neighbours matters
    assert abs(few.stiffness - cloud.stiffness).max() > 1e-3
    unit = laplacian(PointCloud(points), "tufted", "unit")
    assert (unit.masses == 1).all()


@pytest.mark.chapter("P4")
def test_points_of_the_plane():
    points = MESHES["open"]().vertices
    pair = laplacian(PointCloud(points, 20), "tufted")
    assert 0.9 < pair.masses.sum() < 1  # some is lost at the border
    energy = pair.dirichlet_energy(points[:, 0])  # ∫|∇x|² is that area
    assert energy == pytest.approx(pair.masses.sum(), rel=0.1)


def test_what_is_refused():
    mesh = icosphere(1)
    with pytest.raises(UnknownNameError) as mass:
        laplacian(mesh, "tufted", "voronoi")
    assert mass.value.choices == ("barycentric", "degree", "unit")
    with pytest.raises(EmptyMeshError):
        laplacian(Mesh(mesh.vertices, []), "tufted")
    with pytest.raises(NonFiniteError):
        laplacian(mesh.with_vertices(mesh.vertices * np.nan), "tufted")
    with pytest.raises(UnreferencedVertexError):
        laplacian(Mesh(np.pad(mesh.vertices, ((0, 1), (0, 0))), mesh.faces), "tufted")
    with pytest.raises(DimensionError, match="coordinates"):
        laplacian(mesh.with_vertices(np.pad(mesh.vertices, ((0, 0), (0, 1)))), "tufted")
    with pytest.raises(DimensionError, match="positions"):
        laplacian(mesh.topology, "tufted")
    with pytest.raises(UnknownNameError):
        laplacian(mesh, "tufted").spectral_bound("voronoi")
    with pytest.raises((MeshError, BeltramiError)):
        laplacian(mesh.with_vertices(0 * mesh.vertices), "tufted")
