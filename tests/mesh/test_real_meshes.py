"""Facts about real files, measured by other libraries and written down beside them."""

import json
import os
from pathlib import Path

import numpy as np
import pytest

from beltrami.mesh.diagnose import diagnose
from beltrami.mesh.repair import repair

pytestmark = pytest.mark.meshes

FOLDER = os.environ.get("BELTRAMI_MESHES")
FILES = json.loads((Path(FOLDER) / "MANIFEST.json").read_text())["files"] if FOLDER else []
VALID = [facts for facts in FILES if facts["validity"] == "valid"]


@pytest.fixture(scope="module", params=VALID or [None], ids=lambda facts: facts and facts["file"])
def case(request):
    if not FOLDER:
        pytest.skip("BELTRAMI_MESHES names no folder of meshes")
    registry = pytest.importorskip("beltrami.io.registry")
    facts = request.param
    mesh = registry.read_mesh(Path(FOLDER) / facts["file"])
    if facts["file"].lower().endswith(".stl"):
        mesh = repair(mesh, merge_duplicate_vertices=True).mesh  # as the facts were measured
    return mesh, facts


def test_sizes(case):
    mesh, facts = case
    assert mesh.n_vertices == facts["vertices"]
    assert mesh.n_faces == facts.get("triangles_after_fan_split", facts["faces"])
    assert len(mesh.edges) == facts["edges"]


def test_topology(case):
    mesh, facts = case
    topology = mesh.topology
    assert topology.n_components == facts["components"]
    assert len(set(mesh.components("edges").tolist())) == facts["components_through_edges"]
    assert topology.euler_characteristic == facts["euler_characteristic"]
    assert topology.is_closed == facts["closed"]
    assert len(topology.boundary_edges) == facts["boundary_edges"]
    assert topology.is_edge_manifold == facts["edge_manifold"]
    assert len(topology.non_manifold_edges) == facts["nonmanifold_edges"]
    assert len(topology.non_manifold_vertices) == facts["nonmanifold_vertices"]
    assert topology.is_orientable == facts["orientable"]
    assert topology.is_oriented == facts["consistently_oriented"]
    assert diagnose(mesh).genus == facts["genus"]


def test_inconsistent_edges(case):
    mesh, facts = case
    assert len(mesh.topology.inconsistent_edges) == facts["inconsistent_edges"]


def test_boundary_loops(case):
    mesh, facts = case
    if not facts["boundary_loops_are_simple"]:
        pytest.skip("the boundary is not made of simple loops, and its pieces were counted")
    loops = mesh.boundary_loops
    assert len(loops) == facts["boundary_loops"]
    assert sum(map(len, loops)) == facts["boundary_edges"]


def test_defects(case):
    mesh, facts = case
    found = diagnose(mesh)
    assert len(found.degenerate_faces) == facts["zero_area_faces"]
    assert len(found.duplicate_faces) == facts["duplicate_faces"]
    assert len(found.unreferenced_vertices) == facts["unreferenced_vertices"]
    if not facts["file"].lower().endswith(".stl"):  # there they were counted before welding
        assert len(found.duplicate_vertices) == facts["duplicate_vertices"]


def test_sizes_of_surface_and_angles(case):
    mesh, facts = case
    assert mesh.area == pytest.approx(facts["surface_area"], rel=1e-7)  # of float32 coordinates
    kept = np.ones(mesh.n_faces, bool)
    kept[diagnose(mesh).degenerate_faces] = False
    degrees = np.degrees(mesh.corner_angles[kept])
    assert degrees.min() == pytest.approx(facts["min_angle_deg"], abs=2e-4)  # degrees
    assert degrees.max() == pytest.approx(facts["max_angle_deg"], rel=1e-5)


@pytest.mark.parametrize(
    ("key", "tolerance"), [("after_exact_weld", 0.0), ("after_weld_1e_6_diagonal", 1e-6)]
)
def test_welding(case, key, tolerance):
    mesh, facts = case
    if key not in facts:
        pytest.skip("not measured for this file")
    expected = facts[key]
    welded = repair(mesh, merge_duplicate_vertices=True, tolerance=tolerance).mesh
    topology = welded.topology
    assert welded.n_vertices == expected["vertices"]
    assert topology.n_components == expected["components_vertex"]
    assert topology.euler_characteristic == expected["euler"]
    assert topology.is_closed == expected["closed"]
    assert len(topology.non_manifold_edges) == expected["nonmanifold_edges"]
    assert len(topology.non_manifold_vertices) == expected["nonmanifold_vertices"]
    assert topology.is_orientable == expected["orientable"]
    assert topology.is_oriented == expected["consistently_oriented"]
    assert diagnose(welded).genus == expected["genus_total"]


def test_splitting_and_orienting_cure_real_files(case):
    mesh, facts = case
    fixed = repair(mesh, remove_duplicate_faces=True, split_non_manifold=True, orient=True)
    assert fixed.mesh.is_manifold
    assert fixed.mesh.is_oriented == fixed.mesh.topology.is_orientable
    assert np.array_equal(mesh.vertices[fixed.vertex_origin], fixed.mesh.vertices)
    if facts["orientable"]:
        assert fixed.mesh.is_oriented
