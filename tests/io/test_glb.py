"""GLB: what viewers need is in the file, and the surfaces of a scene come back as they are."""

import gzip
import json

import numpy as np
import pytest
from PIL import Image

from beltrami.errors import FileFormatError, NonFiniteError
from beltrami.io.picture import as_picture
from beltrami.io.registry import read_mesh, write_mesh
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import grid, icosphere, tetrahedron

PICTURE = np.random.default_rng(0).integers(0, 256, (4, 6, 3), dtype=np.uint8)
KINDS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


def parts(path):
    """Return what a file tells in JSON, and its arrays, by the letter of the format."""
    raw = path.read_bytes()
    raw = gzip.decompress(raw) if path.suffix == ".gz" else raw
    magic, version, length, text, kind = np.frombuffer(raw[:20], "<u4").tolist()
    assert (magic, version, length, kind) == (0x46546C67, 2, len(raw), 0x4E4F534A)
    told = json.loads(raw[20 : 20 + text])
    size, kind = np.frombuffer(raw[20 + text : 28 + text], "<u4").tolist()
    content = raw[28 + text :]
    assert (size, kind, text % 4, size % 4) == (len(content), 0x004E4942, 0, 0)
    assert told["buffers"] == [{"byteLength": len(content)}]
    arrays = []
    for accessor in told["accessors"]:
        view = told["bufferViews"][accessor["bufferView"]]
        held = content[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]
        form = {5126: "<f4", 5125: "<u4"}[accessor["componentType"]]
        array = np.frombuffer(held, form).reshape(accessor["count"], KINDS[accessor["type"]])
        assert view["byteOffset"] % 4 == 0
        arrays.append(array)
    return told, arrays, content


def surface(path):
    told, arrays, _ = parts(path)
    (primitive,) = told["meshes"][0]["primitives"]
    found = {name: arrays[k] for name, k in primitive["attributes"].items()}
    return {**found, "faces": arrays[primitive["indices"]].reshape(-1, 3)}, told


def test_it_needs_no_other_package(tmp_path, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "trimesh", None)
    write_mesh(tmp_path / "a.glb.gz", icosphere(1))
    found, told = surface(tmp_path / "a.glb.gz")
    np.testing.assert_array_equal(found["faces"], icosphere(1).faces)
    np.testing.assert_array_equal(found["POSITION"], icosphere(1).vertices.astype(np.float32))
    bounds = told["accessors"][0]
    assert bounds["min"] == found["POSITION"].min(axis=0).tolist()
    assert bounds["max"] == found["POSITION"].max(axis=0).tolist()
    assert told["asset"]["version"] == "2.0"


def test_viewers_are_told_normals_so_that_they_do_not_show_faces_flat(tmp_path):
    """Also that both sides of a seam are alike: the normals are those before it is opened."""
    ball = icosphere(2)
    uv = np.random.default_rng(0).random((ball.n_faces, 3, 2))
    write_mesh(tmp_path / "a.glb", ball, uv)
    found, _ = surface(tmp_path / "a.glb")
    assert len(found["POSITION"]) == 3 * ball.n_faces
    corners = found["NORMAL"][found["faces"]].reshape(-1, 3)
    np.testing.assert_allclose(corners, ball.vertex_normals[ball.faces].reshape(-1, 3), atol=1e-6)
    turns = found["TEXCOORD_0"][found["faces"]]
    np.testing.assert_allclose(turns[..., 0], uv[..., 0], atol=1e-7)
    np.testing.assert_allclose(turns[..., 1], 1 - uv[..., 1], atol=1e-7)


def test_normals_are_those_of_the_data_and_have_length_one(tmp_path):
    mesh = tetrahedron()
    given = np.array([[0, 0, 2.0], [3, 0, 0], [0, 0, 0], [np.nan, 0, 0]])
    write_mesh(tmp_path / "a.glb", mesh.with_data(normal=given))
    found, _ = surface(tmp_path / "a.glb")
    assert found["NORMAL"].tolist() == [[0, 0, 1], [1, 0, 0], [0, 0, 1], [0, 0, 1]]
    flat = Mesh([[0, 0], [1, 0], [0, 1], [5, 5]], [[0, 1, 2]])
    write_mesh(tmp_path / "b.glb", flat)
    assert surface(tmp_path / "b.glb")[0]["NORMAL"].tolist() == [[0, 0, 1]] * 4


@pytest.mark.parametrize("scale", [1, 255])
def test_colours_are_linear_light(tmp_path, scale):
    """Of sRGB 0, 0.02, 0.5 and 1, by hand: 0.02 / 12.92, and ((0.5 + 0.055) / 1.055)^2.4."""
    grey = np.array([0.0, 0.02, 0.5, 1.0])
    colour = np.column_stack([grey, grey, grey, np.full(4, 0.5)])
    if scale == 255:
        colour = np.rint(255 * colour).astype(np.uint8)
    write_mesh(tmp_path / "a.glb", tetrahedron().with_data(color=colour[:, :3]))
    found, _ = surface(tmp_path / "a.glb")
    exact = np.array([0.0, 0.02 / 12.92, 0.2140411, 1.0])
    np.testing.assert_allclose(found["COLOR_0"][:, 1], exact, atol=1e-6 if scale == 1 else 2e-3)
    assert found["COLOR_0"].shape == (4, 3)
    write_mesh(tmp_path / "b.glb", tetrahedron().with_data(color=colour))
    np.testing.assert_allclose(surface(tmp_path / "b.glb")[0]["COLOR_0"][:, 3], 0.5, atol=2e-3)


def test_colours_do_not_darken_a_texture(tmp_path):
    square = grid(2, 2, dimension=3)
    uv = square.vertices[:, :2]
    coloured = square.with_data(color=np.zeros((square.n_vertices, 3)))
    write_mesh(tmp_path / "a.glb", coloured, uv, PICTURE)
    found, told = surface(tmp_path / "a.glb")
    assert "COLOR_0" not in found
    (image,) = told["images"]
    view = told["bufferViews"][image["bufferView"]]
    held = parts(tmp_path / "a.glb")[2][view["byteOffset"] :][: view["byteLength"]]
    (tmp_path / "x.png").write_bytes(held)
    np.testing.assert_allclose(as_picture(tmp_path / "x.png") * 255, PICTURE, atol=1e-9)


def test_no_picture_and_no_grey_is_invented(tmp_path):
    mesh = tetrahedron()
    write_mesh(tmp_path / "a.glb", mesh, mesh.vertices[:, :2])
    _, told = surface(tmp_path / "a.glb")
    assert "images" not in told
    (material,) = told["materials"]
    look = material["pbrMetallicRoughness"]
    assert look == {"metallicFactor": 0.0, "roughnessFactor": 1.0}  # the default is a metal
    assert not material["doubleSided"]
    write_mesh(tmp_path / "b.glb", grid(2, 2, dimension=3))
    assert surface(tmp_path / "b.glb")[1]["materials"][0]["doubleSided"]


def test_what_32_bits_do_not_hold_is_told(tmp_path):
    mesh = tetrahedron()
    with pytest.raises(NonFiniteError, match="32 bits of GLB"):
        write_mesh(tmp_path / "a.glb", mesh.with_vertices(mesh.vertices * 1e39))
    with pytest.raises(NonFiniteError, match="texture coordinates"):
        write_mesh(tmp_path / "a.glb", mesh, mesh.vertices[:, :2] * 1e39)
    assert list(tmp_path.iterdir()) == []
    write_mesh(tmp_path / "a.glb", mesh, np.where(mesh.vertices[:, :2] > 0, np.nan, 0.5))
    found, _ = surface(tmp_path / "a.glb")
    assert np.isfinite(found["TEXCOORD_0"]).all()


@pytest.fixture
def trimesh():
    return pytest.importorskip("trimesh")


def textured(trimesh, shift, channel):
    """Return a box of trimesh, with x and y as texture coordinates and a picture of one colour."""
    box = trimesh.creation.box()
    picture = np.zeros((16, 16 + 16 * channel, 3), np.uint8)
    picture[..., channel] = 255
    box.visual = trimesh.visual.TextureVisuals(
        uv=box.vertices[:, :2] + 0.5, image=Image.fromarray(picture)
    )
    return box, trimesh.transformations.translation_matrix([shift, 0, 0])


def test_two_textures_leave_the_coordinates_as_they_are(tmp_path, trimesh):
    """trimesh would pack both pictures into one, and change the coordinates."""
    scene = trimesh.Scene()
    for channel in range(2):
        box, place = textured(trimesh, 3.0 * channel, channel)
        scene.add_geometry(box, transform=place)
    scene.export(tmp_path / "two.glb")
    mesh = read_mesh(tmp_path / "two.glb")
    assert (mesh.n_vertices, mesh.n_faces) == (16, 24)
    corners = mesh.vertices[mesh.faces]
    local = corners[..., :2] + 0.5 - [3, 0] * (corners[..., :1].mean(axis=1, keepdims=True) > 1.5)
    np.testing.assert_allclose(mesh.corner_uv, local, atol=1e-6)


def test_a_surface_without_a_texture_does_not_take_that_of_others_away(tmp_path, trimesh):
    scene = trimesh.Scene()
    box, place = textured(trimesh, 0.0, 0)
    scene.add_geometry(box, transform=place)
    scene.add_geometry(
        trimesh.creation.box(), transform=trimesh.transformations.translation_matrix([5, 0, 0])
    )
    scene.export(tmp_path / "a.glb")
    mesh = read_mesh(tmp_path / "a.glb")
    plain = mesh.vertices[mesh.faces][..., 0].min(axis=1) > 3
    assert plain.sum() == 12
    assert np.isnan(mesh.corner_uv[plain]).all()
    np.testing.assert_allclose(
        mesh.corner_uv[~plain], mesh.vertices[mesh.faces[~plain]][..., :2] + 0.5, atol=1e-6
    )


def test_surfaces_stand_where_the_scene_has_them_and_mirrors_do_not_turn_them(tmp_path, trimesh):
    scene = trimesh.Scene()
    box = trimesh.creation.box()
    scene.add_geometry(box, transform=np.diag([2.0, 1, 1, 1]))
    mirror = np.diag([-1.0, 1, 1, 1])
    mirror[0, 3] = 4
    scene.add_geometry(box, transform=mirror)
    scene.add_geometry(trimesh.PointCloud([[9.0, 9, 9]]))
    scene.export(tmp_path / "a.glb")
    mesh = read_mesh(tmp_path / "a.glb")
    np.testing.assert_allclose(mesh.volume, 3.0, rtol=1e-6)
    assert mesh.n_vertices == 16


def test_a_scene_without_surfaces_is_told(tmp_path, trimesh):
    trimesh.Scene([trimesh.PointCloud([[0.0, 0, 0], [1, 1, 1]])]).export(tmp_path / "a.glb")
    with pytest.raises(FileFormatError, match="expected vertices and triangles"):
        read_mesh(tmp_path / "a.glb")


def test_trimesh_reads_what_is_written(tmp_path, trimesh):
    ball = icosphere(2)
    uv = np.random.default_rng(0).random((ball.n_vertices, 2))
    write_mesh(tmp_path / "a.glb", ball, uv, PICTURE)
    theirs = trimesh.load_scene(tmp_path / "a.glb", process=False).to_mesh()
    np.testing.assert_allclose(theirs.visual.uv, uv, atol=1e-6)
    np.testing.assert_allclose(theirs.vertex_normals, ball.vertex_normals, atol=1e-6)
    picture = theirs.visual.material.baseColorTexture
    np.testing.assert_array_equal(np.asarray(picture.convert("RGB")), PICTURE)
