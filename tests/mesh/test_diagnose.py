import json

import numpy as np
import pytest
from hypothesis import given

from beltrami.mesh.diagnose import diagnose
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import cube, cylinder, grid, icosphere, torus
from strategies import any_meshes, moebius

DEFECTS = (
    "non_finite_vertices",
    "unreferenced_vertices",
    "duplicate_vertices",
    "non_manifold_vertices",
    "degenerate_faces",
    "duplicate_faces",
    "non_manifold_edges",
    "inconsistent_edges",
)


def defects(mesh):
    """Name -> indices of the defects found; the property must tell of exactly these."""
    found = diagnose(mesh)
    wrong = {name: getattr(found, name).tolist() for name in DEFECTS}
    wrong = {name: indices for name, indices in wrong.items() if indices}
    assert len(found.defects) == len(wrong)
    assert found.is_clean == (not wrong)
    assert sorted(d.count for d in found.defects) == sorted(map(len, wrong.values()))
    return wrong


def sphere():
    mesh = icosphere(1)
    return mesh.vertices.copy(), mesh.faces.copy()


@pytest.mark.parametrize("mesh", [icosphere(2), torus(6, 5), cube(2), grid(3, 3), cylinder(8, 2)])
def test_clean_meshes_have_no_defects(mesh):
    assert defects(mesh) == {}
    assert diagnose(mesh).report().endswith("no defects")


def test_facts_of_a_closed_mesh():
    mesh = torus(6, 5)
    found = diagnose(mesh)
    assert (found.n_vertices, found.n_faces, found.n_edges) == (30, 60, 90)
    assert (found.n_components, found.n_boundary_loops, found.euler_characteristic) == (1, 0, 0)
    assert (found.genus, found.is_closed, found.is_manifold) == (1, True, True)
    assert (found.is_oriented, found.is_orientable) == (True, True)
    assert found.area == pytest.approx(mesh.area)
    assert found.volume == pytest.approx(mesh.volume)
    assert "genus 1" in found.report()
    assert "closed" in found.report()


def test_facts_of_an_open_mesh():
    found = diagnose(cylinder(8, 2))
    assert (found.n_boundary_loops, found.genus, found.volume) == (2, 0, None)
    assert len(found.boundary_edges) == 16
    assert "boundary of 2 loops" in found.report()


def test_vertices_that_are_not_finite():
    x, f = sphere()
    x[[3, 17]] = [[np.nan, 0, 0], [0, np.inf, 0]]
    assert defects(Mesh(x, f)) == {"non_finite_vertices": [3, 17]}
    found = diagnose(Mesh(x, f))
    touched = np.isin(f, [3, 17]).any(axis=1)
    assert found.area == pytest.approx(icosphere(1).face_areas[~touched].sum())
    assert found.volume is None


@pytest.mark.parametrize("d", [2, 3, 5])
def test_infinite_coordinates_make_no_warning(d):
    x = np.zeros((4, d))
    x[:, :2] = [[0, 0], [1, 0], [0, 1], [np.inf, 1]]
    assert defects(Mesh(x, [[0, 1, 2], [1, 3, 2]])) == {"non_finite_vertices": [3]}


@pytest.mark.chapter("U4")
def test_unreferenced_vertices():
    x, f = sphere()
    mesh = Mesh(np.concatenate([[[5, 5, 5]], x, [[6, 6, 6]]]), f + 1)
    assert defects(mesh) == {"unreferenced_vertices": [0, 43]}
    assert diagnose(mesh).euler_characteristic == 2


def test_duplicate_vertices():
    x, f = sphere()
    row, column = np.argwhere(f == 7)[0]
    f[row, column] = 42
    found = defects(Mesh(np.concatenate([x, x[7:8]]), f))
    assert found["duplicate_vertices"] == [42]
    assert set(found) == {"duplicate_vertices"}


def test_degenerate_faces():
    x, f = sphere()
    a, b = f[0, :2]
    x = np.concatenate([x, [(x[a] + x[b]) / 2]])
    mesh = Mesh(x, np.concatenate([f[:5], [[a, a, b]], f[5:], [[a, 42, b]]]))
    found = defects(mesh)
    assert found["degenerate_faces"] == [5, 81]


def test_duplicate_faces_and_the_edges_they_crowd():
    x, f = sphere()
    found = defects(Mesh(x, np.concatenate([f, f[9:10, [2, 0, 1]], f[9:10, ::-1]])))
    a, b, c = sorted(f[9].tolist())
    assert found == {
        "duplicate_faces": [80, 81],
        "non_manifold_edges": [[a, b], [a, c], [b, c]],
        "non_manifold_vertices": [a, b, c],
    }


def test_non_manifold_vertices_and_edges():
    bow_tie = Mesh([[0, 0], [1, 0], [0, 1], [-1, 0], [0, -1]], [[0, 1, 2], [0, 3, 4]])
    assert defects(bow_tie) == {"non_manifold_vertices": [0]}
    found = diagnose(bow_tie)
    assert (found.genus, found.n_boundary_loops, found.is_manifold) == (None, 2, False)
    x = [[0, 0, 0], [0, 0, 1], [1, 0, 0], [0, 1, 0], [-1, -1, 0]]
    fan = Mesh(x, [[0, 1, 2], [0, 1, 3], [0, 1, 4]])
    assert defects(fan) == {"non_manifold_vertices": [0, 1], "non_manifold_edges": [[0, 1]]}
    assert diagnose(fan).n_boundary_loops is None
    assert "not manifold" in diagnose(fan).report()


def test_inconsistent_edges():
    x, f = sphere()
    f[30] = f[30, ::-1]
    sides = sorted(sorted((int(f[30, c]), int(f[30, c - 1]))) for c in range(3))
    mesh = Mesh(x, f)
    assert sorted(defects(mesh).pop("inconsistent_edges")) == sides
    assert list(defects(mesh)) == ["inconsistent_edges"]
    found = diagnose(mesh)
    assert (found.is_oriented, found.is_orientable, found.volume) == (False, True, None)
    assert "not consistently oriented" in found.report()


def test_a_moebius_strip():
    found = diagnose(Mesh(*moebius(np.random.default_rng(5), 9)))
    assert (found.is_orientable, found.genus, found.n_boundary_loops) == (False, None, 1)
    assert len(found.inconsistent_edges) > 0
    assert "not orientable" in found.report()
    assert found.defects[-1].name == "inconsistently oriented edges"
    assert "with one side" in found.defects[-1].remedy
    assert "1 kind of defect:" in found.report()


@pytest.mark.parametrize("d", [2, 4])
def test_a_closed_mesh_in_the_plane_and_in_four_dimensions(d):
    mesh = icosphere(1)
    flat = mesh.with_vertices(np.pad(mesh.vertices, ((0, 0), (0, 1)))[:, :d])
    found = diagnose(flat)
    assert found.is_closed
    assert not found.volume  # none, or nothing


def test_empty():
    found = diagnose(Mesh([], []))
    assert found.is_clean
    assert (found.is_closed, found.area, found.volume, found.genus) == (False, 0, None, 0)
    assert "0 vertices" in found.report()


@given(any_meshes())
def test_every_defect_is_told_with_its_remedy(mesh):
    wrong = defects(mesh)
    found = diagnose(mesh)
    report = found.report()
    for defect in found.defects:
        assert str(defect) in report
        assert defect.remedy.startswith("repair: ")
        assert str(defect.indices[0].tolist()) in str(defect)
        assert str(defect.count) in str(defect)
    assert ("no defects" in report) == (not wrong)


@given(any_meshes())
def test_to_dict_is_plain_enough_for_json(mesh):
    found = diagnose(mesh)
    plain = json.loads(json.dumps(found.to_dict()))
    assert plain["is_clean"] == found.is_clean
    assert plain["n_edges"] == len(mesh.edges)
    assert plain["genus"] == found.genus
    assert set(plain["remedies"]) == {defect.name for defect in found.defects}
    for name in (*DEFECTS, "boundary_edges"):
        assert plain[name] == getattr(found, name).tolist()


def test_a_long_list_is_cut_short():
    mesh = Mesh(np.random.default_rng(8812334).normal(size=(10, 3)), [[0, 1, 2]])
    (defect,) = diagnose(mesh).defects
    assert defect.count == 7
    assert "3, 4, 5, 6, 7, ... (7 in all)" in str(defect)


@given(any_meshes())
def test_the_arrays_are_frozen(mesh):
    found = diagnose(mesh)
    for name in (*DEFECTS, "boundary_edges"):
        assert not getattr(found, name).flags.writeable
