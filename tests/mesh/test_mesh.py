import copy
import pickle
from concurrent.futures import ThreadPoolExecutor
from threading import Barrier

import numpy as np
import pytest
from hypothesis import given
from scipy.spatial import ConvexHull

from beltrami.errors import (
    DimensionError,
    MeshError,
    NotClosedError,
    NotManifoldError,
    NotOrientableError,
)
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import cube, icosphere, tetrahedron, torus
from beltrami.mesh.topology import Topology
from strategies import any_meshes, arrays, hull

X = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
F = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
GEOMETRY = ("face_areas", "face_normals", "vertex_normals", "corner_angles", "edge_lengths")


# ------------------------------------------------------------------------------ the door


@pytest.mark.parametrize("dtype", ["float32", "float16", "int32", "uint8", ">f8", "bool"])
def test_any_type_of_numbers(dtype):
    mesh = Mesh(X.astype(dtype), F)
    assert mesh.vertices.dtype == np.float64
    assert mesh.vertices.tolist() == X.tolist()


def test_lists_are_accepted():
    mesh = Mesh(X.tolist(), F.tolist())
    assert (mesh.n_vertices, mesh.n_faces, mesh.dimension) == (4, 4, 3)
    assert mesh.volume == pytest.approx(1 / 6)


@pytest.mark.parametrize("shape", [(4,), (4, 1), (4, 0), (2, 2, 3)])
def test_wrong_shapes_of_vertices_are_named(shape):
    with pytest.raises(DimensionError) as caught:
        Mesh(np.ones(shape), [])
    assert str(shape) in str(caught.value)


@pytest.mark.parametrize("vertices", [[[0, 0, 0], [1, 1]], [["a", "b"]], [[1j, 0]]])
def test_vertices_that_are_no_array_of_numbers_are_an_error_of_this_library(vertices):
    with pytest.raises(MeshError):
        Mesh(vertices, [])


def test_faces_out_of_range_are_named():
    with pytest.raises(MeshError) as caught:
        Mesh(X, [[0, 1, 2], [0, 1, 4]])
    assert caught.value.faces.tolist() == [1]


def test_a_topology_of_another_size_is_refused():
    with pytest.raises(DimensionError, match=r"4 vertices .* 5"):
        Mesh(X, Topology(F, 5))


def test_corner_uv_has_one_pair_for_each_corner():
    uv = np.arange(24.0).reshape(4, 3, 2)
    mesh = Mesh(X, F, corner_uv=uv)
    assert mesh.corner_uv is not None
    assert np.array_equal(mesh.corner_uv, uv)
    assert not mesh.corner_uv.flags.writeable
    for wrong in (uv[:3], uv[:, :2], uv[..., :1], uv.reshape(12, 2)):
        with pytest.raises(DimensionError, match=r"\(4, 3, 2\)"):
            Mesh(X, F, corner_uv=wrong)


@pytest.mark.chapter("D5")
def test_vertex_data_have_a_row_for_each_vertex():
    data = {"a": [1, 2, 3, 4], "b": np.ones((4, 2), np.float32)}
    mesh = Mesh(X, F, data)
    assert list(mesh.vertex_data) == ["a", "b"]
    assert mesh.vertex_data["a"].dtype.kind == "i"
    assert mesh.vertex_data["b"].dtype == np.float32
    assert "'a'" in repr(mesh)
    for wrong in ([1, 2, 3], np.ones((4, 1, 1)), 5.0, np.ones((5, 2))):
        with pytest.raises(MeshError, match="vertex_data\\['bad'\\]"):
            Mesh(X, F, {"bad": wrong})


@pytest.mark.parametrize("data", ["f", 3, [1.0, 2.0], np.zeros(4), False])
def test_vertex_data_have_names(data):
    with pytest.raises(MeshError, match="vertex_data maps names to arrays"):
        Mesh(np.zeros((4, 3)), [[0, 1, 2]], data)


def test_inputs_are_neither_changed_nor_followed():
    x, f, data, uv = X.copy(), F.copy(), {"a": np.arange(4.0)}, np.zeros((4, 3, 2))
    mesh = Mesh(x, f, data, uv)
    assert all(a.flags.writeable for a in (x, f, data["a"], uv))
    x[:], f[:], data["a"][:], uv[:] = 7, 0, 9, 5
    data["new"] = np.zeros(4)
    assert np.array_equal(mesh.vertices, X)
    assert np.array_equal(mesh.faces, F)
    assert mesh.vertex_data["a"].tolist() == [0, 1, 2, 3]
    assert list(mesh.vertex_data) == ["a"]
    assert mesh.corner_uv is not None
    assert not mesh.corner_uv.any()


def test_a_read_only_array_is_shared_unless_somebody_can_still_write():
    x = X.copy()
    x.flags.writeable = False
    assert np.shares_memory(Mesh(x, F).vertices, x)
    base = X.copy()
    view = base[:]
    view.flags.writeable = False
    assert not np.shares_memory(Mesh(view, F).vertices, base)


def test_nan_is_accepted_so_that_diagnose_can_name_it():
    x = X.copy()
    x[2, 1] = np.nan
    mesh = Mesh(x, F)
    assert np.isnan(mesh.face_areas).tolist() == [True, False, True, True]


def test_empty():
    mesh = Mesh([], [])
    assert (mesh.n_vertices, mesh.n_faces, mesh.dimension, mesh.area) == (0, 0, 3, 0)
    shapes = [getattr(mesh, name).shape for name in GEOMETRY]
    assert shapes == [(0,), (0, 3), (0, 3), (0, 3), (0,)]
    with pytest.raises(NotClosedError):
        _ = mesh.volume
    assert Mesh(np.zeros((0, 2)), []).dimension == 2


# ------------------------------------------------------------------------------ frozen


def test_nothing_can_be_set_deleted_or_written():
    mesh = Mesh(X, F, {"a": np.arange(4.0)})
    for name in ("vertices", "faces", "area", "something"):
        with pytest.raises(AttributeError):
            setattr(mesh, name, 1)
    with pytest.raises(AttributeError):
        del mesh.vertices
    with pytest.raises(TypeError):
        mesh.vertex_data["b"] = np.zeros(4)
    arrays_ = [mesh.vertices, mesh.faces, mesh.edges, mesh.vertex_data["a"]]
    for array in arrays_ + [getattr(mesh, name) for name in GEOMETRY]:
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0


def test_pickles_and_copies_hold_the_same_and_are_frozen():
    mesh = Mesh(X, F, {"a": np.arange(4)}, np.zeros((4, 3, 2)))
    assert mesh.area > 0
    for other in (pickle.loads(pickle.dumps(mesh)), copy.deepcopy(mesh), copy.copy(mesh)):  # noqa: S301
        assert np.array_equal(other.vertices, mesh.vertices)
        assert np.array_equal(other.faces, mesh.faces)
        assert np.array_equal(other.vertex_data["a"], mesh.vertex_data["a"])
        assert other.vertex_data["a"].dtype == mesh.vertex_data["a"].dtype
        assert other.corner_uv is not None
        assert not other.vertices.flags.writeable
        assert not other.corner_uv.flags.writeable
        assert "face_areas" not in vars(other)
        with pytest.raises(TypeError):
            other.vertex_data["b"] = 1


def test_many_threads_get_the_same_answers():
    names = [*GEOMETRY, "edges", "area", "volume", "genus", "boundary_loops"]
    expected, shared, start = torus(40, 30), torus(40, 30), Barrier(8)

    def ask(i):
        start.wait()
        order = np.random.default_rng(998877665544 + i).permutation(len(names))
        return {names[k]: getattr(shared, names[k]) for k in order}

    with ThreadPoolExecutor(8) as pool:
        for answer in pool.map(ask, range(8)):
            for name in names:
                assert np.array_equal(answer[name], getattr(expected, name))


# ------------------------------------------------------------------------------ copies with changes


@pytest.mark.chapter("X2")
def test_with_vertices_shares_the_topology_and_drops_normals():
    mesh = Mesh(X, F, {"a": np.arange(4), "normal": X}, np.zeros((4, 3, 2)))
    edges = mesh.edges
    moved = mesh.with_vertices(2 * X)
    assert moved.topology is mesh.topology
    assert moved.edges is edges
    assert list(moved.vertex_data) == ["a"]
    assert np.shares_memory(moved.corner_uv, mesh.corner_uv)
    assert moved.area == pytest.approx(4 * mesh.area)
    assert mesh.vertices[1].tolist() == [1, 0, 0]
    assert mesh.with_vertices(X[:, :2]).dimension == 2
    with pytest.raises(DimensionError):
        mesh.with_vertices(X[:3])


def test_with_data_adds_and_replaces():
    mesh = Mesh(X, F, {"a": np.zeros(4)})
    more = mesh.with_data(a=np.ones(4), b=np.ones((4, 3)))
    assert list(mesh.vertex_data) == ["a"]
    assert not mesh.vertex_data["a"].any()
    assert more.vertex_data["a"].all()
    assert more.vertex_data["b"].shape == (4, 3)
    assert more.topology is mesh.topology
    assert np.shares_memory(more.vertices, mesh.vertices)
    with pytest.raises(MeshError):
        mesh.with_data(c=np.ones(3))


# ------------------------------------------------------------------------------ volume


@given(arrays(hull))
def test_volume_of_convex_hulls(pair):
    mesh = Mesh(*pair)
    expected = ConvexHull(pair[0])
    assert mesh.volume == pytest.approx(expected.volume, rel=1e-9)
    assert mesh.area == pytest.approx(expected.area, rel=1e-9)
    turned = Mesh(mesh.vertices, mesh.faces[:, [0, 2, 1]])
    assert turned.volume == pytest.approx(-expected.volume, rel=1e-9)
    moved = mesh.with_vertices(mesh.vertices + np.array([100, -200, 300]))
    assert moved.volume == pytest.approx(expected.volume, rel=1e-9)


def test_volume_of_several_bodies_adds_up():
    one = cube()
    faces = np.concatenate([one.faces, one.faces + 8])
    two = Mesh(np.concatenate([one.vertices, 2 * one.vertices + 9]), faces)
    assert two.volume == pytest.approx(1 + 8)


def test_what_has_no_volume_says_why():
    with pytest.raises(NotClosedError) as opened:
        _ = Mesh(X, F[1:]).volume
    assert opened.value.edges.tolist() == [[0, 1], [0, 2], [1, 2]]
    turned = F.copy()
    turned[0] = turned[0, ::-1]
    with pytest.raises(NotOrientableError) as twisted:
        _ = Mesh(X, turned).volume
    assert sorted(twisted.value.edges.tolist()) == [[0, 1], [0, 2], [1, 2]]
    assert "orient" in twisted.value.remedy
    x = np.concatenate([X, [[0, 0, -1]]])
    shared = np.concatenate([F, [[0, 1, 4], [1, 0, 2], [0, 4, 2], [1, 2, 4]]])
    with pytest.raises(NotManifoldError) as crowded:
        _ = Mesh(x, shared).volume
    assert [0, 1] in crowded.value.edges.tolist()
    with pytest.raises(DimensionError):
        _ = Mesh(np.ones((4, 4)), F).volume


def test_a_closed_mesh_laid_flat_has_no_volume():
    flat = icosphere(1).with_vertices(icosphere(1).vertices[:, :2])
    assert flat.volume == pytest.approx(0, abs=1e-15)


@pytest.mark.parametrize("name", ["face_normals", "vertex_normals"])
def test_four_dimensions_have_no_normals(name):
    with pytest.raises(DimensionError, match="4"):
        getattr(Mesh(np.ones((4, 4)), F), name)


# ------------------------------------------------------------------------------ what it passes on


@given(any_meshes())
def test_edge_lengths_by_a_loop(mesh):
    expected = [np.linalg.norm(mesh.vertices[a] - mesh.vertices[b]) for a, b in mesh.edges]
    assert mesh.edge_lengths.tolist() == pytest.approx(expected, rel=1e-14)


@given(any_meshes())
def test_a_mesh_knows_what_its_topology_knows(mesh):
    other = Topology(mesh.faces, mesh.n_vertices)
    assert np.array_equal(mesh.edges, other.edges)
    assert mesh.euler_characteristic == other.euler_characteristic
    assert mesh.is_closed == other.is_closed
    assert mesh.is_manifold == other.is_manifold
    assert mesh.is_oriented == other.is_oriented
    for through in ("vertices", "edges"):
        assert np.array_equal(mesh.components(through), other.components(through))
    for kind in ("exact", "ball", "walk"):
        assert np.array_equal(mesh.ring(0, 2, kind), other.ring(0, 2, kind))
    assert np.array_equal(mesh.face_ring(0), other.face_ring(0))


def test_numbers_of_a_tetrahedron():
    mesh = tetrahedron()
    assert (mesh.n_vertices, len(mesh.edges), mesh.n_faces) == (4, 6, 4)
    assert mesh.edge_lengths == pytest.approx(np.sqrt(8 / 3))
    assert mesh.area == pytest.approx(8 / np.sqrt(3))
    assert mesh.volume == pytest.approx(8 / (9 * np.sqrt(3)))


def test_repr():
    assert repr(Mesh(X, F)) == "<Mesh: 4 vertices in R³, 4 faces>"
    assert "uv" in repr(Mesh(X, F, corner_uv=np.zeros((4, 3, 2))))
    assert "R12" in repr(Mesh(np.zeros((4, 12)), F))


def test_a_surface_with_one_side_has_no_volume_after_any_repair():
    faces = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5], [0, 5, 1],
             [1, 2, 4], [2, 3, 5], [3, 4, 1], [4, 5, 2], [5, 1, 3]]  # fmt: skip
    plane = Mesh(np.random.default_rng(0).normal(size=(6, 3)), faces)  # the projective one
    with pytest.raises(NotOrientableError, match="one side") as caught:
        _ = plane.volume
    assert "repair" not in caught.value.remedy


def test_the_three_counts_make_the_euler_characteristic():
    mesh = torus(5, 7)
    assert mesh.n_edges == len(mesh.edges) == 3 * 35
    assert mesh.n_vertices - mesh.n_edges + mesh.n_faces == mesh.euler_characteristic == 0


def test_faces_that_are_floats_are_told_from_polygons():
    mesh = torus(5, 7)
    for points, faces in ((mesh.faces, mesh.vertices), (mesh.vertices, mesh.faces * 1.0)):
        with pytest.raises(DimensionError, match=r"in this order, and faces.astype\(int\)"):
            Mesh(points, faces)
    with pytest.raises(DimensionError, match="Triangulate polygons"):
        Mesh(mesh.vertices, mesh.faces[:, [0, 1, 2, 0]])
