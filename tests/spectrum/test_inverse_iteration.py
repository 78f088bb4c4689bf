import pickle

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.sparse import csr_array

import beltrami as bt
from beltrami.errors import (
    BeltramiError,
    ConvergenceError,
    DimensionError,
    MeshError,
    NonFiniteError,
    UnknownNameError,
)
from beltrami.operators.pair import MASSES
from beltrami.solvers.shifted import SHIFTED_SOLVERS
from meshes_of_the_errata import IRREGULAR, MESHES


def _dense(pair, free=slice(None)):
    return eigh(pair.stiffness.toarray()[free][:, free], pair.mass.toarray()[free][:, free])


@pytest.mark.parametrize("name", IRREGULAR)
@pytest.mark.parametrize("mass", MASSES)
def test_all_masses_and_signs_of_weights(name, mass):
    pair = bt.laplacian(MESHES[name](), mass=mass)
    values, vectors = _dense(pair)
    for solver in ("lu", "ldl"):
        shift = 0.9 * values[2] + 0.1 * values[3]
        found = bt.inverse_iteration(pair, shift, solver=solver, max_iterations=2000)
        assert found.eigenvalue == pytest.approx(values[2], rel=1e-9)
        assert pair.norm(found.eigenvector) == pytest.approx(1, abs=1e-12)
        line = vectors[:, 2] * np.sign(pair.inner(vectors[:, 2], found.eigenvector))
        assert pair.norm(line - found.eigenvector) < 2e-9
        force = found.eigenvalue * (pair.mass @ found.eigenvector)
        residual = np.linalg.norm(pair.stiffness @ found.eigenvector - force)
        assert found.residual == pytest.approx(
            residual / np.linalg.norm(force) * found.eigenvalue / max(shift, found.eigenvalue),
            rel=1e-3,
        )


@pytest.mark.parametrize("tolerance", [1e-3, 1e-6, 1e-9])
def test_the_tolerance_is_kept_by_the_vector(tolerance):
    pair = bt.laplacian(MESHES["open"]())
    values, vectors = _dense(pair)
    for part in (0.1, 0.4, 0.48):
        shift = (1 - part) * values[9] + part * values[10]
        found = bt.inverse_iteration(pair, shift, tolerance=tolerance, max_iterations=5000)
        cosine = pair.inner(found.eigenvector, vectors[:, 9])
        off = pair.norm(found.eigenvector - cosine * vectors[:, 9])
        assert tolerance / 1000 < off < 1.2 * tolerance


@pytest.mark.parametrize("unit", [1e-40, 1e-9, 1e9, 1e40])
@pytest.mark.parametrize("solver", SHIFTED_SOLVERS)
def test_units_do_not_count(unit, solver):
    mesh = MESHES["cur"]()
    shift = 20.0
    one = bt.inverse_iteration(bt.laplacian(mesh), shift, solver=solver)
    other = bt.inverse_iteration(
        bt.laplacian(mesh.with_vertices(mesh.vertices * unit)), shift / unit**2, solver=solver
    )
    assert other.eigenvalue * unit**2 == pytest.approx(one.eigenvalue, rel=1e-9)
    assert np.allclose(other.eigenvector * unit, one.eigenvector, atol=1e-7)
    assert other.predicted_rate == pytest.approx(one.predicted_rate, rel=1e-3)
    assert other.residual < 1e-6


@pytest.mark.parametrize("solver", SHIFTED_SOLVERS)
def test_held_vertices_are_zero(solver):
    mesh = bt.shapes.grid(12, 12, diagonals="alternating")
    pair = bt.laplacian(mesh)
    rim = np.abs(mesh.vertices - 0.5).max(axis=1) > 0.5 - 1e-9
    values, _ = _dense(pair, ~rim)
    found = bt.inverse_iteration(pair, 0, solver=solver, hold=rim)  # 0 is no eigenvalue now
    assert found.eigenvalue == pytest.approx(values[0], rel=1e-10)
    assert found.eigenvalue == pytest.approx(2 * np.pi**2, rel=0.02)
    assert not found.eigenvector[rim].any()
    assert (found.eigenvector[~rim] > 0).all()
    assert pair.norm(found.eigenvector) == pytest.approx(1)
    by_index = bt.inverse_iteration(pair, 0, solver=solver, hold=np.flatnonzero(rim))
    assert np.array_equal(by_index.eigenvector, found.eigenvector)


def test_other_domains():
    grid = bt.Grid((8, 6), periodic=True)
    spectrum = np.unique(grid.eigenvalues("dirichlet").ravel().round(6))
    found = bt.inverse_iteration(bt.laplacian(grid, "dirichlet", "voronoi"), spectrum[3] + 0.1)
    assert found.eigenvalue == pytest.approx(spectrum[3], rel=1e-6)
    point = bt.laplacian(csr_array((1, 1)), mass="unit")
    alone = bt.inverse_iteration(point, -1)
    assert (alone.eigenvalue, alone.eigenvector.tolist()) == (0, [1.0])
    assert np.isnan(alone.predicted_rate)


def test_the_result_is_frozen_and_travels():
    pair = bt.laplacian(bt.shapes.icosphere(1))
    found = bt.inverse_iteration(pair, 1.8)
    for array in (found.eigenvector, found.quotients, found.changes, found.residuals):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0
    with pytest.raises(AttributeError):
        found.eigenvalue = 1
    again = pickle.loads(pickle.dumps(found))  # noqa: S301
    assert np.array_equal(again.eigenvector, found.eigenvector)
    assert len(found.quotients) == len(found.residuals) == found.iterations
    assert "iterations, lu" in repr(found)


def test_the_start_is_not_changed_and_its_length_does_not_count():
    pair = bt.laplacian(MESHES["open"]())
    start = np.random.default_rng(8).normal(size=pair.n)
    before = start.copy()
    one = bt.inverse_iteration(pair, 20, start)
    assert np.array_equal(start, before)
    for scale in (1e-200, 1e200, -1):
        other = bt.inverse_iteration(pair, 20, scale * start)
        assert np.allclose(other.eigenvector, one.eigenvector, atol=1e-9)


@pytest.mark.parametrize(
    ("keywords", "error"),
    [
        ({"shift": np.nan}, BeltramiError),
        ({"shift": np.inf}, BeltramiError),
        ({"shift": "1"}, BeltramiError),
        ({"shift": [1.0]}, BeltramiError),
        ({"shift": 1j}, BeltramiError),
        ({"tolerance": 0}, BeltramiError),
        ({"tolerance": 1}, BeltramiError),
        ({"tolerance": None}, BeltramiError),
        ({"max_iterations": 0}, BeltramiError),
        ({"max_iterations": 2.5}, BeltramiError),
        ({"max_inner_iterations": -1}, BeltramiError),
        ({"solver": "cg"}, UnknownNameError),
        ({"solver": 3}, UnknownNameError),
        ({"start": np.zeros(42)}, MeshError),
        ({"start": np.ones(41)}, DimensionError),
        ({"start": np.ones((42, 2))}, DimensionError),
        ({"start": np.full(42, np.nan)}, NonFiniteError),
        ({"hold": range(42)}, MeshError),
        ({"hold": [42]}, MeshError),
        ({"max_iterations": 2, "tolerance": 1e-12}, ConvergenceError),
        ({"solver": "minres", "max_inner_iterations": 2}, ConvergenceError),
    ],
)
def test_bad_input(keywords, error):
    pair = bt.laplacian(bt.shapes.icosphere(1))
    with pytest.raises(error) as caught:
        bt.inverse_iteration(pair, **{"shift": 1.7, **keywords})
    assert "\n" not in str(caught.value)


def test_ldl_that_needs_exchanges_is_refused_and_lu_does_it():
    path = csr_array(np.eye(3, k=1) + np.eye(3, k=-1))
    pair = bt.laplacian(path, mass="unit")  # L - Id has zeros at its two ends
    with pytest.raises(BeltramiError, match='solver="lu"'):
        bt.inverse_iteration(pair, 1, solver="ldl")
    with pytest.raises(BeltramiError, match="eigenvalue"):
        bt.inverse_iteration(pair, 1, solver="lu")  # 1 is an eigenvalue of the path
    four = bt.laplacian(csr_array(np.eye(4, k=1) + np.eye(4, k=-1)), mass="unit")
    with pytest.raises(BeltramiError, match='solver="lu"'):
        bt.inverse_iteration(four, 1, solver="ldl")
    assert bt.inverse_iteration(four, 1, solver="lu").eigenvalue == pytest.approx(2 - np.sqrt(2))


def test_a_vertex_without_edges():
    W = csr_array(np.diag([1.0, 0], 1) + np.diag([1.0, 0], -1))
    pair = bt.laplacian(W, mass="unit")  # eigenvalues 0, 0 and 2
    for solver in SHIFTED_SOLVERS:
        with pytest.raises(BeltramiError):
            bt.inverse_iteration(pair, 0, solver=solver)
        found = bt.inverse_iteration(pair, 0.3, [1, 1, 1], solver=solver)
        assert np.allclose(found.eigenvector, np.sqrt(1 / 3), atol=1e-9)
        assert np.isnan(found.predicted_rate)
