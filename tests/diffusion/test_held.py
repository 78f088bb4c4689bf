import numpy as np
import pytest
from scipy.sparse import csr_array

import dense_oracles as oracle
from beltrami.diffusion.heat import heat
from beltrami.diffusion.held import free_part, held_values, held_vertices, like_columns
from beltrami.diffusion.interpolate import interpolate
from beltrami.diffusion.poisson import poisson
from beltrami.diffusion.regularize import regularize
from beltrami.diffusion.smooth_mesh import smooth_mesh
from beltrami.diffusion.smoothing import smooth
from beltrami.diffusion.smoothing_methods import SMOOTHING_METHODS
from beltrami.diffusion.steady import steady_state
from beltrami.diffusion.wave import wave
from beltrami.errors import DimensionError, MeshError, NonFiniteError
from beltrami.mesh.connectivity import component_labels
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import grid
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import IRREGULAR, MESHES


def two_parts():
    """``cur`` and a smaller copy of it far away, the vertices of both mixed."""
    one = MESHES["cur"]()
    x = np.concatenate([one.vertices, 0.3 * one.vertices + 5])
    order = np.random.default_rng(29979).permutation(len(x))
    faces = np.concatenate([one.faces, one.faces + one.n_vertices])
    return Mesh(x[order], np.argsort(order)[faces])


@pytest.mark.parametrize("mass", ["voronoi", "consistent"])
@pytest.mark.parametrize("name", IRREGULAR)
def test_the_blocks_are_those_of_the_matrices(name, mass):
    pair = laplacian(MESHES[name](), mass=mass)
    held = np.random.default_rng(4).uniform(size=pair.n) < 0.2
    part = free_part(pair.stiffness, pair.mass, held)
    L, B = pair.stiffness.toarray(), pair.mass.toarray()
    assert np.array_equal(part.stiffness.toarray(), L[~held][:, ~held])
    assert np.array_equal(part.stiffness_border.toarray(), L[~held][:, held])
    assert np.array_equal(part.mass.toarray(), B[~held][:, ~held])
    assert np.array_equal(part.mass_border.toarray(), B[~held][:, held])
    if mass == "consistent":
        assert part.masses is None
    else:
        assert np.array_equal(part.masses, B.diagonal()[~held])
    assert part.floating.shape == ((~held).sum(), 0)


def test_what_floats_is_a_component_without_a_held_vertex():
    mesh = two_parts()
    labels = component_labels(mesh.edges, mesh.n_vertices)
    pair = laplacian(mesh)
    everything = free_part(pair.stiffness, pair.mass, np.zeros(pair.n, bool))
    indicators = np.stack([labels == 0, labels == 1], axis=1)
    assert np.array_equal(everything.floating.toarray(), indicators)
    assert np.array_equal(everything.pins, [np.flatnonzero(labels == k)[0] for k in (0, 1)])
    held = held_vertices(np.flatnonzero(labels == 1)[7], pair.n)
    part = free_part(pair.stiffness, pair.mass, held)
    assert np.array_equal(part.floating.toarray()[:, 0], labels[~held] == 0)
    u = oracle.rough_functions(mesh)[~held]
    means = pair.masses[labels == 0] @ u[labels[~held] == 0] / pair.masses[labels == 0].sum()
    level = part.level(part.mass @ u)
    assert np.allclose(level[labels[~held] == 0], means, rtol=1e-13)
    assert not level[labels[~held] == 1].any()
    assert np.array_equal(part.centred(u), u - level)


def test_entries_that_are_stored_and_zero_join_nothing():
    L = np.array([[1.0, -1, 0, 0], [-1, 1, 0, 0], [0, 0, 1, -1], [0, 0, -1, 1]])
    rows, columns = np.nonzero(np.ones((4, 4)))
    stored = csr_array((4, 4))
    stored = csr_array((L.ravel(), columns, np.arange(0, 17, 4)), shape=(4, 4))
    assert stored.nnz == 16
    assert len(rows) == 16
    part = free_part(stored, csr_array(np.eye(4)), np.zeros(4, bool))
    assert part.floating.toarray().T.tolist() == [[1, 1, 0, 0], [0, 0, 1, 1]]
    part = free_part(stored, csr_array(np.eye(4)), np.array([True, False, False, False]))
    assert part.floating.toarray().T.tolist() == [[0, 1, 1]]


def test_values_come_in_the_order_of_the_indices():
    held, values = held_values([5, 2, 3], [50.0, 20.0, 30.0], 7)
    assert np.flatnonzero(held).tolist() == [2, 3, 5]
    assert values.tolist() == [20, 30, 50]
    mask = np.array([False, True, True])
    assert held_values(mask, 4, 3)[1].tolist() == [4, 4]
    assert held_values([1, 0], [[1, 2], [3, 4]], 3)[1].tolist() == [[3, 4], [1, 2]]
    assert held_values((), 0.0, 3)[1].shape == (0,)
    with pytest.raises(MeshError, match="held twice") as caught:
        held_values([1, 2, 1], 0, 3)
    assert caught.value.vertices.tolist() == [1]
    for wrong in ([1, 2], [[[1]], [[2]], [[3]]]):
        with pytest.raises(DimensionError, match="3 held vertices"):
            held_values([0, 1, 2], wrong, 3)
    with pytest.raises(NonFiniteError):
        held_values([0], np.nan, 3)


def test_a_second_function_has_the_columns_of_the_first():
    f = np.zeros((3, 2))
    assert like_columns([1, 2, 3], f, "g").tolist() == [[1, 1], [2, 2], [3, 3]]
    assert np.array_equal(like_columns(f + 1, f, "g"), f + 1)
    for g in (np.zeros((3, 3)), np.zeros((3, 1)), np.zeros(2)):
        with pytest.raises(DimensionError, match="the speed"):
            like_columns(g, f, "the speed")
    with pytest.raises(DimensionError):
        like_columns(f, np.zeros(3), "g")


@pytest.mark.parametrize("mass", ["voronoi", "degree", "consistent"])
@pytest.mark.parametrize("hold", [False, True])
def test_the_state_at_rest_against_a_dense_pseudoinverse(mass, hold):
    mesh = two_parts()
    pair = laplacian(mesh, mass=mass)
    held = np.zeros(pair.n, bool)
    held[[3, 77] if hold else []] = True
    part = free_part(pair.stiffness, pair.mass, held)
    load = oracle.rough_functions(mesh)[~held]
    load -= part.mass @ part.level(load)
    u = steady_state(part, load)
    expected = np.linalg.pinv(part.stiffness.toarray(), rcond=1e-12) @ load
    assert np.allclose(u, part.centred(expected), atol=1e-8 * np.abs(expected).max())


def test_a_single_vertex_is_at_rest():
    part = free_part(csr_array((1, 1)), csr_array(np.eye(1)), np.zeros(1, bool))
    assert steady_state(part, np.zeros(1)).tolist() == [0]


ALL_HELD = {
    "smooth": lambda pair, f, hold: smooth(
        laplacian(pair.domain, "combinatorial"), f, 2, hold=hold
    ),
    "heat": lambda pair, f, hold: heat(pair, f, 1.0, hold=hold),
    "heat for no time": lambda pair, f, hold: heat(pair, f, 0.0, hold=hold),
    "wave": lambda pair, f, hold: list(wave(pair, f, None, [0, 1], hold=hold)),
    "regularize": lambda pair, f, hold: regularize(pair, f, 1.0, hold=hold),
    "interpolate": lambda pair, f, hold: interpolate(pair, hold, f),
    "poisson": lambda pair, f, hold: poisson(pair, f, hold=hold),
    "smooth_mesh": lambda pair, _, hold: smooth_mesh(pair.domain, hold=hold),
}


@pytest.mark.parametrize("name", ALL_HELD)
def test_a_problem_with_nothing_free_is_refused(name):
    pair = laplacian(MESHES["open"]())
    f, hold = oracle.rough_functions(pair.domain, 1)[:, 0], np.ones(pair.n, bool)
    with pytest.raises(MeshError, match=r"all vertices are held\. Leave some free"):
        ALL_HELD[name](pair, f, hold)
    hold[7] = False
    ALL_HELD[name](pair, f if name != "interpolate" else f[hold], hold)


@pytest.mark.parametrize("method", SMOOTHING_METHODS)
def test_a_mesh_that_is_all_boundary_cannot_hold_it(method):
    strip = grid(6, 1)
    time = {"time": 0.1} if "time" in SMOOTHING_METHODS[method].options else {}
    with pytest.raises(MeshError, match="all vertices are held"):
        smooth_mesh(strip, method, hold_boundary=True, **time)
