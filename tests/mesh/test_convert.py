from types import SimpleNamespace

import numpy as np
import pytest

from beltrami.errors import MeshError
from beltrami.mesh.convert import as_mesh
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import icosphere

X, F = icosphere(0).vertices, icosphere(0).faces


class Vector:
    """Like the vectors of open3d: no array, but it can be made one."""

    def __init__(self, values):
        self.values = np.asarray(values)

    def __array__(self, dtype=None, copy=None):
        return self.values.astype(dtype) if dtype else self.values.copy()


def test_a_mesh_is_returned_itself():
    mesh = Mesh(X, F)
    assert as_mesh(mesh) is mesh


@pytest.mark.parametrize("pair", [(X, F), [X, F], (X.tolist(), F.tolist())])
def test_pairs(pair):
    mesh = as_mesh(pair)
    assert np.array_equal(mesh.vertices, X)
    assert np.array_equal(mesh.faces, F)


@pytest.mark.parametrize(
    "source",
    [
        SimpleNamespace(vertices=X, faces=F),
        SimpleNamespace(vertices=Vector(X), triangles=Vector(F)),
        SimpleNamespace(points=X, regular_faces=F, faces=np.zeros(80)),
        SimpleNamespace(points=X, cells_dict={"line": np.zeros((1, 2), int), "triangle": F}),
        SimpleNamespace(coordinates=X, faces=F),
        SimpleNamespace(pos=Vector(X), face=Vector(F.T)),
    ],
    ids=["trimesh", "open3d", "pyvista", "meshio", "nilearn", "torch_geometric"],
)
def test_objects_of_other_libraries(source):
    mesh = as_mesh(source)
    assert np.array_equal(mesh.vertices, X)
    assert np.array_equal(mesh.faces, F)


def test_what_comes_back_cannot_be_changed_from_outside():
    trimesh = pytest.importorskip("trimesh")
    theirs = trimesh.Trimesh(X.copy(), F.copy(), process=False)
    mesh = as_mesh(theirs)
    theirs.vertices[0] = 99
    assert np.array_equal(mesh.vertices, X)


@pytest.mark.parametrize("source", [None, 5, "mesh.obj", (X, F, F), {"vertices": X}, X])
def test_what_is_no_mesh_is_named(source):
    with pytest.raises(MeshError, match=f"type {type(source).__name__}") as caught:
        as_mesh(source)
    assert "(vertices, faces)" in caught.value.remedy


def test_a_meshio_object_without_triangles():
    meshio = pytest.importorskip("meshio")
    with pytest.raises(MeshError, match="line"):
        as_mesh(meshio.Mesh(np.zeros((4, 3)), [("line", [[0, 1]])]))


def test_quads_beside_triangles_are_not_lost_in_silence():
    meshio = pytest.importorskip("meshio")
    x = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0]]
    mixed = meshio.Mesh(x, [("triangle", [[1, 4, 2]]), ("quad", [[0, 1, 2, 3]])])
    mesh = as_mesh(mixed)
    assert mesh.faces.tolist() == [[1, 4, 2], [0, 1, 2], [0, 2, 3]]
    assert mesh.area == pytest.approx(1.5)


def test_pyvista_polygons_that_are_not_triangles():
    with pytest.raises(MeshError):
        as_mesh(SimpleNamespace(points=np.zeros((4, 3)), regular_faces=np.array([[0, 1, 2, 3]])))


def test_images_of_nibabel_are_surfaces_or_refused():
    gifti = pytest.importorskip("nibabel").gifti
    points = gifti.GiftiDataArray(X.astype(np.float32), intent="NIFTI_INTENT_POINTSET")
    triangles = gifti.GiftiDataArray(F.astype(np.int32), intent="NIFTI_INTENT_TRIANGLE")
    shape = gifti.GiftiDataArray(np.ones(len(X), np.float32), intent="NIFTI_INTENT_SHAPE")
    mesh = as_mesh(gifti.GiftiImage(darrays=[shape, points, triangles]))
    assert np.array_equal(mesh.vertices, X.astype(np.float32))
    assert np.array_equal(mesh.faces, F)
    for arrays in ([shape], [points], [points, triangles, points]):
        with pytest.raises(MeshError, match="GIFTI"):
            as_mesh(gifti.GiftiImage(darrays=arrays))


def test_points_of_torch_geometric_without_faces_are_no_mesh():
    with pytest.raises(MeshError, match="cannot make a mesh"):
        as_mesh(SimpleNamespace(pos=X, face=None))
