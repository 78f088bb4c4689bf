"""learning_operators: fields as elsewhere in the library, and the same bits from disk."""

import threading
from concurrent.futures import ThreadPoolExecutor
from dataclasses import fields

import numpy as np
import pytest
from scipy.sparse import issparse

import beltrami as bt
from beltrami.errors import BeltramiError, UnknownNameError
from beltrami.io.npz import read_arrays, write_arrays
from beltrami.learning import learning_operators as room
from beltrami.learning.cache import KIND, VERSION
from beltrami.learning.operators import LearningOperators

MESH = bt.shapes.torus(12, 7)


def same(one, other):
    for field in fields(LearningOperators):
        a, b = getattr(one, field.name), getattr(other, field.name)
        if issparse(a):
            assert a.shape == b.shape
            assert np.array_equal(a.indices, b.indices)
            assert np.array_equal(a.indptr, b.indptr)
            a, b = a.data, b.data
        if not (a.dtype == b.dtype and np.array_equal(a, b)):
            return False
    return True


@pytest.fixture
def no_more_work(monkeypatch):
    """From here on, nothing may be computed."""

    def forbid():
        def made(*_):
            raise AssertionError("computed again")

        monkeypatch.setattr(room, "_made", made)

    return forbid


def test_fields():
    found = bt.learning_operators(MESH, 20)
    pair = bt.laplacian(MESH)
    assert (found.stiffness != pair.stiffness).nnz == 0
    assert np.array_equal(found.masses, pair.masses)
    rest = found.stiffness @ found.eigenvectors
    rest -= found.masses[:, None] * found.eigenvectors * found.eigenvalues
    assert np.abs(rest).max() < 1e-6
    gram = found.eigenvectors.T @ (found.masses[:, None] * found.eigenvectors)
    assert np.abs(gram - np.eye(20)).max() < 1e-9
    assert (found.face_gradient != bt.face_gradient(MESH)).nnz == 0
    f = MESH.vertices[:, 0]
    assert np.array_equal((found.gradient @ f).real, found.gradient_x @ f)
    assert np.array_equal((found.gradient @ f).imag, found.gradient_y @ f)
    assert (found.n, found.k) == (MESH.n_vertices, 20)
    for field in fields(LearningOperators):
        value = getattr(found, field.name)
        assert not (value.data if issparse(value) else value).flags.writeable


@pytest.mark.parametrize("weights", ["tufted", "combinatorial", "intrinsic_delaunay"])
def test_other_weights(weights):
    found = bt.learning_operators(MESH, 5, weights=weights, mass="barycentric")
    pair = bt.laplacian(MESH, weights, "barycentric")
    assert (found.stiffness != pair.stiffness).nnz == 0
    assert np.array_equal(found.masses, pair.masses)


@pytest.mark.parametrize(
    ("options", "error"),
    [
        ({"weights": "mean_value"}, UnknownNameError),
        ({"mass": "consistent"}, UnknownNameError),
        ({"k": 0}, BeltramiError),
        ({"k": 85}, BeltramiError),
        ({"k": 2.5}, BeltramiError),
    ],
)
def test_what_cannot_be(options, error, tmp_path):
    with pytest.raises(error):
        bt.learning_operators(MESH, **options, cache=tmp_path)
    assert not list(tmp_path.iterdir())


def test_the_second_time_is_read_with_the_same_bits(tmp_path, no_more_work):
    folder = tmp_path / "new" / "folder"
    made = bt.learning_operators(MESH, 9, cache=folder)
    no_more_work()
    again = bt.Mesh(MESH.vertices.astype(np.float64)[::1].copy(), MESH.faces.astype(np.int32))
    assert same(made, bt.learning_operators(again, 9, cache=str(folder)))
    assert len(list(folder.iterdir())) == 1


def test_all_that_the_result_depends_on_is_in_the_name(tmp_path):
    moved = MESH.vertices.copy()
    moved[3, 1] = np.nextafter(moved[3, 1], 9)
    others = [
        (MESH, 9, {}),
        (MESH, 8, {}),
        (MESH, 9, {"weights": "combinatorial"}),
        (MESH, 9, {"mass": "barycentric"}),
        (bt.Mesh(moved, MESH.faces), 9, {}),
        (bt.Mesh(MESH.vertices, MESH.faces[:, [1, 2, 0]]), 9, {}),
    ]
    for mesh, k, options in others:
        bt.learning_operators(mesh, k, **options, cache=tmp_path)
    assert len(list(tmp_path.iterdir())) == len(others)


def damages(place):
    whole = place.read_bytes()
    arrays = read_arrays(place, KIND, VERSION)
    yield whole[: len(whole) // 2]
    yield b""
    middle = len(whole) // 2
    yield whole[:middle] + bytes([whole[middle] ^ 1]) + whole[middle + 1 :]
    changes = [
        {"eigenvalues": arrays["eigenvalues"][:-1]},
        {"stiffness_columns": arrays["stiffness_columns"][::-1].copy()},
        {"masses": arrays["masses"] * np.nan},
        {"frames": arrays["frames"].astype(np.float32)},
    ]
    for change in changes:
        write_arrays(place, KIND, VERSION, {**arrays, **change})
        yield place.read_bytes()
    del arrays["gradient_x"]
    write_arrays(place, KIND, VERSION, arrays)
    yield place.read_bytes()


def test_a_damaged_file_is_told_and_made_anew(tmp_path):
    made = bt.learning_operators(MESH, 9, cache=tmp_path)
    (place,) = tmp_path.iterdir()
    whole = place.read_bytes()
    for content in list(damages(place)):
        place.write_bytes(content)
        with pytest.warns(RuntimeWarning, match="made anew"):
            again = bt.learning_operators(MESH, 9, cache=tmp_path)
        assert same(made, again)
        assert place.read_bytes() == whole


def test_a_folder_that_cannot_be_written_is_told(tmp_path):
    (tmp_path / "file").write_bytes(b"")
    with pytest.raises(OSError, match="file"):
        bt.learning_operators(MESH, 9, cache=tmp_path / "file")


def test_threads_share_a_folder(tmp_path, no_more_work):
    gate = threading.Barrier(4)

    def one(_):
        gate.wait()
        return bt.learning_operators(MESH, 9, cache=tmp_path)

    with ThreadPoolExecutor(4) as pool:
        first, *others = pool.map(one, range(4))
    assert all(same(first, other) for other in others)
    assert [path.suffix for path in tmp_path.iterdir()] == [".npz"]
    no_more_work()
    assert same(first, bt.learning_operators(MESH, 9, cache=tmp_path))
