"""The real files of a folder, against what its manifest says of them."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest

from beltrami.errors import FileFormatError
from beltrami.io.registry import read_mesh

FOLDER = os.environ.get("BELTRAMI_MESHES")
ENTRIES = json.loads(Path(FOLDER, "MANIFEST.json").read_text())["files"] if FOLDER else []
BROKEN = {"nan_coordinates.obj", "empty.obj"}

pytestmark = [
    pytest.mark.meshes,
    pytest.mark.skipif(not FOLDER, reason="BELTRAMI_MESHES names no folder of meshes"),
]


@pytest.mark.parametrize("entry", ENTRIES or [None], ids=lambda e: e["file"] if e else "none")
def test_file(entry):
    path = Path(FOLDER, entry["file"])
    if entry["validity"] == "invalid" or path.name in BROKEN:
        with pytest.raises(FileFormatError, match=path.name):
            read_mesh(path)
        return
    mesh = read_mesh(path)
    sizes = entry.get("face_sizes") or {"3": entry["faces"]}
    assert mesh.n_vertices == entry["vertices"]
    assert mesh.n_faces == sum(count * (int(size) - 2) for size, count in sizes.items())
    assert (mesh.corner_uv is not None) == bool(entry.get("texture_coordinates"))
