"""The table of sizes: it measures what comes back, and refuses what does not."""

import numpy as np
import pytest
from benchmarks.compressing import measure, same_faces
from benchmarks.compression import main
from benchmarks.compression_bounds import measure_within
from benchmarks.compression_report import geometric_mean
from benchmarks.mesh_errors import bytes_at, measure_errors

import beltrami as bt
from benchmarks import compression, compression_bounds, other_codecs


@pytest.fixture
def without_draco(monkeypatch):
    monkeypatch.setattr(other_codecs, "draco", lambda mesh, bits: 1000 * bits)
    monkeypatch.setattr(other_codecs, "draco_seconds", lambda mesh, bits: (0.1, 0.2))
    monkeypatch.setattr(other_codecs, "draco_connectivity", lambda mesh: 500)


def test_a_mesh_is_measured(without_draco):
    mesh = bt.shapes.icosphere(2)
    one = measure("sphere", mesh, 9, "fast")
    assert one.ours == len(bt.compress(mesh, bits=9, effort="fast"))
    assert one.ratio == one.ours / 9000
    step = np.ptp(mesh.vertices, axis=0).max() / 511
    diagonal = np.linalg.norm(np.ptp(mesh.vertices, axis=0))
    assert one.errors.rms == pytest.approx(step / 2 / diagonal, rel=0.15)  # uniform, in 3-D


def test_a_mesh_that_does_not_come_back_has_no_ratio(without_draco, monkeypatch):
    mesh = bt.shapes.icosphere(1)
    honest = bt.decompress
    monkeypatch.setattr(
        bt, "decompress", lambda data: honest(data).with_vertices(honest(data).vertices[::-1])
    )
    with pytest.raises(RuntimeError, match="does not come back"):
        measure("sphere", mesh, 9, "fast")


def test_faces_are_the_same_up_to_order_and_first_corner():
    faces = np.array([[0, 1, 2], [2, 1, 3]])
    assert same_faces(faces, np.array([[3, 2, 1], [1, 2, 0]]))
    assert not same_faces(faces, np.array([[3, 1, 2], [1, 2, 0]]))


def test_means_and_lines_are_of_logarithms():
    assert geometric_mean([2, 8]) == pytest.approx(4)
    curve = [(1.0, 100), (0.01, 10_000)]
    assert bytes_at(0.1, curve) == pytest.approx(1000)
    assert bytes_at(7.0, curve) == pytest.approx(100)
    assert bytes_at(0.001, curve) == np.inf  # a finer error than any of the curve


def test_errors_are_what_they_say():
    mesh = bt.shapes.grid(6, 6)
    flat = bt.Mesh(np.column_stack([mesh.vertices, np.zeros(mesh.n_vertices)]), mesh.faces)
    diagonal = np.linalg.norm(np.ptp(flat.vertices, axis=0))
    moved = measure_errors(flat, flat.vertices + np.array([0, 0, 0.3]))
    assert moved.rms == pytest.approx(0.3 / diagonal)
    assert moved.largest == pytest.approx(0.3 / diagonal)
    assert moved.visual == pytest.approx(0.15 / diagonal)  # a translation has no Laplacian
    assert moved.angle == 0
    tilted = flat.vertices + np.outer(flat.vertices[:, 0], [0, 0, 1])
    assert measure_errors(flat, tilted).angle == pytest.approx(45)
    rough = flat.vertices + np.outer(np.arange(flat.n_vertices) % 2, [0, 0, 0.1])
    assert measure_errors(flat, rough).visual > measure_errors(flat, rough).rms


@pytest.fixture
def small_file(tmp_path):
    bt.write_mesh(tmp_path / "a.ply", bt.shapes.icosphere(1))
    return tmp_path / "a.ply"


def test_the_tables_are_printed(without_draco, small_file, capsys, monkeypatch):
    monkeypatch.setattr(compression, "TIMED_FILES", ("a.ply",))
    monkeypatch.setattr(compression, "BOUNDED_FILES", ("a.ply",))
    monkeypatch.setattr(compression, "BLOB", 500)
    monkeypatch.setattr(compression_bounds, "ERRORS", ("1e-2", "1e-4"))
    arguments = [str(small_file), "--bits", "5", "7", "--effort", "fast", "--runs", "1"]
    assert main(arguments) == 0
    printed = capsys.readouterr().out
    assert "| bits per vertex (ratio) | 5 bits | 7 bits |" in printed
    assert printed.count("| ratio, mode | 5 bits | 7 bits |") == 4
    for name in ("RMS distance of the vertices", "normal angle", "largest distance"):
        assert f"## At equal {name}" in printed
    assert "| mesh, bits | ours | Draco | meshopt + zstd | xz |" in printed
    assert "| same grid, 7 bits |" in printed
    assert "(goal 0.65)" in printed
    assert "(goal 0.50)" in printed
    assert "| connectivity, worst (a.ply) |" in printed
    assert "| seconds for 100k vertices, fast: slowest (" in printed
    assert "| auto, error 1e-3, best | " in printed
    assert "| error, effort, mode | a.ply | blob(500) |" in printed
    assert printed.count("\n| 1e-4, fast, auto | ") == 1
    for effort in ("best", "fast"):
        assert f"| seconds for 100k vertices within a bound, {effort} (" in printed


def test_a_file_beyond_its_bound_is_not_counted(monkeypatch):
    """Were the bound not kept, there would be no seconds of it."""
    mesh = bt.shapes.icosphere(2)
    one = measure_within("sphere", mesh, "1e-3", "auto", "fast")
    assert one.size == len(
        bt.compress(
            mesh, max_error=1e-3 * np.linalg.norm(np.ptp(mesh.vertices, axis=0)), effort="fast"
        )
    )
    honest = bt.compress
    monkeypatch.setattr(
        bt,
        "compress",
        lambda mesh, max_error, **options: honest(mesh, max_error=3 * max_error, **options),
    )
    with pytest.raises(RuntimeError, match="farther off than 1e-3 in the mode grid"):
        measure_within("sphere", mesh, "1e-3", "grid", "fast")


def test_what_was_kept_is_not_measured_again(without_draco, small_file, tmp_path, monkeypatch):
    folder, report = tmp_path / "kept", tmp_path / "report.md"
    arguments = [str(small_file), "--bits", "7", "--effort", "fast", "--folder", str(folder)]
    assert main([*arguments, "--output", str(report)]) == 0
    first = report.read_text()

    def broken(name, *rest):
        assert name == "to compile"

    monkeypatch.setattr(compression, "measure", broken)
    assert main([*arguments, "--output", str(report)]) == 0
    assert report.read_text() == first
