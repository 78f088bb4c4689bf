"""Wrong outputs are told before the work."""

import os

import pytest

from beltrami.cli import outputs
from beltrami.errors import UnknownNameError

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
    ],
)
def test_each_verb_looks_before_it_reads(beltrami, arguments, tmp_path):
    verb, *rest = arguments
    done = beltrami(verb, tmp_path / "missing.obj", "-o", tmp_path / "out.xyz", *rest)
    assert done.exit_code == 1
    assert "'.xyz'" in done.stderr
    assert "missing.obj" not in done.stderr
