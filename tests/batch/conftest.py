"""Meshes in a folder, and the table that a batch has made of them."""

from __future__ import annotations

import json

import pyarrow.parquet
import pytest

from beltrami.io.registry import write_mesh
from beltrami.mesh.shapes import torus


@pytest.fixture
def meshes(tmp_path):
    """Write three good meshes and two files that are none; return their folder."""
    folder = tmp_path / "in"
    folder.mkdir()
    for i in range(3):
        write_mesh(folder / f"{i}.ply", torus(12 + i, 7))
    (folder / "bad.ply").write_bytes(b"ply\nformat ascii 1.0\nelement vertex 3\n")
    (folder / "notes.txt").write_text("no mesh")
    return folder


@pytest.fixture
def table():
    """Return the rows of a folder of results, by source."""

    def rows(out):
        found = pyarrow.parquet.read_table(out / "results.parquet").to_pylist()
        names = [row["source"] for row in found]
        assert len(names) == len(set(names)), "a mesh has two rows"
        return {name.rpartition("/")[2]: row for name, row in zip(names, found, strict=True)}

    return rows


@pytest.fixture
def manifest():
    """Return the head and the lines of a manifest, by source."""

    def read(out):
        head, *lines = map(json.loads, (out / "manifest.jsonl").read_text("utf-8").splitlines())
        return head, {line["source"].rpartition("/")[2]: line for line in lines}

    return read
