import numpy as np
import pytest

import dense_oracles as oracle
from beltrami.errors import (
    DegenerateFaceError,
    EmptyMeshError,
    NonFiniteError,
    UnknownNameError,
)
from beltrami.mesh.mesh import Mesh
from beltrami.operators.edge_areas import EDGE_AREA_KINDS, edge_areas
from meshes_of_the_errata import MESHES, triangle

pytestmark = pytest.mark.chapter("D11", "T3")


@pytest.mark.parametrize("name", MESHES)
def test_against_loops_over_the_faces(name):
    mesh = MESHES[name]()
    number = {tuple(e): k for k, e in enumerate(mesh.edges.tolist())}
    expected = {kind: np.zeros(len(mesh.edges)) for kind in EDGE_AREA_KINDS}
    angles, areas = oracle.angles(mesh), oracle.double_areas(mesh) / 2
    for f, face in enumerate(mesh.faces):
        x = mesh.vertices[face]
        lengths = [np.linalg.norm(x[c - 2] - x[c - 1]) for c in range(3)]
        for c in range(3):
            e = number[tuple(sorted((int(face[c - 2]), int(face[c - 1]))))]
            expected["circumcenter"][e] += lengths[c] ** 2 / np.tan(angles[f, c]) / 4
            expected["incenter"][e] += lengths[c] * areas[f] / sum(lengths)
    for kind in EDGE_AREA_KINDS:
        scale = np.abs(expected[kind]).max()
        assert np.allclose(edge_areas(mesh, kind), expected[kind], rtol=1e-8, atol=1e-9 * scale)
    assert np.array_equal(edge_areas(mesh), edge_areas(mesh, "circumcenter"))


@pytest.mark.parametrize("kind", EDGE_AREA_KINDS)
@pytest.mark.parametrize("unit", [1e-9, 1e9, 1e-60])
def test_the_unit_squared(kind, unit):
    mesh = MESHES["obt"]()
    other = edge_areas(mesh.with_vertices(unit * mesh.vertices), kind) / unit**2
    assert np.allclose(other, edge_areas(mesh, kind), rtol=1e-8, atol=1e-12)


def test_errors():
    mesh = triangle(60, 60)
    with pytest.raises(UnknownNameError, match="Did you mean 'incenter'") as caught:
        edge_areas(mesh, "incentre")
    assert caught.value.choices == ("circumcenter", "incenter")
    flat = Mesh([[0, 0], [1, 0], [0, 1], [2, 0]], [[0, 1, 2], [0, 1, 3]])
    for kind in EDGE_AREA_KINDS:
        with pytest.raises(EmptyMeshError):
            edge_areas(Mesh(mesh.vertices, []), kind)
        with pytest.raises(NonFiniteError):
            edge_areas(mesh.with_vertices([[0, 0], [1, np.nan], [0, 1]]), kind)
        with pytest.raises(DegenerateFaceError) as guilty:
            edge_areas(flat, kind)
        assert guilty.value.faces.tolist() == [1]
