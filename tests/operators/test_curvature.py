import numpy as np
import pytest

from beltrami.errors import (
    DegenerateFaceError,
    DimensionError,
    EmptyMeshError,
    NonFiniteError,
    NotManifoldError,
    NotOrientableError,
    UnreferencedVertexError,
)
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import blob, cube, cylinder, disk, icosphere, torus
from beltrami.operators.areas import vertex_areas
from beltrami.operators.curvature import curvature
from meshes_of_the_errata import MESHES
from strategies import moebius

pytestmark = pytest.mark.chapter("P3")


@pytest.mark.parametrize("radius", [0.01, 1.0, 300.0])
def test_the_sphere(radius):
    found = curvature(icosphere(4, radius))
    assert np.allclose(found.mean * radius, 1, atol=1e-4)
    assert np.allclose(found.gaussian * radius**2, 1, atol=0.01)
    assert np.allclose(found.principal * radius, 1, atol=0.1)
    assert (found.principal[:, 0] >= found.principal[:, 1]).all()


def test_turned_inside_out_only_the_mean_changes_its_sign():
    mesh = MESHES["obt"]()
    one, other = curvature(mesh), curvature(Mesh(mesh.vertices, mesh.faces[:, ::-1]))
    assert np.allclose(other.mean, -one.mean, rtol=1e-9, atol=1e-9)
    assert np.allclose(other.gaussian, one.gaussian, rtol=1e-9, atol=1e-9)
    assert np.allclose(other.principal, -one.principal[:, ::-1], rtol=1e-6, atol=1e-6)


def test_the_torus_has_both_signs():
    mesh = torus(240, 120, 1.0, 0.4)
    found = curvature(mesh)
    distance = np.hypot(*mesh.vertices[:, :2].T)
    cosine = (distance - 1) / 0.4
    assert np.allclose(found.gaussian, cosine / (0.4 * distance), atol=0.02)
    across = cosine / distance
    assert np.allclose(found.principal[:, 0], 1 / 0.4, atol=0.02)
    assert np.allclose(found.principal[:, 1], across, atol=0.02)
    assert np.allclose(found.mean, (1 / 0.4 + across) / 2, atol=0.01)


def test_a_cylinder_bends_one_way_only():
    """Lengths, and so K, are those of the plane; H is not (l. 35 of the chapter)."""
    mesh = cylinder(64, 33, radius=2.0, height=3.0)
    found = curvature(mesh)
    inner = np.setdiff1d(np.arange(mesh.n_vertices), mesh.topology.boundary_edges)
    assert np.abs(found.gaussian).max() < 1e-9
    assert np.allclose(found.mean[inner], 0.25, atol=1e-3)
    assert np.allclose(found.principal[inner], [0.5, 0], atol=1e-3)


def test_bending_a_sheet_keeps_k_and_not_h():
    flat = MESHES["open"]()
    x, y = flat.vertices.T
    tiny = []
    for radius in (10.0, 1.0):
        bent = flat.with_vertices(
            np.stack([radius * np.sin(x / radius), y, radius * np.cos(x / radius)], axis=1)
        )
        found = curvature(bent)
        stretch = np.abs(bent.edge_lengths / flat.edge_lengths - 1).max()
        assert np.abs(found.angle_defect).max() < 20 * stretch  # K follows the lengths alone
        bump = x * (1 - x) * y * (1 - y)  # a mean over the sheet: single values vary (E30)
        tiny.append((found.mean * found.areas) @ bump / (found.areas @ bump))
    assert tiny == pytest.approx([0.05, 0.5], rel=0.1)
    assert np.abs(curvature(flat).gaussian).max() < 1e-9  # in the plane all vanish
    assert np.abs(curvature(flat).mean).max() < 1e-9


def test_fields():
    mesh = MESHES["cur"]()
    found = curvature(mesh)
    K, H = found.gaussian, found.mean
    k1, k2 = found.principal.T
    assert np.array_equal(found.areas, vertex_areas(mesh, "voronoi"))
    assert np.allclose(K * found.areas, found.angle_defect, atol=1e-14)
    assert np.allclose((k1 + k2) / 2, H, atol=1e-12)
    real = H**2 >= K
    assert np.allclose((k1 * k2)[real], K[real], atol=1e-9)
    assert (k1 == k2)[~real].all()
    boundary = np.unique(mesh.topology.boundary_edges)
    assert not K[boundary].any()
    assert not H[boundary].any()
    assert not np.delete(found.turning, boundary).any()
    for array in (K, H, found.principal, found.angle_defect, found.turning, found.areas):
        assert not array.flags.writeable


def test_cube_and_disk():
    found = curvature(cube(4, 2.0))
    assert np.allclose(np.sort(found.angle_defect)[-8:], np.pi / 2)
    assert np.abs(np.sort(found.angle_defect)[:-8]).max() < 1e-12
    rim = curvature(disk(6))
    assert rim.turning.sum() == pytest.approx(2 * np.pi)
    assert np.allclose(rim.turning[rim.turning > 0], 2 * np.pi / (rim.turning > 0).sum())


def test_what_is_refused():
    with pytest.raises(NotManifoldError) as several:
        curvature(MESHES["leaves"]())
    assert several.value.edges.tolist() == [[0, 1]]
    with pytest.raises(NotOrientableError) as turned:
        curvature(Mesh(*moebius(np.random.default_rng(0), 8)))
    assert len(turned.value.edges)
    mesh = MESHES["closed"]()
    with pytest.raises(DimensionError):
        curvature(mesh.with_vertices(np.pad(mesh.vertices, ((0, 0), (0, 1)))))
    x = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [2, 0, 0.0]]
    with pytest.raises(EmptyMeshError):
        curvature(Mesh(x, []))
    with pytest.raises(UnreferencedVertexError) as stray:
        curvature(Mesh(x, [[0, 1, 2]]))
    assert stray.value.vertices.tolist() == [3]
    with pytest.raises(DegenerateFaceError):
        curvature(Mesh(x, [[0, 1, 2], [1, 0, 3]]))
    with pytest.raises(NonFiniteError):
        curvature(Mesh([*x[:2], [0, np.nan, 0]], [[0, 1, 2]]))


def test_gauss_bonnet_of_the_blob():
    found = curvature(blob(2000))
    assert found.angle_defect.sum() == pytest.approx(4 * np.pi, rel=1e-10)
    assert not found.turning.any()


def test_the_remedy_for_one_side_is_not_to_orient():
    band = Mesh(*moebius(np.random.default_rng(0), 12))
    with pytest.raises(NotOrientableError, match="one side") as caught:
        curvature(band)
    assert "repair" not in caught.value.remedy.replace("no repair", "")
    turned = icosphere(1)
    faces = turned.faces.copy()
    faces[0] = faces[0, ::-1]
    with pytest.raises(NotOrientableError) as caught:
        curvature(Mesh(turned.vertices, faces))
    assert "orient=True" in caught.value.remedy
