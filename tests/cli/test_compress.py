import json
import sys
from types import SimpleNamespace

import numpy as np
import pytest
from PIL import Image

import beltrami as bt
from beltrami.cli import curve
from beltrami.io.registry import read_mesh


def test_there_and_back(beltrami, sphere, tmp_path):
    small, back = tmp_path / "a.btm", tmp_path / "b.ply"
    done = beltrami(
        "compress", sphere, "-o", small, "--max-error", 0.01, "--keep-order", "--mode", "grid"
    )
    assert done.exit_code == 0, done.stderr
    assert f"{small.stat().st_size} bytes" in done.stdout
    assert "error at most 0.01" in done.stdout
    done = beltrami("decompress", small, "-o", back)
    assert done.exit_code == 0, done.stderr
    mesh = read_mesh(sphere)
    off = np.linalg.norm(read_mesh(back).vertices - mesh.vertices, axis=1)
    assert 0 < off.max() <= 0.01
    assert small.read_bytes() == bt.compress(mesh, max_error=0.01, keep_order=True, mode="grid")


def test_a_relative_error_is_a_part_of_the_diagonal(beltrami, sphere, tmp_path):
    small = tmp_path / "a.btm"
    done = beltrami(
        "compress",
        sphere,
        "-o",
        small,
        "--max-error",
        0.01,
        "--relative",
        "--json",
        "--mode",
        "grid",
    )
    facts = json.loads(done.stdout)
    diagonal = np.linalg.norm(np.ptp(read_mesh(sphere).vertices, axis=0))
    assert facts["max_error"] == pytest.approx(0.01 * diagonal, rel=1e-5)
    assert facts["original_size"] == sphere.stat().st_size


def test_exact_functions_and_texture_coordinates_say_what_they_cost(beltrami, tmp_path):
    mesh, rng = bt.shapes.icosphere(2), np.random.default_rng(0)
    small, bound = tmp_path / "a.btm", ("--max-error", 0.01)
    bt.write_mesh(tmp_path / "uv.obj", mesh, uv=rng.random((mesh.n_vertices, 2)))
    bt.write_mesh(tmp_path / "f.ply", mesh.with_data(f=rng.random(mesh.n_vertices)))
    for name, what, option in (
        ("uv.obj", "texture coordinates", ("--uv-error", 0.1)),
        ("f.ply", "functions", ("--function-error", "f=0.1")),
    ):
        words = ("compress", tmp_path / name, "-o", small, *bound)
        told = beltrami(*words).stdout
        large = small.stat().st_size
        assert f"of it are {what}, exactly: {option[0]} " in told
        assert "exactly" not in beltrami(*words, *option).stdout
        assert small.stat().st_size < large / 2
    bt.write_mesh(tmp_path / "m.ply", mesh)
    assert "exactly" not in beltrami("compress", tmp_path / "m.ply", "-o", small, *bound).stdout


def test_a_spectral_file_and_its_beginning(beltrami, sphere, tmp_path):
    small, part, back = tmp_path / "a.btm", tmp_path / "part.btm", tmp_path / "b.ply"
    done = beltrami("compress", sphere, "-o", small, "--mode", "spectral", "--terms", 30)
    assert done.exit_code == 0, done.stderr
    assert "mode spectral" in beltrami("info", small).stdout
    assert 0 < json.loads(beltrami("info", small, "--json").stdout)["terms"] <= 30
    part.write_bytes(small.read_bytes()[:-20])
    assert beltrami("decompress", part, "-o", back).exit_code == 1
    assert beltrami("decompress", part, "-o", back, "--partial").exit_code == 0
    assert read_mesh(back).n_faces == read_mesh(sphere).n_faces


def test_errors_of_functions(beltrami, sphere, tmp_path):
    given, small = tmp_path / "f.ply", tmp_path / "a.btm"
    mesh = read_mesh(sphere)
    height = mesh.vertices[:, 2]
    bt.write_mesh(given, bt.Mesh(mesh.vertices, mesh.faces, {"height": height}))
    done = beltrami("compress", given, "-o", small, "--function-error", "height=0.01")
    assert done.exit_code == 0, done.stderr
    off = bt.decompress(small).vertex_data["height"] - height[bt.vertex_order(mesh)]
    assert 0 < abs(off).max() <= 0.01
    for wrong in ("height", "height=x", "=3"):
        done = beltrami("compress", given, "-o", small, "--function-error", wrong)
        assert (done.exit_code, "expected NAME=ERROR" in done.stderr) == (2, True)


def test_info_tells_the_sections(beltrami, sphere, tmp_path):
    small = tmp_path / "a.btm"
    beltrami("compress", sphere, "-o", small, "--bits", 9, "--effort", "fast", "--keep-order")
    told = beltrami("info", small).stdout
    assert "162 vertices in 3 dimensions" in told
    assert "effort fast" in told
    assert "connectivity: " in told
    assert "the order of the vertices is kept" in told
    facts = json.loads(beltrami("info", small, "--json").stdout)
    sections = sum(section["bytes"] for section in facts["sections"])
    assert facts["size"] == small.stat().st_size == sections + 7


@pytest.mark.parametrize(
    ("arguments", "code", "text"),
    [
        (("--relative",), 2, "--relative belongs to --max-error"),
        (("--mode", "wavelets"), 1, "choose one of 'auto', 'grid', 'smooth', 'spectral'"),
        (("--terms", 3), 1, "they belong to the mode 'spectral'"),
        (("--effort", "bset"), 1, "Did you mean 'best'?"),
        (("--bits", 40), 1, "bits must be 1 to 30, not 40"),
    ],
)
def test_what_cannot_be_is_refused(beltrami, sphere, tmp_path, arguments, code, text):
    output = tmp_path / "a.btm"
    done = beltrami("compress", sphere, "-o", output, *arguments)
    assert done.exit_code == code
    assert text in done.stderr
    assert not output.exists()


def test_other_files_are_refused(beltrami, sphere, tmp_path):
    done = beltrami("compress", sphere, "-o", tmp_path / "a.zip")
    assert (done.exit_code, "'.btm'" in done.stderr) == (1, True)
    done = beltrami("decompress", sphere, "-o", tmp_path / "b.ply")
    assert (done.exit_code, "not a .btm file" in done.stderr) == (1, True)
    wrong = tmp_path / "a.btm"
    wrong.write_bytes(sphere.read_bytes())
    assert "not a .btm file" in beltrami("info", wrong).stderr


@pytest.fixture
def few_points(monkeypatch):
    points = {"grid": range(6, 9), "smooth": range(6, 9), "spectral": range(4, 7)}
    monkeypatch.setattr(curve, "POINTS", points)
    monkeypatch.setitem(sys.modules, "DracoPy", None)  # as if it were not installed


def test_the_curve_of_each_mode_has_more_bytes_and_less_error(beltrami, sphere, few_points):
    done = beltrami("compress", sphere, "--curve", "--effort", "fast", "--json")
    assert done.exit_code == 0, done.stderr
    rows = json.loads(done.stdout)
    assert [(row["mode"], row["bits"]) for row in rows] == [
        (mode, bits) for mode, grids in curve.POINTS.items() for bits in grids
    ]
    for mode in curve.POINTS:
        own = [row for row in rows if row["mode"] == mode]
        sizes, errors = [row["bytes"] for row in own], [row["rms"] for row in own]
        assert sizes == sorted(sizes)
        assert errors == sorted(errors, reverse=True)
        assert all(row["rms"] < row["largest"] for row in own)
        assert all(row["bits_per_vertex"] == 8 * row["bytes"] / 162 for row in own)
        assert {row["of_draco"] for row in own} == {None}
    mesh = bt.read_mesh(sphere)
    data = bt.compress(mesh, bits=5, mode="spectral", effort="fast")
    assert rows[7]["bytes"] == len(data)
    told = beltrami("compress", sphere, "--curve", "--effort", "fast").stdout.splitlines()
    assert len(told) == 1 + len(rows)
    assert told[1].split()[:3] == ["grid", "6", str(rows[0]["bytes"])]
    assert "Draco" not in told[0]


def test_draco_stands_beside_where_it_is_installed(beltrami, sphere, few_points, monkeypatch):
    def encode(*_, quantization_bits, compression_level, **__):
        return bytes(100 * compression_level * 2 ** (quantization_bits - 6))

    monkeypatch.setitem(sys.modules, "DracoPy", SimpleNamespace(encode=encode))
    done = beltrami("compress", sphere, "--curve", "--effort", "fast", "--json")
    rows = json.loads(done.stdout)
    grid, smooth, draco = (
        [row for row in rows if row["mode"] == mode] for mode in ("grid", "smooth", "draco")
    )
    assert [row["bytes"] for row in draco] == [500, 1000, 2000]
    assert [row["rms"] for row in draco] == [row["rms"] for row in grid]
    for one, other in zip(grid, draco, strict=True):
        assert one["of_draco"] == pytest.approx(one["bytes"] / other["bytes"])
    one = next(row for row in smooth if draco[2]["rms"] < row["rms"] < draco[0]["rms"])
    place = np.interp(np.log(one["rms"]), np.log([row["rms"] for row in draco[::-1]]), [2, 1, 0])
    assert one["of_draco"] == pytest.approx(one["bytes"] / (500 * 2**place))
    told = beltrami("compress", sphere, "--curve", "--effort", "fast").stdout
    assert "of Draco's bytes for that error" in told


def test_the_curve_is_drawn(beltrami, sphere, few_points, tmp_path):
    pytest.importorskip("matplotlib")
    picture = tmp_path / "curve.png"
    done = beltrami("compress", sphere, "--curve", "--effort", "fast", "-o", picture)
    assert done.exit_code == 0, done.stderr
    assert f"wrote {picture}" in done.stdout
    colors = {tuple(color) for color in np.asarray(Image.open(picture)).reshape(-1, 3).tolist()}
    assert {(0, 114, 178), (213, 94, 0), (0, 158, 115)} <= colors  # a line for each mode


def test_a_curve_is_no_file_of_a_mesh(beltrami, sphere, few_points, tmp_path):
    done = beltrami("compress", sphere, "--curve", "-o", tmp_path / "a.btm")
    assert (done.exit_code, ".btm" in done.stderr) == (1, True)


def test_an_output_is_needed(beltrami, sphere):
    done = beltrami("compress", sphere)
    assert (done.exit_code, "-o FILE" in done.stderr) == (2, True)
