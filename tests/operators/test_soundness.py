import numpy as np
import pytest

from beltrami.errors import (
    DegenerateFaceError,
    EmptyMeshError,
    NonFiniteError,
    UnreferencedVertexError,
)
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.repair import repair
from beltrami.mesh.topology import Topology
from beltrami.operators.laplacian import laplacian
from beltrami.operators.soundness import (
    refuse_unreferenced,
    require_faces,
    require_positions,
    require_sound,
)

X = [[0.0, 0], [1, 0], [0, 1], [1, 1], [2, 0]]


def test_a_sound_mesh_passes():
    require_sound(Mesh(X[:4], [[0, 1, 2], [1, 3, 2]]))


def test_no_faces():
    with pytest.raises(EmptyMeshError):
        require_faces(Topology([], 4))


def test_repeated_vertices_name_all_faces_and_the_repair():
    topology = Topology([[0, 1, 2], [1, 1, 3], [0, 2, 3], [4, 2, 4]])
    with pytest.raises(DegenerateFaceError, match="remove_degenerate_faces=True") as caught:
        require_faces(topology)
    assert caught.value.faces.tolist() == [1, 3]


def test_the_repair_that_the_error_names_repairs():
    mesh = Mesh(X, [[0, 1, 2], [1, 1, 3], [1, 3, 2], [0, 1, 4]])
    with pytest.raises(DegenerateFaceError):
        require_sound(mesh)
    repaired = repair(mesh, remove_degenerate_faces=True).mesh
    require_sound(repaired)
    with pytest.raises(UnreferencedVertexError, match="remove_unreferenced") as caught:
        laplacian(repaired)
    assert caught.value.vertices.tolist() == [4]
    assert laplacian(repair(repaired, remove_unreferenced=True).mesh).n == 4


def test_the_share_of_unreferenced_vertices_is_told():
    with pytest.raises(UnreferencedVertexError, match="2 of 5 vertices") as caught:
        refuse_unreferenced(Topology([[0, 2, 4]], 5))
    assert caught.value.vertices.tolist() == [1, 3]


def test_non_finite_positions():
    with pytest.raises(NonFiniteError) as caught:
        require_positions(Mesh([[0, 0], [1, np.nan], [-np.inf, 1]], [[0, 1, 2]]))
    assert caught.value.vertices.tolist() == [1, 2]
