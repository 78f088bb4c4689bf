"""Textures in files: OBJ with its material and picture, GLB with all in one."""

import gzip

import numpy as np
import pytest
from PIL import Image

from beltrami.errors import DimensionError, FileFormatError, MeshError, UnknownNameError
from beltrami.io.picture import as_picture
from beltrami.io.registry import read_mesh, write_mesh
from beltrami.mesh.mesh import Mesh

SQUARE = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
FACES = np.array([[0, 1, 2], [0, 2, 3]])
UV = np.array([[[0, 0], [0.5, 0], [0.5, 0.5]], [[0.5, 0.5], [1, 1], [0.5, 1]]])  # torn apart
PICTURE = np.random.default_rng(0).integers(0, 256, (4, 6, 3), dtype=np.uint8)
TORN = Mesh(SQUARE, FACES, corner_uv=UV)


@pytest.mark.chapter("P71")
@pytest.mark.parametrize("name", ["a.obj", "a.obj.gz"])
def test_obj_names_its_material_which_names_its_picture(tmp_path, name):
    write_mesh(tmp_path / name, TORN, texture=PICTURE)
    raw = (tmp_path / name).read_bytes()
    lines = (gzip.decompress(raw) if name.endswith(".gz") else raw).decode().splitlines()
    assert lines[0] == "mtllib a.mtl"
    material = (tmp_path / "a.mtl").read_text().splitlines()
    named = material[0].split()[1]
    assert lines.index(f"usemtl {named}") < next(k for k, s in enumerate(lines) if s[0] == "f")
    assert "map_Kd a.png" in material
    with Image.open(tmp_path / "a.png") as picture:
        np.testing.assert_array_equal(np.asarray(picture), PICTURE)
    back = read_mesh(tmp_path / name)
    np.testing.assert_array_equal(back.corner_uv, UV)
    np.testing.assert_array_equal(back.faces, FACES)


def test_without_a_texture_nothing_is_written_beside(tmp_path):
    write_mesh(tmp_path / "a.obj", TORN)
    assert [path.name for path in tmp_path.iterdir()] == ["a.obj"]
    assert b"mtl" not in (tmp_path / "a.obj").read_bytes()


@pytest.mark.chapter("P71")
def test_glb_holds_coordinates_and_picture(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    write_mesh(tmp_path / "a.glb", TORN, texture=PICTURE)
    back = read_mesh(tmp_path / "a.glb")
    np.testing.assert_array_equal(back.corner_uv, UV)
    np.testing.assert_array_equal(back.vertices[back.faces], SQUARE[FACES])
    assert back.n_vertices == 4  # two of them have two places on the texture, and a copy for each
    theirs = trimesh.load_scene(tmp_path / "a.glb").to_mesh()
    picture = theirs.visual.material.baseColorTexture
    np.testing.assert_array_equal(np.asarray(picture.convert("RGB")), PICTURE)


def test_glb_without_a_texture(tmp_path):
    pytest.importorskip("trimesh")
    write_mesh(tmp_path / "a.glb", Mesh(SQUARE, FACES), uv=SQUARE[:, :2])
    back = read_mesh(tmp_path / "a.glb")
    np.testing.assert_array_equal(back.corner_uv, SQUARE[FACES][..., :2])
    assert back.n_vertices == 4
    write_mesh(tmp_path / "b.glb", Mesh(SQUARE, FACES))
    assert read_mesh(tmp_path / "b.glb").corner_uv is None


def test_trimesh_reads_our_obj(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    write_mesh(tmp_path / "a.obj", TORN, texture=PICTURE)
    theirs = trimesh.load_scene(tmp_path / "a.obj", process=False).to_mesh()
    np.testing.assert_array_equal(np.asarray(theirs.visual.material.image), PICTURE)
    np.testing.assert_allclose(theirs.visual.uv[theirs.faces], UV)


def test_bad_input_is_told_and_nothing_is_written(tmp_path):
    with pytest.raises(MeshError, match="a texture without texture coordinates"):
        write_mesh(tmp_path / "a.obj", Mesh(SQUARE, FACES), texture=PICTURE)
    for suffix in (".ply", ".off", ".stl", ".vtk"):
        with pytest.raises(UnknownNameError, match=r"\.obj"):
            write_mesh(tmp_path / f"a{suffix}", TORN, texture=PICTURE)
    with pytest.raises(DimensionError):
        write_mesh(tmp_path / "a.obj", TORN, texture=np.zeros((2, 2, 2)))
    with pytest.raises(DimensionError):
        write_mesh(tmp_path / "a.obj", TORN, uv=np.zeros((3, 2)), texture=PICTURE)
    (tmp_path / "bad.jpg").write_bytes(b"\xff\xd8")
    with pytest.raises(FileFormatError):
        write_mesh(tmp_path / "a.obj", TORN, texture=tmp_path / "bad.jpg")
    with pytest.raises(DimensionError):
        write_mesh(tmp_path / "a.obj", TORN, uv=np.zeros((3, 2)), texture=PICTURE)
    assert [path.name for path in tmp_path.iterdir()] == ["bad.jpg"]


@pytest.mark.parametrize("form", ["PNG", "JPEG", "BMP", "GIF"])
def test_a_picture_cut_off_anywhere_is_told(tmp_path, form):
    whole, part = tmp_path / "whole", tmp_path / "part"
    noise = np.random.default_rng(1).integers(0, 256, (32, 32, 3), dtype=np.uint8)
    Image.fromarray(noise).save(whole, form)
    raw = whole.read_bytes()
    assert as_picture(whole).shape == (32, 32, 3)
    for length in (0, 10, 40, 100, len(raw) // 2, len(raw) - 200):
        part.write_bytes(raw[:length])
        with pytest.raises(FileFormatError, match="expected a picture"):
            as_picture(part)
    with pytest.raises(FileNotFoundError):
        as_picture(tmp_path / "nowhere.png")


def test_pictures_of_sixteen_bits_and_of_floats_keep_their_grey(tmp_path):
    grey = np.linspace(0, 1, 12).reshape(3, 4)
    Image.fromarray(np.rint(grey * 65535).astype(np.uint16)).save(tmp_path / "grey.png")
    Image.fromarray(grey.astype(np.float32)).save(tmp_path / "grey.tif")
    for name in ("grey.png", "grey.tif"):
        found = as_picture(tmp_path / name)
        np.testing.assert_allclose(found, np.repeat(grey[..., None], 3, axis=2), atol=1e-5)
