import numpy as np
import pytest
from PIL import Image

from beltrami.display.render import render
from beltrami.io.registry import read_mesh, write_mesh
from beltrami.mesh.shapes import icosphere


def test_several_meshes_side_by_side(beltrami, sphere, tmp_path):
    output = tmp_path / "p.png"
    done = beltrami("render", sphere, sphere, "-o", output, "--size", 90, 60)
    assert done.exit_code == 0, done.stderr
    with Image.open(output) as picture:
        width, height = picture.size
        assert width == 180
        assert height > 60  # captions
    beltrami("render", sphere, sphere, "-o", output, "--size", 90, 60, "--no-captions")
    with Image.open(output) as picture:
        assert picture.size == (180, 60)


def test_a_function_gives_colours(beltrami, sphere, tmp_path):
    np.save(tmp_path / "f.npy", read_mesh(sphere).vertices[:, 1])
    output = tmp_path / "p.png"
    beltrami("render", sphere, "--data", tmp_path / "f.npy", "-o", output, "--size", 90, 60)
    with Image.open(output) as picture:
        red, _, blue = np.asarray(picture.convert("RGB"), dtype=int)[:60].transpose(2, 0, 1)
    assert (red - blue).max() > 60  # diverging: red where it is positive ...
    assert (blue - red).max() > 60  # ... blue where it is negative


def test_missing_values_have_the_colour_that_is_asked_for(beltrami, sphere, tmp_path):
    f = read_mesh(sphere).vertices[:, 1] + 2
    f[f > 2] = np.nan
    np.save(tmp_path / "f.npy", f)
    given = ("render", sphere, "--data", tmp_path / "f.npy", "-o", tmp_path / "p.png")
    done = beltrami(*given)
    assert done.exit_code == 1
    assert "NaN" in done.stderr
    assert beltrami(*given, "--missing", "#00ff00", "--size", 90, 60).exit_code == 0
    with Image.open(tmp_path / "p.png") as picture:
        red, green, blue = np.asarray(picture.convert("RGB"), dtype=int)[:60].transpose(2, 0, 1)
    assert ((green > 60) & (red == 0) & (blue == 0)).any()


@pytest.mark.parametrize(
    ("arguments", "code", "text"),
    [
        (("--colormap", "viridis"), 2, "--data"),
        (("--limits", 0, 1), 2, "--data"),
        (("--up", "w"), 1, "'x', 'y', 'z'"),
        (("--zoom", 0), 1, "zoom"),
        (("--size", 0, 0), 1, "size"),
    ],
)
def test_options_that_do_not_fit(beltrami, sphere, tmp_path, arguments, code, text):
    done = beltrami("render", sphere, "-o", tmp_path / "p.png", *arguments)
    assert done.exit_code == code
    assert text in done.stderr
    assert not (tmp_path / "p.png").exists()


def test_a_texture(beltrami, tmp_path):
    from beltrami.io.registry import write_mesh
    from beltrami.mesh.mesh import Mesh

    corners = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    placed = Mesh(corners, faces, corner_uv=corners[faces][..., :2])
    write_mesh(tmp_path / "a.obj", placed, texture=np.broadcast_to([1.0, 0, 0], (2, 2, 3)))
    output = tmp_path / "p.png"
    for texture, colours in ((tmp_path / "a.png", 1), ("checkerboard", 2)):
        words = ("-o", output, "--size", 60, 60, "--view", 0, 0, "--texture", texture)
        done = beltrami("render", tmp_path / "a.obj", *words)
        assert done.exit_code == 0, done.stderr
        with Image.open(output) as picture:
            middle = np.asarray(picture.convert("RGB"), dtype=int)[20:40, 20:40].reshape(-1, 3)
        reds = np.unique(middle[:, 1] < 40)
        assert len(reds) == 1
        assert reds[0] == (colours == 1)
    done = beltrami("render", tmp_path / "a.obj", "-o", output, "--texture", tmp_path / "no.png")
    assert done.exit_code == 1


@pytest.mark.parametrize("columns", [3, 4])
def test_colours_of_a_file_are_drawn_as_they_are(beltrami, tmp_path, columns):
    """Bytes, as scanners write them, are fractions of 255; opacity is left out."""
    ball = icosphere(1)
    colours = np.tile(np.array([255, 128, 0, 64], np.uint8)[:columns], (ball.n_vertices, 1))
    write_mesh(tmp_path / "a.ply", ball.with_data(color=colours))
    words = ("--size", 32, 32, "-o", tmp_path / "a.png")
    done = beltrami("render", tmp_path / "a.ply", "--data", tmp_path / "a.ply", *words)
    assert done.exit_code == 0, done.stderr
    render(ball, colours[:, :3], tmp_path / "b.png", size=(32, 32))
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()
    write_mesh(tmp_path / "b.ply", ball.with_data(color=colours / 255.0))
    done = beltrami("render", tmp_path / "b.ply", "--data", tmp_path / "b.ply", *words)
    assert done.exit_code == 0, done.stderr
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()
