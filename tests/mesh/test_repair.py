import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from beltrami._arrays import as_function
from beltrami.errors import MeshError, NonFiniteError
from beltrami.mesh.diagnose import diagnose
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.repair import repair
from beltrami.mesh.shapes import icosphere
from strategies import any_meshes, generators, moebius

KEYWORDS = (
    "remove_non_finite",
    "merge_duplicate_vertices",
    "remove_degenerate_faces",
    "remove_duplicate_faces",
    "split_non_manifold",
    "orient",
    "keep_largest_component",
    "remove_unreferenced",
)
CURED = {  # what each keyword alone must leave none of
    "remove_non_finite": "non_finite_vertices",
    "merge_duplicate_vertices": "duplicate_vertices",
    "remove_degenerate_faces": "degenerate_faces",
    "remove_duplicate_faces": "duplicate_faces",
    "split_non_manifold": "non_manifold_vertices",
    "remove_unreferenced": "unreferenced_vertices",
}


def laden(mesh, rng, broken=False):
    """The mesh with data and texture coordinates that tell where each number came from."""
    x = mesh.vertices.copy()
    if broken:
        x[rng.integers(len(x))] = np.nan
    uv = np.arange(6.0 * mesh.n_faces).reshape(-1, 3, 2)
    data = {"number": np.arange(mesh.n_vertices), "two": rng.normal(size=(mesh.n_vertices, 2))}
    return Mesh(x, mesh.faces, data, uv)


def same(a, b):
    return (
        np.array_equal(a.vertices, b.vertices, equal_nan=True)
        and np.array_equal(a.faces, b.faces)
        and np.array_equal(a.corner_uv, b.corner_uv)
        and all(np.array_equal(a.vertex_data[k], b.vertex_data[k]) for k in a.vertex_data)
    )


def check_maps(mesh, fixed):
    """The maps tell the truth about positions, data, faces and texture coordinates."""
    new = fixed.mesh
    assert fixed.vertex_map.shape == (mesh.n_vertices,)
    assert fixed.face_map.shape == (mesh.n_faces,)
    assert fixed.vertex_origin.shape == (new.n_vertices,)
    assert np.array_equal(new.vertices, mesh.vertices[fixed.vertex_origin], equal_nan=True)
    assert list(new.vertex_data) == list(mesh.vertex_data)
    for name, values in mesh.vertex_data.items():
        assert np.array_equal(new.vertex_data[name], values[fixed.vertex_origin])
    kept = fixed.vertex_map >= 0
    assert fixed.vertex_map.max(initial=-1) < new.n_vertices
    assert np.array_equal(new.vertices[fixed.vertex_map[kept]], mesh.vertices[kept], equal_nan=True)
    faces = np.flatnonzero(fixed.face_map >= 0)
    assert fixed.face_map[faces].tolist() == list(range(new.n_faces))  # the order is kept
    for f in faces.tolist():
        old, g = mesh.faces[f], fixed.face_map[f]
        corners = new.faces[g]
        assert np.array_equal(new.vertices[corners], mesh.vertices[old], equal_nan=True) or (
            np.array_equal(new.vertices[corners[[0, 2, 1]]], mesh.vertices[old], equal_nan=True)
        )
        for c in range(3):  # each corner has the texture of an old corner at the same place
            (d,) = np.flatnonzero((mesh.corner_uv[f] == new.corner_uv[g, c]).all(axis=1))
            place = mesh.vertices[old[d]]
            assert np.array_equal(new.vertices[corners[c]], place, equal_nan=True)


@given(any_meshes(), generators())
def test_nothing_asked_changes_nothing(mesh, rng):
    mesh = laden(mesh, rng, broken=True)
    fixed = repair(mesh)
    assert same(fixed.mesh, mesh)
    assert fixed.done == ()
    assert fixed.vertex_map.tolist() == fixed.vertex_origin.tolist() == list(range(mesh.n_vertices))
    assert fixed.face_map.tolist() == list(range(mesh.n_faces))


@settings(max_examples=150)
@given(any_meshes(), generators(), st.sets(st.sampled_from(KEYWORDS)), st.booleans())
def test_maps_tell_the_truth_and_the_input_is_left_alone(mesh, rng, asked, broken):
    mesh = laden(mesh, rng, broken)
    before = mesh.vertices.copy(), mesh.faces.copy()
    fixed = repair(mesh, **dict.fromkeys(asked, True))
    check_maps(mesh, fixed)
    assert np.array_equal(mesh.vertices, before[0], equal_nan=True)
    assert np.array_equal(mesh.faces, before[1])
    for array in (fixed.vertex_map, fixed.face_map, fixed.vertex_origin):
        assert not array.flags.writeable


@settings(max_examples=150)
@given(any_meshes(), generators(), st.sampled_from(KEYWORDS), st.booleans())
def test_each_repair_cures_what_it_says_and_twice_is_once(mesh, rng, keyword, broken):
    mesh = laden(mesh, rng, broken)
    once = repair(mesh, **{keyword: True})
    changed = not same(once.mesh, mesh)
    said = [line for line in once.done if not line.startswith("left")]
    assert bool(said) == changed
    if keyword in CURED:
        assert len(getattr(diagnose(once.mesh), CURED[keyword])) == 0
    twice = repair(once.mesh, **{keyword: True})
    assert same(twice.mesh, once.mesh)
    assert [line for line in twice.done if not line.startswith("left")] == []


@given(any_meshes(), generators())
def test_all_repairs_at_once_leave_a_clean_mesh(mesh, rng):
    mesh = laden(mesh, rng, broken=True)
    asked = dict.fromkeys(KEYWORDS, True)
    fixed = repair(mesh, **asked)
    check_maps(mesh, fixed)
    found = diagnose(fixed.mesh)
    names = {defect.name for defect in found.defects}
    assert names <= {  # copies are where their vertex was; a Moebius strip stays one
        "duplicate vertices (same coordinates as an earlier one)",
        "inconsistently oriented edges",
    }
    assert found.is_oriented or not found.is_orientable
    again = repair(fixed.mesh, **(asked | {"merge_duplicate_vertices": False}))
    assert same(again.mesh, fixed.mesh)


# ------------------------------------------------------------------------------ alone


@given(any_meshes(), generators())
def test_remove_non_finite_drops_these_vertices_and_their_faces_alone(mesh, rng):
    mesh = laden(mesh, rng, broken=True)
    fixed = repair(mesh, remove_non_finite=True)
    bad = ~np.isfinite(mesh.vertices).all(axis=1)
    assert np.array_equal(fixed.vertex_map < 0, bad)
    assert np.array_equal(fixed.face_map < 0, bad[mesh.faces].any(axis=1))


@given(any_meshes())
def test_remove_unreferenced_drops_these_vertices_alone(mesh):
    fixed = repair(mesh, remove_unreferenced=True)
    used = np.unique(mesh.faces)
    assert np.flatnonzero(fixed.vertex_map >= 0).tolist() == used.tolist()
    assert fixed.mesh.n_faces == mesh.n_faces
    assert np.array_equal(fixed.vertex_origin[fixed.mesh.faces], mesh.faces)


@given(any_meshes())
def test_removing_faces_leaves_vertices_and_other_faces_alone(mesh):
    found = diagnose(mesh)
    for keyword in ("remove_degenerate_faces", "remove_duplicate_faces"):
        fixed = repair(mesh, **{keyword: True})
        assert np.array_equal(fixed.mesh.vertices, mesh.vertices)
        gone = np.flatnonzero(fixed.face_map < 0)
        assert gone.tolist() == getattr(found, CURED[keyword]).tolist()


@given(any_meshes())
def test_merging_keeps_all_faces_and_the_first_of_each_place(mesh):
    fixed = repair(mesh, merge_duplicate_vertices=True)
    assert fixed.mesh.n_faces == mesh.n_faces
    assert (fixed.vertex_map >= 0).all()
    assert np.array_equal(fixed.mesh.faces, fixed.vertex_map[mesh.faces])
    _, first = np.unique(mesh.vertices + 0.0, axis=0, return_index=True)
    assert fixed.vertex_origin.tolist() == sorted(first.tolist())


@given(any_meshes())
def test_splitting_makes_a_manifold_and_keeps_every_face_in_its_place(mesh):
    fixed = repair(mesh, split_non_manifold=True)
    assert fixed.mesh.is_manifold
    assert np.array_equal(fixed.vertex_origin[fixed.mesh.faces], mesh.faces)
    n = mesh.n_vertices
    assert fixed.vertex_map.tolist() == list(range(n))
    assert fixed.vertex_origin[:n].tolist() == list(range(n))  # copies come last
    assert fixed.mesh.n_vertices - n == np.maximum(mesh.topology.fans.of_vertex - 1, 0).sum()


@given(any_meshes())
def test_orienting_turns_faces_and_moves_nothing(mesh):
    fixed = repair(mesh, orient=True)
    assert np.array_equal(np.sort(fixed.mesh.faces, axis=1), np.sort(mesh.faces, axis=1))
    assert np.array_equal(fixed.mesh.vertices, mesh.vertices)
    assert fixed.mesh.is_oriented == mesh.topology.is_orientable


@given(any_meshes())
def test_the_largest_component_is_kept(mesh):
    labels = mesh.components()
    fixed = repair(mesh, keep_largest_component=True)
    if mesh.n_faces:
        sizes = [int((labels == k).sum()) for k in range(labels.max() + 1)]
        assert fixed.mesh.n_faces == max(sizes)
        assert len(set(labels[fixed.face_map >= 0])) == 1
    assert fixed.mesh.n_vertices == mesh.n_vertices


# ------------------------------------------------------------------------------ by example


def test_merging_with_a_tolerance_closes_cracks():
    sphere = icosphere(1)
    rng = np.random.default_rng(71236123)
    soup = sphere.vertices[sphere.faces].reshape(-1, 3)
    soup = soup + 1e-9 * rng.uniform(-1, 1, soup.shape)
    mesh = Mesh(soup, np.arange(240).reshape(-1, 3))
    assert len(repair(mesh, merge_duplicate_vertices=True).mesh.vertices) == 240
    fixed = repair(mesh, merge_duplicate_vertices=True, tolerance=1e-6)
    assert (fixed.mesh.n_vertices, fixed.mesh.is_closed, fixed.mesh.genus) == (42, True, 0)
    assert fixed.done == ("merged 198 duplicate vertices",)
    again = repair(fixed.mesh, merge_duplicate_vertices=True, tolerance=1e-6)
    assert again.done == ()


@pytest.mark.parametrize(
    "wrong",
    [
        {"tolerance": 1e-6},
        {"tolerance": -1e-6, "merge_duplicate_vertices": True},
        {"tolerance": np.nan, "merge_duplicate_vertices": True},
    ],
)
def test_a_tolerance_that_makes_no_sense(wrong):
    with pytest.raises(MeshError, match="tolerance"):
        repair(icosphere(0), **wrong)


def test_closed_components_are_turned_outwards_each_for_itself():
    sphere = icosphere(1)
    rng = np.random.default_rng(443556677)
    inside_out = sphere.faces[:, [0, 2, 1]] + 42
    mixed = sphere.faces + 84
    turned = rng.random(80) < 0.5
    mixed[turned] = mixed[turned][:, [1, 0, 2]]
    x = np.concatenate([sphere.vertices + 50 * k for k in range(3)])
    uv = rng.random((240, 3, 2))
    mesh = Mesh(x, np.concatenate([sphere.faces, inside_out, mixed]), corner_uv=uv)
    fixed = repair(mesh, orient=True).mesh
    for k in range(3):
        part = Mesh(x, fixed.faces[80 * k : 80 * k + 80])
        assert part.volume == pytest.approx(sphere.volume)
    assert np.array_equal(fixed.faces[:80], mesh.faces[:80])
    for f, c in np.ndindex(240, 3):
        (d,) = np.flatnonzero(mesh.faces[f] == fixed.faces[f, c])
        assert np.array_equal(fixed.corner_uv[f, c], uv[f, d])


def test_an_open_component_keeps_the_side_of_its_first_face():
    half = icosphere(1).faces[:30]
    mixed = half.copy()
    mixed[5:] = mixed[5:, ::-1]
    fixed = repair(Mesh(icosphere(1).vertices, mixed), orient=True).mesh
    assert np.array_equal(fixed.faces[0], half[0])
    assert fixed.is_oriented


def test_orienting_what_is_not_finite_makes_no_warning():
    x = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [np.inf, 1, 0]])
    fixed = repair(Mesh(x, [[0, 1, 2], [1, 2, 3]]), orient=True)
    assert fixed.mesh.is_oriented


def test_a_moebius_strip_is_left_alone_and_that_is_said():
    strip = Mesh(*moebius(np.random.default_rng(5), 9))
    fixed = repair(strip, orient=True)
    assert np.array_equal(fixed.mesh.faces, strip.faces)
    assert len(fixed.done) == 1
    assert "not orientable" in fixed.done[0]


def test_the_lines_count():
    x = np.array([[0, 0], [1, 0], [0, 1], [np.nan, 0], [9, 9], [1, 0]])
    mesh = Mesh(x, [[0, 1, 2], [1, 2, 0], [0, 0, 1], [0, 3, 2]])
    fixed = repair(mesh, **dict.fromkeys(KEYWORDS, True))
    assert fixed.done == (
        "removed 1 vertex that was not finite",
        "merged 1 duplicate vertex",
        "removed 1 degenerate face",
        "removed 1 duplicate face",
        "removed 1 unreferenced vertex",
    )
    assert fixed.vertex_map.tolist() == [0, 1, 2, -1, -1, 1]
    assert fixed.face_map.tolist() == [0, -1, -1, -1]


def test_empty():
    fixed = repair(Mesh([], []), **dict.fromkeys(KEYWORDS, True), tolerance=0.1)
    assert (fixed.mesh.n_vertices, fixed.mesh.n_faces, fixed.done) == (0, 0, ())


def test_a_cavity_stays_a_cavity():
    outer, inner = icosphere(1), icosphere(1, radius=0.5)
    n = outer.n_vertices
    turned_in = inner.faces[:, [0, 2, 1]] + n
    hollow = Mesh(
        np.concatenate([outer.vertices, inner.vertices]), np.concatenate([outer.faces, turned_in])
    )
    assert repair(hollow, orient=True).mesh.volume == pytest.approx(hollow.volume)
    beside = hollow.with_vertices(hollow.vertices + np.repeat([[0.0], [9]], n, axis=0))
    both = outer.volume + inner.volume
    assert repair(beside, orient=True).mesh.volume == pytest.approx(both)


@given(any_meshes(), generators())
@settings(max_examples=30)
def test_remove_vertices_drops_these_their_faces_and_nothing_else(mesh, rng):
    mesh = laden(mesh, rng)
    unwanted = rng.random(mesh.n_vertices) < 0.3
    fixed = repair(mesh, remove_vertices=unwanted)
    check_maps(mesh, fixed)
    assert np.array_equal(fixed.vertex_origin, np.flatnonzero(~unwanted))
    assert np.array_equal(fixed.face_map < 0, unwanted[mesh.faces].any(axis=1))
    assert same(repair(mesh, remove_vertices=np.flatnonzero(unwanted)).mesh, fixed.mesh)
    assert len(fixed.done) == unwanted.any()


def test_what_a_removed_vertex_leaves_alone_is_dropped_when_asked():
    fan = Mesh([[0, 0], [1, 0], [0, 1], [-1, 0]], [[0, 1, 2], [0, 2, 3]])
    assert repair(fan, remove_vertices=[3]).mesh.n_vertices == 3
    both = {"remove_vertices": [1], "remove_unreferenced": True}
    fixed = repair(fan, **both)
    assert fixed.vertex_map.tolist() == [0, -1, 1, 2]
    assert fixed.done == ("removed 1 vertex as asked",)
    assert repair(fan, remove_vertices=[0], remove_unreferenced=True).mesh.n_vertices == 0
    assert repair(fan, remove_vertices=[]).done == ()


@pytest.mark.parametrize("unwanted", [[4], [-1], [True], [0.5]])
def test_vertices_to_remove_exist(unwanted):
    fan = Mesh([[0, 0], [1, 0], [0, 1], [-1, 0]], [[0, 1, 2], [0, 2, 3]])
    with pytest.raises(MeshError, match="vertices to remove"):
        repair(fan, remove_vertices=unwanted)


def test_the_remedy_for_a_function_without_values_is_one():
    mesh = icosphere(1)
    f = np.ones(mesh.n_vertices)
    f[[0, 5]] = np.nan
    with pytest.raises(NonFiniteError, match=r"remove_vertices=~np.isfinite\(f\)") as caught:
        as_function(f, mesh.n_vertices)
    part = repair(mesh, remove_vertices=~np.isfinite(f))
    assert np.array_equal(caught.value.vertices, np.flatnonzero(part.vertex_map < 0))
    assert as_function(f[part.vertex_origin], part.mesh.n_vertices).all()


def test_nothing_is_left_and_later_steps_have_nothing_to_do():
    triangle = Mesh(np.full((3, 3), np.nan), [[0, 1, 2]])
    fixed = repair(triangle, **dict.fromkeys(KEYWORDS, True))
    assert fixed.vertex_map.tolist() == [-1, -1, -1]
    assert fixed.face_map.tolist() == [-1]
    assert fixed.mesh.n_vertices == len(fixed.vertex_origin) == 0
