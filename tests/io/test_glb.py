"""GLB: what viewers need is in the file, and the surfaces of a scene come back as they are."""

import gzip
import json

import numpy as np
import pytest
from PIL import Image

from beltrami.display.render import render
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


def test_a_mirror_leaves_each_corner_its_coordinates(tmp_path, trimesh):
    box = trimesh.creation.box()
    uv = np.random.default_rng(1).random((len(box.vertices), 2))
    box.visual = trimesh.visual.TextureVisuals(uv=uv, image=Image.fromarray(PICTURE))
    scene = trimesh.Scene()
    scene.add_geometry(box, transform=np.diag([-1.0, 1, 1, 1]))
    scene.export(tmp_path / "a.glb")
    mesh = read_mesh(tmp_path / "a.glb")
    at = np.abs(mesh.vertices[:, None] - box.vertices * [-1, 1, 1]).sum(axis=2).argmin(axis=1)
    np.testing.assert_allclose(mesh.corner_uv, uv[at[mesh.faces]], atol=1e-6)
    np.testing.assert_allclose(mesh.volume, 1.0, rtol=1e-6)


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


@pytest.mark.usefixtures("trimesh")
def test_seams_of_a_texture_do_not_tear_the_surface(tmp_path):
    """A file has a copy of each vertex for each of its texture coordinates; a mesh has none."""
    ball = icosphere(2)
    turns = np.random.default_rng(1).random((ball.n_faces, 3, 2))
    mesh = Mesh(ball.vertices.astype(np.float32), ball.faces, corner_uv=turns)
    write_mesh(tmp_path / "a.glb", mesh)
    assert len(surface(tmp_path / "a.glb")[0]["POSITION"]) == 3 * mesh.n_faces
    back = read_mesh(tmp_path / "a.glb")
    np.testing.assert_array_equal(back.vertices, mesh.vertices)
    np.testing.assert_array_equal(back.faces, mesh.faces)
    np.testing.assert_allclose(back.corner_uv, turns, atol=1e-7)
    np.testing.assert_allclose(back.vertex_data["normal"], mesh.vertex_normals, atol=1e-6)
    seen = [render(m, size=(60, 60)) for m in (mesh, back)]
    np.testing.assert_array_equal(*seen)


@pytest.mark.usefixtures("trimesh")
@pytest.mark.parametrize("width", [3, 4])
@pytest.mark.parametrize("seam", [False, True])
def test_colours_come_back(tmp_path, width, seam):
    ball = icosphere(1)
    colour = np.random.default_rng(2).integers(0, 256, (ball.n_vertices, width), dtype=np.uint8)
    turns = np.random.default_rng(1).random((ball.n_faces, 3, 2)) if seam else None
    write_mesh(tmp_path / "a.glb", ball.with_data(color=colour), turns)
    back = read_mesh(tmp_path / "a.glb").vertex_data["color"]
    np.testing.assert_allclose(back, colour / 255, atol=1e-6)  # in eight bits of light: 0.05


@pytest.mark.usefixtures("trimesh")
@pytest.mark.parametrize("name", ["normal", "color"])
def test_vertices_that_differ_in_more_than_texture_stay_apart(tmp_path, name):
    """As at a sharp edge, which a file has as copies with a normal for each side."""
    square = grid(2, 1, dimension=3)
    corners = Mesh(square.vertices[square.faces].reshape(-1, 3), np.arange(12).reshape(-1, 3))
    told = np.zeros((12, 3))
    told[:6, 0], told[6:, 1] = 1, 1
    uv = np.random.default_rng(0).random((4, 3, 2))
    write_mesh(tmp_path / "a.glb", corners.with_data(**{name: told}), uv)
    back = read_mesh(tmp_path / "a.glb")
    assert back.n_vertices == 4 + 4  # of two squares side by side, which share no vertex
    np.testing.assert_allclose(
        back.vertex_data[name][back.faces].reshape(-1, 3), told[corners.faces].reshape(-1, 3)
    )
    write_mesh(tmp_path / "b.glb", corners.with_data(**{name: told}))
    np.testing.assert_array_equal(read_mesh(tmp_path / "b.glb").faces, corners.faces)


def test_colours_and_normals_of_a_scene_of_trimesh(tmp_path, trimesh):
    """One byte is 8 bits of linear light; what a surface lacks is NaN; normals turn along."""
    scene = trimesh.Scene()
    ball = trimesh.creation.icosphere(1)
    ball.visual = trimesh.visual.ColorVisuals(
        ball, vertex_colors=np.tile([55, 128, 255, 102], (42, 1)).astype(np.uint8)
    )
    flattened = np.diag([2.0, 1.0, -1.0, 1.0])
    flattened[2, 3] = 9
    scene.add_geometry(ball, transform=flattened)
    scene.add_geometry(trimesh.creation.box())
    scene.export(tmp_path / "a.glb", include_normals=True)
    mesh = read_mesh(tmp_path / "a.glb")
    far = mesh.vertices[:, 2] > 5
    assert far.sum() == 42
    light = np.array([55, 128, 255]) / 255
    exact = [*(1.055 * light ** (1 / 2.4) - 0.055), 102 / 255]
    np.testing.assert_allclose(mesh.vertex_data["color"][far], [exact] * 42, atol=1e-12)
    assert np.isnan(mesh.vertex_data["color"][~far]).all()
    x = (mesh.vertices[far] - [0, 0, 9]) / [4, 1, 1]  # half the gradient of x²/4 + y² + z²
    outward = x / np.linalg.norm(x, axis=1, keepdims=True)
    np.testing.assert_allclose(mesh.vertex_data["normal"][far], outward, atol=1e-6)
    assert mesh.volume > 0
    ball.export(tmp_path / "b.glb", include_normals=False)
    assert list(read_mesh(tmp_path / "b.glb").vertex_data) == ["color"]  # none is made up


def test_a_box_of_trimesh_with_a_texture_is_closed_again(tmp_path, trimesh):
    export_gltf = pytest.importorskip("trimesh.exchange.gltf").export_gltf
    box, _ = textured(trimesh, 0.0, 0)
    corners = trimesh.Trimesh(
        box.triangles.reshape(-1, 3), np.arange(36).reshape(-1, 3), process=False
    )
    uv = np.random.default_rng(3).random((36, 2))
    corners.visual = trimesh.visual.TextureVisuals(uv=uv, material=box.visual.material)
    for name, content in export_gltf(trimesh.Scene(corners)).items():  # the numbers beside
        (tmp_path / name).write_bytes(content)
    mesh = read_mesh(tmp_path / "model.gltf")
    assert mesh.n_vertices == 8
    assert mesh.is_closed
    np.testing.assert_allclose(mesh.corner_uv.reshape(-1, 2), uv, atol=1e-6)
