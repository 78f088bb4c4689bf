import sys
from types import SimpleNamespace

import numpy as np
import pytest

from beltrami.errors import MissingExtraError, UnknownNameError
from beltrami.mesh.export import TARGETS, export
from beltrami.mesh.shapes import icosphere

X, F = icosphere(0).vertices, icosphere(0).faces


@pytest.fixture
def pyvista(monkeypatch):
    def from_regular_faces(x, f):
        return SimpleNamespace(points=x, regular_faces=f)

    polydata = SimpleNamespace(from_regular_faces=from_regular_faces)
    monkeypatch.setitem(sys.modules, "pyvista", SimpleNamespace(PolyData=polydata))


@pytest.fixture
def open3d(monkeypatch):
    def triangle_mesh(x, f):
        return SimpleNamespace(vertices=x, triangles=f)

    stand_in = SimpleNamespace(
        geometry=SimpleNamespace(TriangleMesh=triangle_mesh),
        utility=SimpleNamespace(Vector3dVector=np.array, Vector3iVector=np.array),
    )
    monkeypatch.setitem(sys.modules, "open3d", stand_in)


def test_arrays_are_copies_that_may_be_changed():
    x, f = icosphere(0).to("arrays")
    assert np.array_equal(x, X)
    assert np.array_equal(f, F)
    x[:], f[:] = 0, 0
    assert icosphere(0).area > 0


def test_trimesh_merges_nothing():
    pytest.importorskip("trimesh")
    soup = X[F].reshape(-1, 3)
    theirs = export(soup, np.arange(60).reshape(-1, 3), "trimesh")
    assert theirs.vertices.shape == (60, 3)
    assert np.array_equal(export(X, F, "trimesh").faces, F)


def test_meshio():
    pytest.importorskip("meshio")
    theirs = export(X, F, "meshio")
    assert np.array_equal(theirs.points, X)
    assert np.array_equal(theirs.cells_dict["triangle"], F)


def test_pyvista(pyvista):
    theirs = export(X, F, "pyvista")
    assert np.array_equal(theirs.points, X)
    assert np.array_equal(theirs.regular_faces, F)


def test_open3d(open3d):
    theirs = export(X, F, "open3d")
    assert np.array_equal(theirs.vertices, X)
    assert np.array_equal(theirs.triangles, F)


def test_unknown_target():
    with pytest.raises(UnknownNameError, match="'trimesh'") as caught:
        export(X, F, "trimsh")
    assert caught.value.choices == TARGETS


@pytest.mark.parametrize(
    ("target", "extra"),
    [("trimesh", "io"), ("meshio", "io"), ("pyvista", "view"), ("open3d", "view")],
)
def test_a_library_that_is_not_installed(monkeypatch, target, extra):
    monkeypatch.setitem(sys.modules, target, None)
    with pytest.raises(MissingExtraError) as caught:
        export(X, F, target)
    assert (caught.value.package, caught.value.extra) == (target, extra)
