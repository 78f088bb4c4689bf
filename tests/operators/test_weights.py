import numpy as np
import pytest

import dense_oracles as oracle
from beltrami.errors import (
    DegenerateFaceError,
    DimensionError,
    EmptyMeshError,
    MeshError,
    NonFiniteError,
    UnknownNameError,
)
from beltrami.mesh.mesh import Mesh
from beltrami.operators.intrinsic import intrinsic_delaunay
from beltrami.operators.laplacian import laplacian
from beltrami.operators.weights import WEIGHTS, edge_weights, weigh_edges
from meshes_of_the_errata import IRREGULAR, MESHES, triangle


@pytest.mark.chapter("X3", "Q3.3")
@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("kind", WEIGHTS)
def test_against_angles_and_lengths(name, kind):
    mesh = MESHES[name]()
    W = edge_weights(mesh, kind)
    expected = oracle.weights(mesh, kind)
    assert np.allclose(W.toarray(), expected, rtol=1e-9, atol=1e-9)
    assert W.has_sorted_indices
    assert W.nnz == 2 * len(mesh.edges)  # zero weights are stored too
    assert np.array_equal(W.toarray(), W.toarray().T)
    assert np.array_equal(W.toarray()[tuple(mesh.edges.T)], weigh_edges(mesh, kind))


def test_a_face_more_on_an_edge_adds_its_cotangent():
    mesh = MESHES["leaves"]()
    cot = 1 / np.tan(oracle.angles(mesh)[:, 2])
    assert edge_weights(mesh, "cotangent")[0, 1] == pytest.approx(cot.sum() / 2)


@pytest.mark.chapter("X3")
@pytest.mark.parametrize("kind", WEIGHTS)
def test_dependence_on_the_unit(kind):
    mesh = MESHES["obt"]()
    larger = mesh.with_vertices(3 * mesh.vertices + 5)
    factor = {"combinatorial": 1, "distance": 1 / 9, "cotangent": 1}[kind]
    assert np.allclose(weigh_edges(larger, kind), factor * weigh_edges(mesh, kind), rtol=1e-9)


@pytest.mark.parametrize("unit", [1e-9, 1e9])
def test_a_good_triangle_is_good_in_any_unit(unit):
    mesh = triangle(50, 60)
    other = mesh.with_vertices(unit * mesh.vertices)
    assert np.allclose(weigh_edges(other, "cotangent"), weigh_edges(mesh, "cotangent"), rtol=1e-14)


@pytest.mark.parametrize("unit", [1e-9, 1.0, 1e9])
def test_a_needle_is_no_degenerate_face(unit):
    mesh = triangle(1e-4, 90)  # area over longest side squared 9e-7
    cot = 1 / np.tan(np.radians(1e-4))
    scaled = mesh.with_vertices(unit * mesh.vertices)
    assert weigh_edges(scaled, "cotangent").max() == pytest.approx(cot / 2, rel=1e-9)


@pytest.mark.chapter("U5")
@pytest.mark.parametrize("name", IRREGULAR)
def test_an_isometry_into_more_dimensions_changes_nothing(name):
    mesh = MESHES[name]()
    rotation = np.linalg.qr(np.random.default_rng(837465).normal(size=(5, 5)))[0]
    embedded = mesh.with_vertices(mesh.vertices @ rotation[: mesh.dimension] + 0.5)
    for kind in WEIGHTS:
        assert np.allclose(
            weigh_edges(embedded, kind), weigh_edges(mesh, kind), rtol=1e-8, atol=1e-9
        )


@pytest.mark.parametrize("name", ["closed", "bad"])
def test_the_order_of_corners_and_faces_does_not_matter(name):
    mesh = MESHES[name]()
    turned = Mesh(mesh.vertices, np.roll(mesh.faces, 1, axis=1)[::-1])
    mirrored = Mesh(mesh.vertices, mesh.faces[:, ::-1])
    expected = weigh_edges(mesh, "cotangent")
    for other in (turned, mirrored):
        assert np.allclose(weigh_edges(other, "cotangent"), expected, rtol=1e-9, atol=1e-10)


@pytest.mark.chapter("P4", "P16")
def test_combinatorial_weights_need_no_positions():
    mesh = MESHES["open"]()
    W = edge_weights(mesh.topology, "combinatorial")
    assert np.array_equal(W.toarray(), edge_weights(mesh, "combinatorial").toarray())
    for kind in ("distance", "cotangent"):
        with pytest.raises(DimensionError, match=f"{kind} weights: a Topology has no"):
            edge_weights(mesh.topology, kind)


def test_misspelt_names_are_answered_with_the_right_ones():
    with pytest.raises(UnknownNameError, match=r"Did you mean 'cotangent'\?") as caught:
        edge_weights(triangle(60, 60), "cotan")
    assert caught.value.choices == (
        "combinatorial", "distance", "cotangent", "clamped", "mean_value"
    )  # fmt: skip


@pytest.mark.chapter("X3")
def test_defects_are_named():
    x = [[0, 0], [1, 0], [0, 1], [2, 0], [1, 1]]
    good, flat, twice = [0, 1, 2], [0, 1, 3], [1, 1, 2]
    with pytest.raises(EmptyMeshError):
        edge_weights(Mesh(x, []), "combinatorial")
    with pytest.raises(DegenerateFaceError, match="remove_degenerate_faces") as caught:
        edge_weights(Mesh(x, [good, flat, [1, 4, 2]]), "cotangent")
    assert caught.value.faces.tolist() == [1]
    for kind in WEIGHTS:
        with pytest.raises(DegenerateFaceError, match="twice") as caught:
            edge_weights(Mesh(x, [good, [1, 4, 2], twice]), kind)
        assert caught.value.faces.tolist() == [2]
    with pytest.raises(NonFiniteError) as caught:
        edge_weights(Mesh([*x[:3], [np.nan, 0], [1, np.inf]], [good, [1, 3, 2]]), "cotangent")
    assert caught.value.vertices.tolist() == [3, 4]
    with pytest.raises(MeshError, match="positive length") as caught:
        edge_weights(Mesh([*x, [1, 0]], [good, [1, 2, 5]]), "distance")
    assert caught.value.edges.tolist() == [[1, 5]]


def test_an_array_is_no_name_of_weights():
    mesh = MESHES["closed"]()
    graph = edge_weights(mesh, "distance")
    for wrong in (np.ones(len(mesh.edges)), [1.0], graph, 5):
        with pytest.raises(UnknownNameError):
            edge_weights(mesh, wrong)
        for domain in (mesh, mesh.topology, intrinsic_delaunay(mesh)):
            with pytest.raises(UnknownNameError):
                laplacian(domain, wrong)
        with pytest.raises(DimensionError, match="a graph has its own"):
            laplacian(graph, wrong)
    with pytest.raises(UnknownNameError):
        laplacian(intrinsic_delaunay(mesh), "")
