import json

import numpy as np
import pytest

from beltrami.display.bake import bake, colorize
from beltrami.display.texture import checkerboard
from beltrami.io.picture import as_picture
from beltrami.io.registry import read_mesh, write_mesh
from beltrami.mesh.shapes import cylinder, icosphere, torus
from beltrami.parameterization.atlas import atlas


@pytest.fixture
def ball(tmp_path):
    path = tmp_path / "ball.obj"
    write_mesh(path, icosphere(2))
    return path


def test_it_writes_what_atlas_returns(beltrami, ball, tmp_path):
    done = beltrami("atlas", ball, "-o", tmp_path / "out.obj", "--size", 256, "--count", 3)
    assert done.exit_code == 0, done.stderr
    found = atlas(read_mesh(ball), 3, size=256)
    back = read_mesh(tmp_path / "out.obj")
    np.testing.assert_array_equal(back.corner_uv, found.uv)
    assert f"atlas: 3 charts, {len(found.seams)} edges cut" in done.stdout
    assert "certificate: no overlap; 0 of 320 faces flipped, 0 crossings" in done.stdout
    assert f"of the worst chart {found.chart_distortion.max():.4g}" in done.stdout
    assert not (tmp_path / "out.mtl").exists()


def test_a_checkerboard(beltrami, ball, tmp_path):
    words = ("-o", tmp_path / "out.obj", "--size", 64, "--texture", "checkerboard")
    done = beltrami("atlas", ball, *words)
    assert done.exit_code == 0, done.stderr
    np.testing.assert_allclose(as_picture(tmp_path / "out.png"), checkerboard(64), atol=1 / 255)


def test_a_picture_of_the_user(beltrami, ball, tmp_path):
    write_mesh(tmp_path / "x.obj", read_mesh(ball), np.zeros((162, 2)), checkerboard(8))
    words = ("-o", tmp_path / "out.glb", "--texture", tmp_path / "x.png")
    done = beltrami("atlas", ball, *words)
    assert done.exit_code == 0, done.stderr
    assert read_mesh(tmp_path / "out.glb").corner_uv.shape == (320, 3, 2)
    done = beltrami("atlas", ball, "-o", tmp_path / "out.glb", "--texture", tmp_path / "no.png")
    assert done.exit_code == 1


def test_functions_are_baked(beltrami, ball, tmp_path):
    f = read_mesh(ball).vertices[:, 0]
    np.save(tmp_path / "f.npy", f)
    words = ("-o", tmp_path / "out.obj", "--size", 64, "--data", tmp_path / "f.npy")
    done = beltrami("atlas", ball, *words, "--limits", -2, 2)
    assert done.exit_code == 0, done.stderr
    expected = colorize(bake(atlas(read_mesh(ball), size=64), f), None, (-2.0, 2.0))
    np.testing.assert_allclose(as_picture(tmp_path / "out.png") * 255, expected)


def test_colours_are_baked(beltrami, tmp_path):
    ball = icosphere(2)
    colours = np.random.default_rng(0).integers(0, 256, (ball.n_vertices, 4), dtype=np.uint8)
    write_mesh(tmp_path / "a.ply", ball.with_data(color=colours))
    words = ("-o", tmp_path / "out.obj", "--size", 64, "--data", tmp_path / "a.ply")
    done = beltrami("atlas", tmp_path / "a.ply", *words)
    assert done.exit_code == 0, done.stderr
    expected = np.rint(255 * bake(atlas(ball, size=64), colours[:, :3]))
    np.testing.assert_allclose(as_picture(tmp_path / "out.png") * 255, expected, atol=1e-9)


def test_what_cannot_be_baked_is_told_before_the_work(beltrami, ball, tmp_path, monkeypatch):
    monkeypatch.setattr("beltrami.parameterization.atlas.atlas", None)
    np.save(tmp_path / "f.npy", np.zeros((162, 2)))
    done = beltrami("atlas", ball, "-o", tmp_path / "out.obj", "--data", tmp_path / "f.npy")
    assert done.exit_code == 1
    assert "a function with 2 columns cannot be drawn" in done.stderr


def test_holes_are_kept_or_cut(beltrami, tmp_path):
    write_mesh(tmp_path / "ring.obj", cylinder(12, 3))
    words = ("atlas", tmp_path / "ring.obj", "-o", tmp_path / "out.obj", "--max-distortion", 2)
    assert "atlas: 1 chart, 0 edges cut" in beltrami(*words).stdout
    assert "atlas: 1 chart" not in beltrami(*words, "--cut-holes").stdout


def test_json(beltrami, ball, tmp_path):
    done = beltrami("atlas", ball, "-o", tmp_path / "out.obj", "--json")
    told = json.loads(done.stdout)
    assert told["bijective"] is True
    assert told["charts"] == 2
    assert len(told["labels"]) == 320
    assert told["flipped"] == told["crossings"] == []


def test_bad_requests(beltrami, ball, tmp_path):
    assert beltrami("atlas", ball, "-o", tmp_path / "out.ply").exit_code == 1
    assert beltrami("atlas", ball, "-o", tmp_path / "out.obj", "--size", 3).exit_code == 1
    board = ("--size", 10**7, "--texture", "checkerboard")  # refused, not drawn
    refused = beltrami("atlas", ball, "-o", tmp_path / "out.obj", *board)
    assert (refused.exit_code, "65536" in refused.stderr) == (1, True)
    words = ("atlas", ball, "-o", tmp_path / "out.obj")
    assert beltrami(*words, "--max-distortion", 1).exit_code == 1
    assert beltrami(*words, "--colormap", "gray").exit_code == 2
    np.save(tmp_path / "f.npy", np.zeros(3))
    assert beltrami(*words, "--data", tmp_path / "f.npy").exit_code == 1
    both = ("--data", tmp_path / "f.npy", "--texture", "checkerboard")
    assert beltrami(*words, *both).exit_code == 2
    assert not (tmp_path / "out.obj").exists()


def test_parameterize_prints_the_certificate_of_closed_surfaces(beltrami, tmp_path):
    write_mesh(tmp_path / "ring.obj", torus(12, 8))
    done = beltrami("parameterize", tmp_path / "ring.obj", "-o", tmp_path / "out.obj")
    assert done.exit_code == 0, done.stderr
    assert "certificate: a bijection" in done.stdout
    assert "20 edges cut" in done.stdout
