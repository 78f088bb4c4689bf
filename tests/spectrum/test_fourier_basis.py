"""fourier_basis against dense LAPACK and against scipy's eigsh, on everything that has a pair."""

from functools import cache

import numpy as np
import pytest
import scipy.linalg
from scipy.sparse import csc_array, csr_array, diags_array, random_array, triu
from scipy.sparse.linalg import eigsh
from scipy.spatial import Delaunay

import beltrami as bt
from beltrami.errors import BeltramiError, ConvergenceError, MeshError
from beltrami.solvers import finding, slices
from meshes_of_the_errata import MESHES


@cache
def blob(n=620):
    return bt.shapes.blob(n)


def dense(pair, k, near=0.0, hold=()):
    """The k eigenvalues nearest to ``near``, by LAPACK on the unscaled matrices."""
    free = np.ones(pair.n, bool)
    free[list(hold)] = False
    L, B = (matrix[free][:, free].toarray() for matrix in (pair.stiffness, pair.mass))
    values = scipy.linalg.eigh(L, B, eigvals_only=True)
    return np.sort(values[np.argsort(abs(values - near), kind="stable")[:k]])


def assert_right(basis, pair, values, tol=1e-6, accuracy=1e-9):
    """The equation and the orthogonality, from the vectors alone; and the oracle's values."""
    U, found = basis.eigenvectors, basis.eigenvalues
    force = pair.mass @ U * found
    residual = np.linalg.norm(pair.stiffness @ U - force, axis=0)
    inside = found != 0
    ratio = residual[inside] / np.linalg.norm(force, axis=0)[inside]
    assert (ratio <= tol).all()
    assert np.allclose(ratio, basis.residuals[inside], rtol=1e-2, atol=tol / 100)
    assert (residual[~inside] <= 1e-11 * np.abs(pair.stiffness.data).max()).all()
    assert abs(U.T @ (pair.mass @ U) - np.eye(basis.k)).max() < 1e-8
    assert basis.orthogonality < 1e-8
    assert (np.diff(found) >= 0).all()
    largest = (pair.stiffness.diagonal() / pair.mass.diagonal()).max()
    assert abs(found - values).max() <= accuracy * abs(values).max() + 1e-13 * largest


@pytest.mark.chapter("T8")
@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("mass", ["degree", "voronoi", "consistent", "unit"])
def test_small_pairs_against_lapack(name, mass):
    pair = bt.laplacian(MESHES[name](), mass=mass)
    for k in (1, min(20, pair.n), pair.n):
        basis = bt.fourier_basis(pair, k, certify=True)
        assert_right(basis, pair, dense(pair, k), 1e-9, 1e-12)
        assert basis.eigenvalues[0] == 0
        assert basis.computation.counted_within > 0
    near = float(bt.fourier_basis(pair, min(12, pair.n)).eigenvalues[-2:] @ [0.7, 0.3])
    for k in (1, min(8, pair.n)):
        inside = bt.fourier_basis(pair, k, near, certify=True)
        assert_right(inside, pair, dense(pair, k, near), 1e-9, 1e-12)


@pytest.mark.chapter("T8", "P53")
@pytest.mark.parametrize("mass", ["degree", "barycentric", "voronoi", "consistent", "unit"])
@pytest.mark.parametrize("stretch", [1, 12])
def test_lanczos_against_lapack(mass, stretch):
    mesh = blob().with_vertices(blob().vertices * [1, stretch, 1])
    pair = bt.laplacian(mesh, mass=mass)
    assert (pair.edge_weight < 0).any()
    for k in (2, 40):
        basis = bt.fourier_basis(pair, k, certify=True)
        assert basis.computation.method == "lanczos"
        assert basis.computation.precision == "float32" or k == 2
        assert_right(basis, pair, dense(pair, k))
    exact = bt.fourier_basis(pair, 40, tol=1e-11)
    assert exact.computation.precision == "float64"
    assert_right(exact, pair, dense(pair, 40), 1e-11 if stretch == 1 else 1e-9, 1e-11)
    assert exact.orthogonality < 1e-13


@pytest.mark.parametrize("near", [-50.0, 1e-3, 60.0, 1e5])
def test_near_a_number(near):
    pair = bt.laplacian(blob())
    basis = bt.fourier_basis(pair, 15, near, certify=True)
    assert_right(basis, pair, dense(pair, 15, near))
    assert basis.computation.method == "lanczos"
    assert basis.computation.counted_within > 0


def test_near_an_eigenvalue_itself():
    pair = bt.laplacian(bt.shapes.icosphere(3))
    two = bt.fourier_basis(pair, 4, tol=1e-12).eigenvalues[2]
    basis = bt.fourier_basis(pair, 3, two)
    assert_right(basis, pair, np.full(3, two))
    zero = csr_array(diags_array([np.ones(699)], offsets=[1], shape=(700, 700)))
    path = bt.laplacian(csr_array(zero + zero.T), mass="unit")
    assert_right(bt.fourier_basis(path, 1, 4.0), path, dense(path, 1, 4.0))


@pytest.mark.parametrize("unit", [1e-9, 1e-3, 1e9])
def test_the_unit_of_length_changes_nothing(unit):
    plain = bt.fourier_basis(bt.laplacian(blob()), 20)
    pair = bt.laplacian(blob().with_vertices(blob().vertices * unit))
    basis = bt.fourier_basis(pair, 20)
    assert np.allclose(basis.eigenvalues * unit**2, plain.eigenvalues, rtol=1e-10, atol=0)
    assert abs(basis.eigenvectors * unit - plain.eigenvectors).max() < 1e-5
    assert basis.orthogonality < 1e-9
    near = bt.fourier_basis(pair, 5, plain.eigenvalues[9] / unit**2)
    assert np.abs(near.eigenvalues * unit**2 / plain.eigenvalues[9] - 1).min() < 1e-9


def test_multiplicities_of_the_sphere():
    pair = bt.laplacian(bt.shapes.icosphere(4))
    basis = bt.fourier_basis(pair, 49, certify=True)
    levels = np.repeat(np.arange(7), 2 * np.arange(7) + 1)
    exact = levels * (levels + 1.0)
    assert (abs(basis.eigenvalues - exact) <= 0.03 * exact).all()
    assert basis.computation.counted_within > basis.eigenvalues[35]


def copies(mesh, count):
    moved = [mesh.vertices + np.array([9.0 * i, 0, 0]) for i in range(count)]
    faces = [mesh.faces + i * mesh.n_vertices for i in range(count)]
    return bt.Mesh(np.concatenate(moved), np.concatenate(faces))


@pytest.mark.parametrize("k", [1, 12, 20, 21, 70, 130])
def test_twenty_equal_components(k):
    """A multiplicity of 20 x 3, more than a block of Lanczos can hold."""
    pair = bt.laplacian(copies(bt.shapes.icosphere(2), 20))
    one = dense(bt.laplacian(bt.shapes.icosphere(2)), 12)
    basis = bt.fourier_basis(pair, k, certify=k < 30)
    assert_right(basis, pair, np.repeat(one, 20)[:k])
    U = basis.eigenvectors[:, : min(k, 20)]
    assert ((abs(U) > 0).sum(axis=0) == 162).all()  # each constant lives on one component
    assert (U >= 0).all()
    assert (basis.eigenvalues[: min(k, 20)] == 0).all()


@pytest.mark.parametrize("tol", [1e-6, 1e-8, 1e-11])
def test_near_a_number_among_equal_components(tol):
    """Multiplicities of 4 x 3 and more on both sides, which blocks of 8 do not hold."""
    pair = bt.laplacian(copies(bt.shapes.icosphere(2), 4), mass="unit")
    basis = bt.fourier_basis(pair, 33, 1.7789, tol, certify=True)
    nearest = np.sort(abs(dense(pair, pair.n) - 1.7789))[:33]
    assert np.allclose(np.sort(abs(basis.eigenvalues - 1.7789)), nearest, atol=1e-8)
    assert basis.orthogonality < 1e-8


def test_lapack_takes_over_where_lanczos_does_not_arrive(monkeypatch):
    def refuse(*_):
        raise ConvergenceError("no")

    monkeypatch.setattr(finding, "polish", refuse)
    pair = bt.laplacian(blob())
    for near in (0.0, 50.0):
        basis = bt.fourier_basis(pair, 12, near)
        assert basis.computation.method == "dense"
        assert_right(basis, pair, dense(pair, 12, near), 1e-9, 1e-12)
    monkeypatch.setattr(finding, "_BEARABLE", 100)
    with pytest.raises(ConvergenceError):
        bt.fourier_basis(pair, 12)


@pytest.mark.parametrize("mesh", ["blob", "sphere"])
def test_slices_of_the_spectrum(mesh, monkeypatch):
    """The way to thousands of eigenpairs, at the size of hundreds."""
    monkeypatch.setattr(finding, "SLICED", 100)
    monkeypatch.setattr(finding, "LARGE", 500)
    monkeypatch.setattr(finding, "SLICE", 50)
    monkeypatch.setattr(slices, "SLICE", 50)
    pair = bt.laplacian(bt.shapes.icosphere(3) if mesh == "sphere" else blob())
    basis = bt.fourier_basis(pair, 180)
    assert basis.computation.method == "slices"
    assert basis.computation.basis < 400
    assert basis.computation.counted_within > basis.eigenvalues[-1]
    assert_right(basis, pair, dense(pair, 180), 1e-9, 1e-12)
    assert basis.orthogonality < 1e-8


def test_values_held_at_the_boundary_and_on_a_part_of_it():
    """The square: eigenvalues π²(i² + j²) with i, j >= 1, or i >= 1, j >= 0."""
    x = np.linspace(0, 1, 41)
    points = np.stack(np.meshgrid(x, x), axis=-1).reshape(-1, 2)
    mesh = bt.Mesh(points, Delaunay(points).simplices)
    pair = bt.laplacian(mesh, mass="consistent")
    border = (np.minimum(points, 1 - points) < 1e-9).any(axis=1)
    sides = (np.minimum(points, 1 - points) < 1e-9)[:, 0]
    for held, least in ((border, 1), (np.flatnonzero(sides), 0)):
        basis = bt.fourier_basis(pair, 10, hold=held, certify=True)
        i, j = np.meshgrid(np.arange(1, 9), np.arange(least, 9))
        exact = np.sort((np.pi**2 * (i**2 + j**2)).ravel())[:10]
        assert (abs(basis.eigenvalues / exact - 1) < 0.02).all()
        assert (basis.eigenvectors[held] == 0).all()
        assert basis.orthogonality < 1e-8
        assert (basis.eigenvalues > 0).all()
        assert_right_inside(basis, pair, held)
    everywhere = bt.fourier_basis(pair, 1, hold=np.arange(1, pair.n))
    assert everywhere.eigenvalues[0] == pytest.approx(
        pair.stiffness[0, 0] / pair.mass[0, 0], rel=1e-12
    )


def assert_right_inside(basis, pair, held):
    force = pair.mass @ basis.eigenvectors * basis.eigenvalues
    residual = pair.stiffness @ basis.eigenvectors - force
    free = np.ones(pair.n, bool)
    free[held] = False
    ratio = np.linalg.norm(residual[free], axis=0) / np.linalg.norm(force[free], axis=0)
    assert (ratio < 1e-6).all()


def test_a_component_without_held_vertices_keeps_its_constants():
    mesh = copies(bt.shapes.icosphere(3), 2)
    basis = bt.fourier_basis(bt.laplacian(mesh), 6, hold=[0])
    assert (basis.eigenvalues == 0).sum() == 1
    assert (basis.eigenvectors[:642, 0] == 0).all()
    assert np.ptp(basis.eigenvectors[642:, 0]) == 0


def test_graphs():
    rng = np.random.default_rng(271828)
    n = 600
    chain = csr_array(diags_array([np.ones(n - 1)], offsets=[1], shape=(n, n)))
    star = csr_array((np.ones(n - 1), (np.zeros(n - 1, int), np.arange(1, n))), (n, n))
    some = csr_array(triu(random_array((n, n), density=0.015, rng=rng), 1))
    complete = csr_array(np.triu(np.ones((n, n)), 1))
    for half in (chain, star, some, complete):
        for mass in ("unit", "degree"):
            pair = bt.laplacian(csr_array(half + half.T), mass=mass)
            basis = bt.fourier_basis(pair, 12)
            assert_right(basis, pair, dense(pair, 12))


def test_a_graph_with_negative_weights_has_its_nearest_to_zero():
    rng = np.random.default_rng(161803)
    half = csr_array(triu(random_array((700, 700), density=0.01, rng=rng), 1))
    half.data -= 0.4
    W = csr_array(half + half.T)
    d = np.asarray(W.sum(axis=1))
    L = csr_array(diags_array(d) - W)
    pair = bt.Laplacian(
        L, csr_array(diags_array(np.ones(700))), np.zeros((0, 2), int), np.zeros(0), "given", "unit"
    )
    values = dense(pair, 9)
    assert values[0] < 0 < values[-1]
    assert_right(bt.fourier_basis(pair, 9, certify=True), pair, values)


@pytest.mark.chapter("P53")
def test_against_eigsh_on_a_larger_mesh():
    pair = bt.laplacian(blob(2500))
    basis = bt.fourier_basis(pair, 60)
    values = eigsh(
        csc_array(pair.stiffness), 60, csc_array(pair.mass), sigma=-0.1, return_eigenvectors=False
    )
    assert_right(basis, pair, np.maximum(np.sort(values), 0))


def test_slivers_are_solved_as_well_as_rounding_lets():
    rng = np.random.default_rng(141421)
    x = rng.uniform(size=(1200, 2))
    x[:200] = x[200:400] + [[0, 1e-7]] * rng.uniform(size=(200, 1))
    faces = Delaunay(x).simplices
    a, b, c = x[faces].transpose(1, 0, 2)
    flat = abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]) < 1e-11
    pair = bt.laplacian(bt.Mesh(x, faces[~flat]))
    assert np.abs(pair.edge_weight).max() > 1e4
    basis = bt.fourier_basis(pair, 20, certify=True)
    assert_right(basis, pair, dense(pair, 20), 1e-3, 1e-6)


@pytest.mark.parametrize("kind", ["cotangent-voronoi", "cotangent-consistent", "distance-degree"])
@pytest.mark.parametrize("flat", [1e-8, 1e-9, 1e-10, 1e-11])
def test_rounding_makes_no_eigenvalue_of_needles_negative(kind, flat, tmp_path):
    """LAPACK finds -1e5 beside 1e18, and exp(-λ) would be infinite."""
    disk = bt.shapes.disk(3)
    weights, mass = kind.split("-")
    for seed in range(4):
        moved = np.random.default_rng(seed).normal(0, 0.05, disk.vertices.shape)
        mesh = bt.Mesh((disk.vertices + moved) * [1, flat], disk.faces)
        pair = bt.laplacian(mesh, weights, mass=mass)
        basis = bt.fourier_basis(pair, 6)
        assert basis.eigenvalues[0] == 0
        assert (np.diff(basis.eigenvalues) >= 0).all()
        assert np.ptp(basis.eigenvectors[:, 0]) == 0
        assert basis.orthogonality < 1e-6
        assert (bt.kernels.Heat(1)(basis.eigenvalues) <= 1).all()
        zero = basis.eigenvalues == 0
        assert (basis.residuals[zero] < 1e-12).all()
        basis.save(tmp_path / "basis.npz")
        assert bt.load_basis(tmp_path / "basis.npz", pair).k == 6


def test_weights_of_many_sizes(tmp_path):
    """Of the small ones rounding leaves nothing, or less: that is zero, and can be saved."""
    w = np.r_[1e18, 1, 1e-18, 1e-40, 1e18, np.ones(15)]
    chain = csr_array(diags_array([w], offsets=[1], shape=(21, 21)))
    pair = bt.laplacian(csr_array(chain + chain.T), mass="unit")
    for k in (1, 6, 21):
        basis = bt.fourier_basis(pair, k)
        assert (basis.eigenvalues >= 0).all()
        assert np.isfinite(basis.residuals).all()
        basis.save(tmp_path / "basis.npz")
        assert bt.load_basis(tmp_path / "basis.npz", pair).k == k


@pytest.mark.parametrize("seed", [37, 110, 238])
def test_what_rounding_left_of_held_problems_can_be_saved(seed, tmp_path):
    """Their zeros have no constants beside them, and residuals far above those of constants."""
    random = np.random.default_rng(seed)
    n = random.integers(5, 30)
    w = 10.0 ** random.uniform(-20, 20, n) * (1 + random.random(n))
    chain = csr_array(diags_array([w], offsets=[1], shape=(n + 1, n + 1)))
    pair = bt.laplacian(csr_array(chain + chain.T), mass="unit")
    for k in (2, 4):
        basis = bt.fourier_basis(pair, k, hold=random.integers(0, n + 1, 2))
        basis.save(tmp_path / "basis.npz")
        assert bt.load_basis(tmp_path / "basis.npz", pair).k == k


def test_negative_eigenvalues_of_weights_of_yours_stay():
    W = csr_array(np.array([[0, -1.0, 2], [-1, 0, 0], [2, 0, 0]]))
    pair = bt.laplacian(W, mass="unit")
    expected = np.linalg.eigvalsh(pair.stiffness.toarray())
    found = bt.fourier_basis(pair, 3).eigenvalues
    assert expected[0] < -0.5
    assert np.allclose(found, expected)


def test_the_same_bits_again_and_another_seed():
    pair = bt.laplacian(blob())
    first, second = (bt.fourier_basis(pair, 15, seed=5) for _ in range(2))
    other = bt.fourier_basis(pair, 15, seed=6)
    assert (first.eigenvalues == second.eigenvalues).all()
    assert (first.eigenvectors == second.eigenvectors).all()
    assert (first.eigenvectors != other.eigenvectors).any()
    assert abs(first.eigenvectors - other.eigenvectors).max() < 1e-5  # no multiplicities here


def test_the_sign_rule():
    U = bt.fourier_basis(bt.laplacian(blob()), 25).eigenvectors
    near = abs(U) >= (1 - 1e-6) * abs(U).max(axis=0)
    assert (U[near.argmax(axis=0), np.arange(25)] > 0).all()


def test_what_is_told():
    pair = bt.laplacian(blob())
    done = bt.fourier_basis(pair, 10, certify=True).computation
    assert done.shift < 0
    assert 10 < done.basis < 200
    assert done.solves > 10
    assert done.history[-1] <= 1e-6 < done.history[0]
    stages = [name for name, _ in done.seconds]
    assert stages == ["prepare", "factorize", "search", "polish", "certify", "finish"]
    assert all(seconds >= 0 for _, seconds in done.seconds)
    assert bt.fourier_basis(pair, 10).computation.counted_within == 0
    assert bt.fourier_basis(pair, 1).computation.method == "kernel"
    assert bt.fourier_basis(pair, pair.n, certify=True).computation.counted_within == np.inf


def test_one_vertex():
    pair = bt.laplacian(csr_array((1, 1)), mass="unit")
    basis = bt.fourier_basis(pair, 1)
    assert basis.eigenvalues.tolist() == [0]
    assert basis.eigenvectors.tolist() == [[1]]


@pytest.mark.parametrize(
    "wrong",
    [
        {"k": 0},
        {"k": 9000},
        {"k": 2.5},
        {"k": 3, "near": np.inf},
        {"k": 3, "tol": 0},
        {"k": 3, "tol": np.nan},
        {"k": 3, "hold": [-1]},
        {"k": 612, "hold": [1, 2, 3]},
        {"k": 1, "hold": np.arange(614)},
    ],
)
def test_bad_numbers_are_refused(wrong):
    with pytest.raises(BeltramiError) as caught:
        bt.fourier_basis(bt.laplacian(blob()), **wrong)
    assert "\n" not in str(caught.value)


def test_vertices_without_mass_are_named():
    n = 600
    chain = csr_array(diags_array([np.ones(n - 1)], offsets=[1], shape=(n, n)))
    pair = bt.laplacian(csr_array(chain + chain.T), mass="unit")
    mass = pair.mass.copy()
    mass.data[[3, 77]] = 0
    hollow = bt.Laplacian(pair.stiffness, mass, pair.edges, pair.edge_weight, "given", "unit")
    with pytest.raises(MeshError) as caught:
        bt.fourier_basis(hollow, 5)
    assert caught.value.vertices.tolist() == [3, 77]
    held = bt.fourier_basis(hollow, 5, hold=[3, 77])
    assert (held.eigenvectors[[3, 77]] == 0).all()
