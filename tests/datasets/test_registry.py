"""The registry says what is true of the files, and leaves out what has no licence of its own."""

import json
import os
from pathlib import Path

import pytest

import beltrami as bt

FOLDER = os.environ.get("BELTRAMI_MESHES", "")
NAMES = bt.datasets.names()
real = pytest.mark.skipif(not FOLDER, reason="BELTRAMI_MESHES names no folder")


@pytest.mark.parametrize("name", NAMES)
def test_rows(name):
    row = bt.datasets.describe(name)
    assert row.name == name
    assert row.url.startswith("https://")
    assert row.url.endswith(f"/{row.file}")
    assert len(bytes.fromhex(row.sha256)) == 32
    assert len(row.url.split("/")[5]) == 40  # a commit: what is there does not change
    assert row.licence in ("public domain", "CC BY 4.0")
    assert row.author


@pytest.mark.meshes
@real
@pytest.mark.parametrize("name", NAMES)
def test_facts(name, monkeypatch):
    monkeypatch.setenv("BELTRAMI_DATA", FOLDER)
    row, mesh = bt.datasets.describe(name), bt.datasets.load(name)
    assert bt.datasets.fetch(name).stat().st_size == row.size
    assert (mesh.n_vertices, mesh.n_faces) == (row.vertices, row.faces)
    assert (mesh.genus, len(mesh.boundary_loops)) == (row.genus, row.boundary_loops)


@pytest.mark.meshes
@real
def test_the_registry_has_every_mesh_with_a_licence_of_its_own_and_no_other():
    path = Path(FOLDER, "MANIFEST.json")
    if not path.is_file():
        pytest.skip("the folder has no MANIFEST.json")
    files = json.loads(path.read_text(encoding="utf-8"))["files"]
    stated = {row["file"]: row for row in files if row["licence_scope"] == "object" and row["raw"]}
    rows = {bt.datasets.describe(name).file: bt.datasets.describe(name) for name in NAMES}
    assert rows.keys() == stated.keys()
    for file, row in rows.items():
        found = stated[file]
        repository, _, inside = found["raw"].partition(":")
        owner, _, commit = repository.partition("@")
        assert row.url == f"https://raw.githubusercontent.com/{owner}/{commit}/{inside}"
        assert (row.sha256, row.size) == (found["sha256"], found["bytes"])
        assert found["licence"].startswith(row.licence)
