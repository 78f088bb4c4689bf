import numpy as np
import pytest
from scipy.sparse import coo_array, csc_matrix, csr_array

import dense_oracles as oracle
from beltrami.errors import (
    DegenerateFaceError,
    DimensionError,
    EmptyMeshError,
    MeshError,
    NonFiniteError,
    UnknownNameError,
    UnreferencedVertexError,
)
from beltrami.mesh.mesh import Mesh
from beltrami.operators.laplacian import laplacian
from beltrami.operators.pair import MASSES
from beltrami.operators.weights import SYMMETRIC_WEIGHTS, WEIGHTS
from meshes_of_the_errata import IRREGULAR, MESHES, triangle


@pytest.mark.chapter("D14")
@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("weights", WEIGHTS)
def test_the_pair_against_dense_matrices(name, weights):
    mesh = MESHES[name]()
    W = oracle.weights(mesh, weights)
    L = oracle.stiffness(W)
    for mass in MASSES:
        pair = laplacian(mesh, weights, mass)
        B = oracle.masses(mesh, mass, W)
        assert np.allclose(pair.stiffness.toarray(), L, rtol=1e-9, atol=1e-10 * L.max())
        assert np.allclose(pair.mass.toarray(), B, rtol=1e-8, atol=1e-10 * B.max())
        assert (pair.weight_kind, pair.mass_kind, pair.n) == (weights, mass, mesh.n_vertices)
        assert pair.domain is mesh


def test_defaults():
    mesh = MESHES["open"]()
    kinds = lambda pair: (pair.weight_kind, pair.mass_kind)  # noqa: E731
    assert kinds(laplacian(mesh)) == ("cotangent", "voronoi")
    assert kinds(laplacian(mesh, "combinatorial")) == ("combinatorial", "degree")
    assert kinds(laplacian(mesh, "distance")) == ("distance", "degree")
    assert kinds(laplacian(mesh.topology)) == ("combinatorial", "degree")
    W = csr_array([[0, 2.0], [2.0, 0]])
    assert kinds(laplacian(W)) == ("given", "degree")
    assert kinds(laplacian(W, "combinatorial", "unit")) == ("combinatorial", "unit")


@pytest.mark.chapter("X3", "P7")
@pytest.mark.parametrize("name", IRREGULAR)
def test_a_graph_of_the_weights_gives_the_same_pair(name):
    mesh = MESHES[name]()
    for weights in WEIGHTS:
        of_mesh = laplacian(mesh, weights, "degree")
        of_graph = laplacian(of_mesh.weights)
        difference = of_mesh.stiffness - of_graph.stiffness
        assert abs(difference).max() <= 1e-12 * abs(of_mesh.stiffness).max()
        assert np.array_equal(of_mesh.edges, of_graph.edges)
        assert np.allclose(of_mesh.edge_weight, of_graph.edge_weight, rtol=1e-12)


def test_any_format_of_sparse_matrix_and_of_number():
    W = np.array([[0, 2, 0, 1], [2, 0, 3, 0], [0, 3, 0, 0], [1, 0, 0, 0]])
    expected = np.diag(W.sum(axis=1)) - W
    unsorted = csr_array((np.array([1, 2, 3, 2, 3, 1]), [3, 0, 2, 0, 1, 0], [0, 1, 3, 5, 6]))
    unsorted = coo_array(
        ([1, 1, 1, 3, 1, 1, 3, 1], ([0, 0, 0, 1, 1, 1, 2, 3], [3, 1, 1, 2, 0, 0, 1, 0]))
    )  # entries given twice are summed
    for matrix in (csr_array(W), csc_matrix(W.astype(np.float32)), unsorted):
        pair = laplacian(matrix)
        assert np.array_equal(pair.stiffness.toarray(), expected)
        assert pair.edges.tolist() == [[0, 1], [0, 3], [1, 2]]


@pytest.mark.parametrize("dtype", [bool, np.uint8, np.int8])
def test_an_adjacency_matrix_of_truth_values_or_small_integers(dtype):
    A = (MESHES["open"]().topology.adjacency.toarray() > 0).astype(dtype)
    pair = laplacian(csr_array(A))
    expected = laplacian(MESHES["open"]().topology).stiffness
    assert np.array_equal(pair.stiffness.toarray(), expected.toarray())


def test_graphs_that_are_refused():
    with pytest.raises(MeshError, match="symmetric"):
        laplacian(csr_array([[0, 1.0], [2.0, 0]]))
    with pytest.raises(MeshError, match="zero diagonal"):
        laplacian(csr_array([[1.0, 1], [1, 0]]))
    with pytest.raises(MeshError, match="square"):
        laplacian(csr_array(np.ones((2, 3))))
    with pytest.raises(MeshError, match="finite"):
        laplacian(csr_array([[0, np.nan], [np.nan, 0]]))
    with pytest.raises(DimensionError, match="'cotangent' weights need a Mesh"):
        laplacian(csr_array([[0, 1.0], [1.0, 0]]), "cotangent")
    with pytest.raises(MeshError, match="no positive degree") as caught:
        laplacian(csr_array([[0, 1.0, 0, 0], [1.0, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0]]))
    assert caught.value.vertices.tolist() == [2, 3]
    with pytest.raises(UnknownNameError) as wrong:
        laplacian(csr_array([[0, 1.0], [1.0, 0]]), mass="voronoi")
    assert wrong.value.choices == ("degree", "unit")


def test_other_domains_are_refused():
    for domain in (np.eye(3), "bunny", None, [[0, 1, 2]]):
        with pytest.raises(DimensionError, match="cannot make a Laplacian"):
            laplacian(domain)


def test_misspelt_names():
    mesh = triangle(60, 60)
    with pytest.raises(UnknownNameError, match="Did you mean 'combinatorial'") as caught:
        laplacian(mesh, "combinatoric")
    assert caught.value.choices == (*SYMMETRIC_WEIGHTS, "intrinsic_delaunay", "tufted")
    with pytest.raises(UnknownNameError, match="Did you mean 'barycentric'") as caught:
        laplacian(mesh, mass="barycenter")
    assert caught.value.choices == MASSES


def test_defects_are_named():
    x = [[0.0, 0], [1, 0], [0, 1], [2, 0], [1, 1]]
    with pytest.raises(EmptyMeshError):
        laplacian(Mesh(x, []))
    with pytest.raises(UnreferencedVertexError) as stray:
        laplacian(Mesh(x, [[0, 1, 2]]))
    assert stray.value.vertices.tolist() == [3, 4]
    with pytest.raises(UnreferencedVertexError):
        laplacian(Mesh(x, [[0, 1, 2]]).topology)
    with pytest.raises(DegenerateFaceError) as flat:
        laplacian(Mesh(x[:4], [[0, 1, 2], [0, 1, 3]]))
    assert flat.value.faces.tolist() == [1]
    for mass in ("voronoi", "barycentric", "consistent"):  # the areas need good faces too
        with pytest.raises(DegenerateFaceError):
            laplacian(Mesh(x[:4], [[0, 1, 2], [0, 1, 3]]), "combinatorial", mass)
    with pytest.raises(NonFiniteError) as nan:
        laplacian(Mesh([[0, 0], [np.nan, 0], [0, 1]], [[0, 1, 2]]))
    assert nan.value.vertices.tolist() == [1]


def test_a_topology_has_no_areas():
    for mass in ("voronoi", "barycentric", "consistent"):
        with pytest.raises(DimensionError, match=f"the {mass} mass: a Topology has no"):
            laplacian(MESHES["open"]().topology, mass=mass)


@pytest.mark.parametrize("unit", [1e-9, 1e9])
@pytest.mark.parametrize("name", IRREGULAR)
def test_the_unit_of_length_changes_only_the_areas(name, unit):
    mesh = MESHES[name]()
    pair, other = laplacian(mesh), laplacian(mesh.with_vertices(unit * mesh.vertices))
    scale = abs(pair.stiffness).max()
    assert abs(pair.stiffness - other.stiffness).max() < 1e-9 * scale
    assert np.allclose(other.masses / unit**2, pair.masses, rtol=1e-8)


def test_meshes_that_are_no_manifold_are_accepted():
    two = Mesh([*MESHES["leaves"]().vertices], [[0, 1, 2], [1, 0, 3], [2, 1, 0], [0, 1, 4]])
    W = oracle.weights(two, "cotangent")  # a face twice counts twice
    assert np.allclose(laplacian(two).stiffness.toarray(), oracle.stiffness(W))
