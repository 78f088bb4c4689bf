"""Real files, sound and nasty: every face back, every position within the bound, few bits."""

import json
import os
from pathlib import Path

import numpy as np
import pytest

import beltrami as bt
from beltrami.compression.contents import describe

pytestmark = pytest.mark.meshes

FOLDER = os.environ.get("BELTRAMI_MESHES")
FILES = json.loads((Path(FOLDER) / "MANIFEST.json").read_text())["files"] if FOLDER else []
LARGE = 60_000  # vertices: larger ones are for the benchmark
SOUND = [f for f in FILES if f["validity"] == "valid" and f["vertices"] < LARGE]


@pytest.fixture(params=SOUND or [None], ids=lambda facts: facts and facts["file"])
def mesh(request):
    if not FOLDER:
        pytest.skip("BELTRAMI_MESHES names no folder of meshes")
    return bt.read_mesh(Path(FOLDER) / request.param["file"])


def test_it_comes_back(mesh):
    finite = bt.repair(mesh, remove_non_finite=True).mesh
    data = bt.compress(finite, bits=9, effort="fast", verify=False)
    back, order = bt.decompress(data), bt.vertex_order(finite)
    turned = np.sort(order[back.faces], axis=1)
    same = np.sort(finite.faces, axis=1)
    np.testing.assert_array_equal(turned[np.lexsort(turned.T)], same[np.lexsort(same.T)])
    bare = bt.Mesh(finite.vertices, finite.faces)
    error = np.linalg.norm(back.vertices - bare.vertices[order], axis=1).max()
    assert error <= describe(data).max_error * (1 + 1e-9)
    positions = dict(describe(data).sections)["positions on a grid"]
    assert 8 * positions < 20 * bare.n_vertices + 800  # 27 bits without any guess


def test_the_connectivity_of_sound_meshes_is_cheap(mesh):
    topology = mesh.topology
    if not (topology.is_manifold and topology.is_oriented) or mesh.n_vertices < 1000:
        pytest.skip("not an oriented manifold of a thousand vertices")
    data = bt.compress(mesh, bits=1, effort="fast", verify=False)
    assert 8 * dict(describe(data).sections)["connectivity"] < 3.3 * mesh.n_vertices
