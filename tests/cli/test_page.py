import numpy as np
import pytest
from PIL import Image

from beltrami.io.registry import read_mesh, write_mesh
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import icosphere


def test_a_page_is_written(beltrami, sphere, tmp_path):
    np.save(tmp_path / "warmth.npy", read_mesh(sphere).vertices[:, 1])
    output = tmp_path / "p.html"
    done = beltrami(
        "page", sphere, "-o", output, "-k", 9, "--noise", 0, "--data", tmp_path / "warmth.npy",
        "--weights", "cotangent", "--unit", "mm",
    )  # fmt: skip
    assert done.exit_code == 0, done.stderr
    assert "MB" in done.stdout
    assert "without the comparison" in done.stdout
    text = output.read_text("utf-8")
    assert "<title>a sphere é</title>" in text
    assert '"name":"warmth"' in text
    assert '"unit":"mm"' in text
    assert text.count('"kind":') == 1


def test_a_texture_from_a_file_and_a_pattern(beltrami, sphere, tmp_path):
    write_picture(tmp_path / "map.jpg")
    for texture, told in ((tmp_path / "map.jpg", '"kind":"image/png"'), ("checkerboard", "null")):
        done = beltrami(
            "page", sphere, "-o", tmp_path / "p.html", "-k", 4, "--noise", 0, "--texture", texture
        )
        assert done.exit_code == 0, done.stderr
        text = (tmp_path / "p.html").read_text("utf-8")
        assert '"textured":true' in text
        assert f'"picture":{{{told}' in text or f'"picture":{told}' in text


def write_picture(path):
    Image.new("RGB", (8, 6), "teal").save(path)


@pytest.mark.parametrize(
    ("arguments", "code", "text"),
    [
        (("--texture", "gone.png"), 1, "gone.png"),
        (("--texture", "checkerboard", "--no-plane"), 1, "texture coordinates"),
        (("--data-name", "x"), 2, "--data"),
        (("--up", "w"), 1, "'x', 'y', 'z'"),
        (("--weights", "cotan"), 1, "cotangent"),
        (("--noise", "-1"), 1, "noise"),
        (("-k", 0), 2, "Error"),
    ],
)
def test_options_that_do_not_fit(beltrami, sphere, tmp_path, arguments, code, text):
    done = beltrami("page", sphere, "-o", tmp_path / "p.html", *arguments)
    assert done.exit_code == code
    assert text in done.stderr
    assert not (tmp_path / "p.html").exists()


def test_the_output_is_checked_before_the_work(beltrami, sphere, tmp_path):
    assert beltrami("page", sphere, "-o", tmp_path / "p.png").exit_code == 1
    assert beltrami("page", sphere, "-o", tmp_path / "gone" / "p.html").exit_code == 1
    assert beltrami("page", sphere, "-o", tmp_path).exit_code == 1


def test_a_mesh_with_a_stray_vertex_names_the_remedy(beltrami, stray, tmp_path):
    done = beltrami("page", stray, "-o", tmp_path / "p.html")
    assert done.exit_code == 1
    assert "repair" in done.stderr


def test_why_something_is_missing_is_said_in_commands(beltrami, tmp_path):
    faces = icosphere(1).faces.copy()
    faces[5] = faces[5, ::-1]
    write_mesh(tmp_path / "turned.ply", Mesh(icosphere(1).vertices, faces))
    done = beltrami(
        "page", tmp_path / "turned.ply", "-o", tmp_path / "p.html", "-k", 5, "--no-plane"
    )
    assert done.exit_code == 0, done.stderr
    assert "`beltrami repair --orient`" in done.stdout
