"""There and back again through the real packages: order, data, and what cannot be kept.

Packages that are not installed are skipped by name; `make test-neighbours` installs them all.
"""

import importlib

import numpy as np
import pytest
from hypothesis import given, settings

from beltrami.errors import DimensionError, MeshError
from beltrami.io.registry import read_mesh, write_mesh
from beltrami.mesh.convert import as_mesh
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import icosphere
from strategies import any_meshes

KEEPING = ("trimesh", "pyvista", "meshio", "open3d")  # what can be asked for its data
ALL = (*KEEPING, "polyscope")


def installed(name):
    try:
        package = importlib.import_module(name)
    except ImportError as missing:
        pytest.skip(f"{name} cannot be imported here ({missing}): make test-neighbours")
    if name == "polyscope" and not package.is_initialized():
        package.init("openGL_mock")  # no window, no graphics card
    return package


def in_space(x):
    return np.pad(x, ((0, 0), (0, 3 - x.shape[1])))


def dressed():
    """A mesh with functions of many types, in an order that nobody would choose."""
    sphere, rng = icosphere(1), np.random.default_rng(0)
    order = rng.permutation(sphere.n_vertices)
    place = np.argsort(order)
    data = {
        "height": sphere.vertices[order, 2],
        "index": np.arange(42),
        "half": np.arange(42, dtype=np.float16),
        "inside": np.arange(42) % 3 == 0,
        "pair": rng.random((42, 2)),
        "color": rng.integers(0, 256, (42, 3)).astype(np.uint8),
        "normal": sphere.vertices[order],
    }
    faces = place[sphere.faces][rng.permutation(80)]
    return Mesh(sphere.vertices[order], faces, data, rng.random((80, 3, 2)))


@pytest.mark.parametrize("target", ALL)
@given(mesh=any_meshes())
@settings(max_examples=20)
def test_order_is_kept(target, mesh):
    installed(target)
    back = as_mesh(mesh.to(target))
    wanted = mesh.vertices if target == "meshio" else in_space(mesh.vertices)
    if target == "polyscope":
        wanted = wanted.astype(np.float32)
    assert np.array_equal(back.vertices, wanted)
    assert np.array_equal(back.faces, mesh.faces)


@pytest.mark.parametrize("target", KEEPING)
def test_functions_come_back(target):
    installed(target)
    mesh = dressed()
    back = as_mesh(mesh.to(target))
    assert set(back.vertex_data) == set(mesh.vertex_data)
    for name, values in mesh.vertex_data.items():
        assert np.array_equal(back.vertex_data[name], values), name
        assert back.vertex_data[name].dtype.kind == values.dtype.kind, name
    uv = mesh.corner_uv if target == "open3d" else None
    assert np.array_equal(back.corner_uv, uv) if uv is not None else back.corner_uv is None


@pytest.mark.parametrize("target", KEEPING)
def test_what_is_theirs_can_be_changed(target):
    installed(target)
    mesh = dressed()
    theirs = mesh.to(target)
    if target == "open3d":
        theirs.vertex["positions"][:] = 0.0
        theirs.vertex["height"][:] = 0.0
    elif target == "trimesh":
        theirs.vertices[:] = 0
        theirs.vertex_attributes["height"][:] = 0
    else:
        theirs.points[:] = 0
        theirs.point_data["height"][:] = 0
    assert mesh.area > 0
    assert mesh.vertex_data["height"].any()


@pytest.mark.parametrize("target", ["trimesh", "pyvista", "open3d", "polyscope"])
def test_four_coordinates_have_no_place_in_space(target):
    installed(target)
    with pytest.raises(DimensionError, match=target):
        Mesh(np.eye(4), [[0, 1, 2]]).to(target)


def test_trimesh_shows_the_colours_and_gives_its_own():
    installed("trimesh")
    mesh = dressed()
    theirs = mesh.to("trimesh")
    assert np.array_equal(theirs.visual.vertex_colors[:, :3], mesh.vertex_data["color"])
    theirs = mesh.with_data(color=mesh.vertex_data["color"] / 255).to("trimesh")
    assert np.array_equal(theirs.visual.vertex_colors[:, :3], mesh.vertex_data["color"])
    del theirs.vertex_attributes["color"]
    assert as_mesh(theirs).vertex_data["color"].shape == (42, 4)


def test_trimesh_texture_coordinates_become_those_of_corners():
    trimesh = installed("trimesh")
    mesh, uv = icosphere(0), np.random.default_rng(1).random((12, 2))
    visual = trimesh.visual.TextureVisuals(uv=uv)
    theirs = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False, visual=visual)
    assert np.array_equal(as_mesh(theirs).corner_uv, uv[mesh.faces])


def test_a_scene_is_told_apart_from_a_mesh():
    trimesh = installed("trimesh")
    with pytest.raises(MeshError, match=r"scene\.to_mesh"):
        as_mesh(trimesh.Scene([icosphere(0).to("trimesh")]))


def test_lapy():
    lapy = pytest.importorskip("lapy")
    mesh = dressed()
    back = as_mesh(lapy.TriaMesh(mesh.vertices, mesh.faces))
    assert np.array_equal(back.vertices, mesh.vertices)
    assert np.array_equal(back.faces, mesh.faces)


def test_pyvista_grids_and_polygons():
    pyvista = installed("pyvista")
    grid = dressed().to("pyvista").cast_to_unstructured_grid()
    assert np.array_equal(as_mesh(grid).faces, dressed().faces)
    assert "height" in as_mesh(grid).vertex_data
    for polygons in (
        pyvista.Plane(),
        pyvista.PolyData(np.eye(4)[:, :3], [3, 0, 1, 2, 4, 0, 1, 2, 3]),
    ):
        with pytest.raises(MeshError, match="no triangles") as caught:
            as_mesh(polygons)
        assert "triangulate()" in caught.value.remedy
    assert as_mesh(pyvista.Plane(i_resolution=2, j_resolution=2).triangulate()).n_faces == 8
    assert as_mesh(pyvista.PolyData(np.eye(3))).n_faces == 3 - 3


def test_open3d_of_the_older_kind():
    open3d = installed("open3d")
    mesh = dressed()
    back = as_mesh(mesh.to("open3d").to_legacy())
    assert np.array_equal(back.faces, mesh.faces)
    assert np.array_equal(back.vertices, mesh.vertices)
    assert np.allclose(back.vertex_data["normal"], mesh.vertex_data["normal"])
    assert np.allclose(back.corner_uv, mesh.corner_uv)
    assert set(back.vertex_data) == {"normal", "color"}
    bare = open3d.geometry.TriangleMesh(
        open3d.utility.Vector3dVector(mesh.vertices.copy()),
        open3d.utility.Vector3iVector(mesh.faces.copy()),
    )
    assert not as_mesh(bare).vertex_data
    assert as_mesh(open3d.t.geometry.TriangleMesh()).n_vertices == 0


def test_polyscope_shows_the_functions():
    polyscope = installed("polyscope")
    mesh = dressed()
    theirs = mesh.to("polyscope")
    values = theirs.get_quantity_buffer("height", "values")
    shown = [values.get_value(i) for i in range(values.size())]
    assert np.allclose(shown, mesh.vertex_data["height"])
    second = theirs.get_quantity_buffer("pair_1", "values")
    assert second.get_value(7) == pytest.approx(mesh.vertex_data["pair"][7, 1])
    colour = theirs.get_quantity_buffer("color", "colors").get_value(5).as_tuple()
    assert np.allclose(np.array(colour) * 255, mesh.vertex_data["color"][5])
    icosphere(0).to("polyscope")
    assert polyscope.get_surface_mesh("beltrami mesh").n_vertices() == 12


@pytest.mark.parametrize("binary", [True, False])
def test_files_of_vtk_there_and_back(binary, tmp_path):
    """Surfaces as .vtp: what we write, pyvista reads, and the other way round."""
    pyvista, mesh = installed("pyvista"), dressed()
    write_mesh(tmp_path / "ours.vtp", mesh)
    theirs = pyvista.read(tmp_path / "ours.vtp")
    theirs.save(tmp_path / "theirs.vtp", binary=binary)
    back = read_mesh(tmp_path / "theirs.vtp")
    for x in (np.asarray(theirs.points), back.vertices):
        np.testing.assert_array_equal(x, mesh.vertices)
    for faces in (theirs.faces.reshape(-1, 4)[:, 1:], back.faces):
        np.testing.assert_array_equal(faces, mesh.faces)
    for name, array in mesh.vertex_data.items():
        np.testing.assert_array_equal(np.asarray(theirs.point_data[name]), array)
        np.testing.assert_array_equal(back.vertex_data[name], array)
