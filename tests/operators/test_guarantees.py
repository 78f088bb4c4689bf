"""What ``properties`` tells is true, and what it denies fails somewhere: each by a number."""

import numpy as np
import pytest
from scipy.sparse import csr_array

import dense_oracles as oracle
from beltrami.diffusion.heat import heat
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import icosphere
from beltrami.operators.guarantees import WEIGHT_KINDS
from beltrami.operators.laplacian import laplacian
from beltrami.operators.weights import SYMMETRIC_WEIGHTS, edge_weights, weigh_edges
from meshes_of_the_errata import MESHES, flipped, triangle

INTRINSIC_WEIGHTS = ("intrinsic_delaunay", "tufted")
KINDS = (*SYMMETRIC_WEIGHTS, *INTRINSIC_WEIGHTS)
CASES = [(name, kind) for name in MESHES for kind in KINDS]


@pytest.mark.chapter("T7", "T9", "P34", "R1")
@pytest.mark.parametrize(("name", "kind"), CASES)
def test_what_is_told_holds(name, kind):
    pair = laplacian(MESHES[name](), kind)
    told = pair.properties
    L, B = pair.stiffness.toarray(), pair.mass.toarray()
    assert told.symmetric
    assert np.array_equal(L, L.T)
    assert told.positive_semidefinite
    values = np.linalg.eigvalsh(L)
    assert values[0] > -1e-11 * values[-1]
    assert (values < 1e-11 * values[-1]).sum() == told.kernel_dimension
    assert oracle.spectrum(L, B)[-1] <= told.spectral_bound * (1 + 1e-9)
    W = pair.weights.toarray()
    assert told.non_negative_weights is bool(W.min() > -1e-12)
    assert told.maximum_principle is told.non_negative_weights
    assert "positive semi-definite" in repr(pair)


def _harmonic(L, given, values):
    """Solve Lf = 0 where nothing is given."""
    free = np.setdiff1d(np.arange(len(L)), given)
    f = np.zeros(len(L))
    f[given] = values
    f[free] = np.linalg.solve(L[np.ix_(free, free)], -L[np.ix_(free, given)] @ values)
    return f


def _heat(pair, t):
    """Dense exp(-t B⁻¹ L)."""
    root = np.sqrt(pair.masses)
    values, u = np.linalg.eigh(pair.stiffness.toarray() / root[:, None] / root)
    return (u * np.exp(-t * values)) @ u.T / root[:, None] * root


@pytest.mark.chapter("T9", "D9")
@pytest.mark.parametrize(("name", "kind"), CASES)
def test_the_maximum_principle_holds_where_it_is_told(name, kind):
    pair = laplacian(MESHES[name](), kind)
    if not pair.properties.maximum_principle:
        return
    rng = np.random.default_rng(17)
    f = _harmonic(pair.stiffness.toarray(), np.array([0, 1, 2]), np.array([0.0, 1.0, 0.4]))
    assert f.min() >= -1e-9
    assert f.max() <= 1 + 1e-9
    for t in (1e-3, 0.05, 1.0):
        kernel = _heat(pair, t * pair.masses.sum() / pair.n)
        assert kernel.min() > -1e-12
    smoothed = pair.averaging @ (g := rng.normal(size=pair.n))
    assert g.min() <= smoothed.min()
    assert smoothed.max() <= g.max()
    assert np.linalg.eigvalsh(pair.normalized.toarray())[-1] <= 2 + 1e-12


@pytest.mark.chapter("T9", "D9")
def test_the_maximum_principle_fails_where_it_is_denied():
    pair = laplacian(triangle(15, 150))  # S3 of the errata
    assert not pair.properties.maximum_principle
    f = _harmonic(pair.stiffness.toarray(), np.array([1, 2]), np.array([1.0, 0.0]))
    assert f.max() > 1.5
    assert _heat(laplacian(triangle(15, 150), mass="degree"), 1.0).min() < -0.1
    for name in ("bad", "obt"):
        pair = laplacian(MESHES[name]())
        assert not pair.properties.maximum_principle
        assert _heat(pair, 1e-3 * pair.masses.sum()).min() < -1e-3
        kernels = _heat(laplacian(MESHES[name](), "clamped"), 1e-3 * pair.masses.sum())
        assert kernels.min() > -1e-12


def test_with_the_consistent_mass_heat_leaves_the_range_of_its_start():
    """Whatever the weights: a short step is nearly B⁻¹B, and B⁻¹ has negative entries."""
    mesh = MESHES["tor"]()
    spot = np.zeros(mesh.n_vertices)
    spot[0] = 1
    for mass, stays in (("voronoi", True), ("consistent", False)):
        pair = laplacian(mesh, "clamped", mass)
        assert pair.properties.maximum_principle
        warm = heat(pair, spot, 1e-3 * pair.masses.min(), steps=1)
        assert bool(warm.min() >= 0) is stays


def _imprecision(W, mesh):
    """Largest |Σ_j w_ij (x_j - x_i)| / Σ_j w_ij over the inner vertices."""
    inner = np.setdiff1d(np.arange(mesh.n_vertices), mesh.topology.boundary_edges)
    D = np.asarray(W.sum(axis=1))[:, None]
    return np.abs((W @ mesh.vertices) / D - mesh.vertices)[inner].max()


@pytest.mark.chapter("P21", "D14")
@pytest.mark.parametrize("kind", [*SYMMETRIC_WEIGHTS, "mean_value"])
def test_linear_precision(kind):
    told = WEIGHT_KINDS[kind].linear_precision
    assert told is (kind in ("cotangent", "mean_value"))
    meshes = [MESHES["open"](), MESHES["bad"](), *(flipped(s, aspect=0.4) for s in range(3))]
    off = [_imprecision(edge_weights(mesh, kind), mesh) for mesh in meshes]
    assert max(off) < 1e-11 if told else max(off) > 0.02
    if kind in SYMMETRIC_WEIGHTS:
        assert laplacian(meshes[0], kind).properties.linear_precision is told


@pytest.mark.chapter("P16", "P17")
@pytest.mark.parametrize("kind", [*SYMMETRIC_WEIGHTS, "mean_value"])
def test_what_the_weights_are_made_of(kind):
    """Move the vertices; then join the same edges by other faces: only what is needed counts."""
    known = WEIGHT_KINDS[kind]
    mesh = MESHES["closed"]()
    moved = mesh.with_vertices(mesh.vertices * [1, 2, 3])
    difference = abs(edge_weights(moved, kind) - edge_weights(mesh, kind)).max()
    assert bool(difference > 1e-3) is known.needs_positions
    corner = [[0, 0, 0], [1, 0, 0], [0, 1.5, 0], [0, 0, 2]]
    three, all_four = (
        [[0, 1, 2], [0, 3, 1], [0, 2, 3]],
        [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]],
    )
    one, other = (edge_weights(Mesh(corner, f), kind) for f in (three, all_four))
    assert one.nnz == other.nnz
    assert bool(abs(one - other).max() > 1e-3) is known.needs_faces
    W = edge_weights(MESHES["bad"](), kind)
    assert bool(abs(W - W.T).max() == 0) is known.symmetric
    assert bool(W.data.min() >= 0) is known.non_negative
    if kind in SYMMETRIC_WEIGHTS:
        told = laplacian(mesh, kind).properties
        assert (told.needs_positions, told.needs_faces) == (
            known.needs_positions, known.needs_faces,
        )  # fmt: skip


@pytest.mark.chapter("T7")
def test_the_kernel_counts_components():
    sphere = icosphere(1)
    n = sphere.n_vertices
    two = Mesh(
        np.concatenate([sphere.vertices, sphere.vertices + 3]),
        np.concatenate([sphere.faces, sphere.faces + n]),
    )
    for kind in SYMMETRIC_WEIGHTS:
        assert laplacian(two, kind).properties.kernel_dimension == 2
        assert laplacian(two.topology).properties.kernel_dimension == 2
    right = MESHES["pl"]()  # its diagonals have no weight, and yet it is connected
    assert laplacian(right).properties.kernel_dimension == 1
    cut = lambda m: (m.edges != 4).all(axis=1).astype(float)  # noqa: E731
    lonely = laplacian(right, cut, "unit")
    assert lonely.properties.kernel_dimension == 2
    assert (np.linalg.eigvalsh(lonely.stiffness.toarray()) < 1e-12).sum() == 2
    bow = Mesh([[0, 0], [1, 0], [0, 1], [-1, 0], [0, -1]], [[0, 1, 2], [0, 3, 4]])
    for kind in SYMMETRIC_WEIGHTS:  # joined by one vertex
        assert laplacian(bow, kind).properties.kernel_dimension == 1


@pytest.mark.chapter("T7", "P34")
def test_of_a_graph_with_negative_weights_nothing_is_proven():
    W = csr_array([[0, -1.0, 0], [-1.0, 0, 3], [0, 3, 0]])
    pair = laplacian(W, mass="unit")
    told = pair.properties
    assert not told.positive_semidefinite
    assert np.linalg.eigvalsh(pair.stiffness.toarray())[0] < -0.5
    assert told.kernel_dimension is None
    assert not told.maximum_principle
    assert told.negative_edges.tolist() == [[0, 1]]
    assert "of either sign" in repr(pair)
    assert not told.linear_precision
    graph = laplacian(csr_array((3, 3)), mass="unit")
    assert graph.properties.kernel_dimension == 3


@pytest.mark.chapter("T9")
def test_rounding_is_no_negative_weight_for_cotangents_only():
    assert weigh_edges(MESHES["pl"](), "cotangent").min() > -1e-12
    turned = MESHES["pl"]().with_vertices(MESHES["pl"]().vertices @ [[0.6, 0.8], [-0.8, 0.6]])
    assert laplacian(turned).properties.maximum_principle
    tiny = csr_array([[0, 1.0, -1e-13], [1.0, 0, 1.0], [-1e-13, 1.0, 0]])
    assert not laplacian(tiny).properties.maximum_principle
