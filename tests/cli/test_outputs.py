"""Wrong outputs are told before the work."""

import os

import pytest

from beltrami.cli import outputs
from beltrami.errors import UnknownNameError
from beltrami.io.registry import write_mesh
from beltrami.mesh.shapes import icosphere

CHECKS = {
    "mesh": (outputs.check_mesh_output, ".obj"),
    "values": (outputs.check_values_output, ".npy"),
    "picture": (outputs.check_picture_output, ".png"),
}


@pytest.mark.parametrize(("check", "suffix"), CHECKS.values(), ids=CHECKS)
def test_places(check, suffix, tmp_path):
    check(tmp_path / f"new{suffix}")
    (tmp_path / f"old{suffix}").touch()
    check(tmp_path / f"old{suffix}")
    with pytest.raises(UnknownNameError, match=suffix):
        check(tmp_path / "new.xyz")
    with pytest.raises(FileNotFoundError, match="No such folder"):
        check(tmp_path / "nowhere" / f"new{suffix}")
    (tmp_path / f"folder{suffix}").mkdir()
    with pytest.raises(IsADirectoryError):
        check(tmp_path / f"folder{suffix}")
    assert sorted(os.listdir(tmp_path)) == [f"folder{suffix}", f"old{suffix}"]


@pytest.mark.parametrize(("check", "suffix"), CHECKS.values(), ids=CHECKS)
def test_a_folder_that_cannot_be_written(check, suffix, tmp_path, monkeypatch):
    monkeypatch.setattr(os, "access", lambda *_: False)  # a superuser may write anywhere
    with pytest.raises(PermissionError, match="cannot be written"):
        check(tmp_path / f"new{suffix}")


@pytest.mark.parametrize(
    "arguments",
    [
        ("smooth",),
        ("heat", "--time", 1, "--source", 0),
        ("render",),
        ("repair", "--all"),
        ("smooth", "--data", "f.npy"),
        ("wave", "--time", 1, "--bump", 0),
        ("regularize", "--time", 1, "--data", "f.npy"),
    ],
)
def test_each_verb_looks_before_it_reads(beltrami, arguments, tmp_path):
    verb, *rest = arguments
    done = beltrami(verb, tmp_path / "missing.obj", "-o", tmp_path / "out.xyz", *rest)
    assert done.exit_code == 1
    assert "'.xyz'" in done.stderr
    assert "missing.obj" not in done.stderr


def test_frames_go_to_a_file_or_a_folder(tmp_path, monkeypatch):
    for suffix in (".npy", ".gif", ".webp", ""):
        assert outputs.check_frames_output(tmp_path / f"new{suffix}") == suffix
    (tmp_path / "v1.5").mkdir()
    assert outputs.check_frames_output(tmp_path / "v1.5") == ""
    with pytest.raises(UnknownNameError, match="a folder has no suffix"):
        outputs.check_frames_output(tmp_path / "new.png")
    with pytest.raises(FileNotFoundError, match="No such folder"):
        outputs.check_frames_output(tmp_path / "nowhere" / "new")
    assert sorted(os.listdir(tmp_path)) == ["v1.5"]
    monkeypatch.setattr(os, "access", lambda *_: False)
    for name in ("v1.5", "new", "new.npy"):
        with pytest.raises(PermissionError, match="cannot be written"):
            outputs.check_frames_output(tmp_path / name)


@pytest.mark.parametrize("name", ["a.obj", "a.glb", "a.GLB.gz", "a.ply", "a.gii"])
def test_what_can_be_written_is_a_name_for_a_mesh(tmp_path, name):
    outputs.check_mesh_output(tmp_path / name)
    write_mesh(tmp_path / name, icosphere(0))
    with pytest.raises(UnknownNameError, match=r"\.glb"):
        outputs.check_mesh_output(tmp_path / "a.gltf")
