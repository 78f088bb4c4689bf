import json

import numpy as np
import pytest

from beltrami.io.registry import read_mesh, write_mesh
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import cylinder, grid, icosphere, torus
from beltrami.mesh.tree_cotree import cut_to_disk
from beltrami.parameterization.flatten import flatten
from beltrami.parameterization.parameterize import parameterize
from meshes_of_the_errata import flipped


@pytest.fixture
def ring(tmp_path):
    path = tmp_path / "ring.obj"
    write_mesh(path, torus(12, 8))
    return path


@pytest.mark.parametrize(
    ("words", "options"),
    [
        ((), {}),
        (("--boundary", "square", "--bulge", 0.02), {"boundary": "square", "bulge": 0.02}),
        (("--spacing", "uniform", "--method", "tutte"), {"spacing": "uniform", "method": "tutte"}),
        (("--boundary", 5, "--bulge", 0.01), {"boundary": 5, "bulge": 0.01}),
        (("--weights", "combinatorial", "--seams", 1), {"weights": "combinatorial", "seams": 1}),
    ],
)
def test_it_writes_what_parameterize_returns(beltrami, ring, tmp_path, words, options):
    done = beltrami("parameterize", ring, "-o", tmp_path / "out.obj", *words)
    assert done.exit_code == 0, done.stderr
    found = parameterize(read_mesh(ring), **options)
    back = read_mesh(tmp_path / "out.obj")
    np.testing.assert_array_equal(back.corner_uv, found.textured.corner_uv)
    np.testing.assert_array_equal(back.faces, torus(12, 8).faces)
    assert "certificate: a bijection; 0 of 192 faces flipped" in done.stdout
    assert f"{len(found.cut_edges)} edges cut" in done.stdout
    assert f"symmetric Dirichlet {found.distortion.symmetric_dirichlet:.4g}" in done.stdout


def test_holes_may_stay_holes(beltrami, tmp_path):
    path, out = tmp_path / "pipe.obj", tmp_path / "out.obj"
    write_mesh(path, cylinder(12, 4))
    done = beltrami("parameterize", path, "-o", out, "--fill-holes", "--no-cut")
    assert done.exit_code == 0, done.stderr
    assert "0 edges cut" in done.stdout
    assert "certificate: a bijection" in done.stdout


def test_json(beltrami, ring, tmp_path):
    done = beltrami("parameterize", ring, "-o", tmp_path / "out.obj", "--json")
    found = parameterize(read_mesh(ring))
    told = json.loads(done.stdout)
    assert told["bijective"] is True
    assert told["flipped"] == []
    assert told["cut_edges"] == found.cut_edges.tolist()
    assert told["area"] == found.distortion.mean_area


def test_glb_holds_what_is_certified_in_single_precision(beltrami, ring, tmp_path):
    pytest.importorskip("trimesh")
    out = tmp_path / "out.glb"
    done = beltrami("parameterize", ring, "-o", out, "--json")
    assert done.exit_code == 0, done.stderr
    assert json.loads(done.stdout)["bijective_as_written"] is True
    found = parameterize(read_mesh(ring)).textured
    back = read_mesh(out)
    np.testing.assert_allclose(back.corner_uv, found.corner_uv, atol=2e-7)


def test_what_folds_only_when_rounded_is_told(beltrami, tmp_path):
    pytest.importorskip("trimesh")
    closed = cylinder(12, 60, height=30, caps=True)
    write_mesh(tmp_path / "tube.obj", Mesh(closed.vertices, closed.faces[1:]))
    words = ("parameterize", tmp_path / "tube.obj", "--method", "tutte", "--no-cut")
    for out, rounded in (("out.obj", False), ("out.glb", True)):
        done = beltrami(*words, "-o", tmp_path / out)
        assert done.exit_code == 0, done.stderr
        assert "certificate: a bijection" in done.stdout
        assert ("rounded to the 32 bits of GLB it is none" in done.stderr) == rounded


def test_folds_are_an_error_unless_allowed(beltrami, tmp_path):
    path, out = tmp_path / "wild.obj", tmp_path / "out.obj"
    write_mesh(path, flipped(1, 40, 10))
    words = ("parameterize", path, "-o", out, "--method", "tutte", "--weights", "cotangent")
    done = beltrami(*words)
    assert done.exit_code == 1
    assert "the map folds: 2 of" in done.stderr
    assert not out.exists()
    done = beltrami(*words, "--allow-folds")
    assert done.exit_code == 0
    assert "NOT a bijection; 2 of" in done.stdout
    assert out.exists()


def test_flatten(beltrami, tmp_path):
    for mesh, verdict in ((grid(8, 7), "a bijection"), (cylinder(12, 20, height=20), "NOT a bij")):
        write_mesh(tmp_path / "in.obj", mesh)
        done = beltrami("flatten", tmp_path / "in.obj", "-o", tmp_path / "out.obj")
        assert done.exit_code == 0, done.stderr
        assert f"certificate: {verdict}" in done.stdout
        found = flatten(read_mesh(tmp_path / "in.obj"))
        back = read_mesh(tmp_path / "out.obj")
        np.testing.assert_array_equal(back.corner_uv, found.textured.corner_uv)


def test_cut(beltrami, ring, tmp_path):
    done = beltrami("cut", ring, "-o", tmp_path / "out.ply")
    assert done.exit_code == 0, done.stderr
    found = cut_to_disk(read_mesh(ring))
    assert f"cut {len(found.edges)} edges: 1 disk" in done.stdout
    back = read_mesh(tmp_path / "out.ply")
    np.testing.assert_array_equal(back.faces, found.mesh.faces)
    done = beltrami("cut", ring, "-o", tmp_path / "out.ply", "--json")
    assert json.loads(done.stdout)["vertex_map"] == found.vertex_map.tolist()


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (("-o", "out.ply"), "format for texture coordinates '.ply': choose one of '.obj', '.glb'"),
        (("-o", "out.gltf"), "texture coordinates '.gltf': choose one of '.obj', '.glb'"),
        (("-o", "out.obj", "--boundary", "triangle"), "boundary curve"),
        (("-o", "out.obj", "--boundary", "2"), "2 sides"),
        (("-o", "out.obj", "--boundary", "square"), "bend the sides a little (--bulge 0.01)"),
        (("-o", "out.obj", "--no-cut"), "Allow it by leaving out --no-cut"),
        (("-o", "out.obj", "--method", "lscm"), "method of parameterisation"),
    ],
)
def test_what_cannot_be_done_is_one_line(beltrami, ring, tmp_path, monkeypatch, words, text):
    monkeypatch.chdir(tmp_path)
    done = beltrami("parameterize", ring, *words)
    assert done.exit_code == 1
    assert text in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
    assert not (tmp_path / "out.obj").exists()


def test_a_surface_with_one_side(beltrami, tmp_path):
    sphere = icosphere(1)
    turned = sphere.faces.copy()
    turned[0] = turned[0][::-1]
    write_mesh(tmp_path / "in.obj", Mesh(sphere.vertices, turned))
    done = beltrami("parameterize", tmp_path / "in.obj", "-o", tmp_path / "out.obj")
    assert done.exit_code == 1
    assert "outside" in done.stderr
