"""One contract for every library: odd shapes, units, signs, and matrices that are to be refused."""

import sys

import numpy as np
import pytest
from scipy.sparse import coo_array, csc_array, csr_array, diags_array

from backends import DEFINITE, EVERY, PACKAGES, SYMMETRIC, backend
from beltrami.errors import (
    BeltramiError,
    DimensionError,
    MissingExtraError,
    NotPositiveDefiniteError,
    SingularMatrixError,
)
from beltrami.operators.laplacian import laplacian
from beltrami.solvers.factorize import factorize
from definite_matrices import NAMED, grid, mesh_pair, path
from meshes_of_the_errata import MESHES

OPTIONAL = [backend(name) for name in PACKAGES]
TELL_INERTIA = ("cholesky", "cholespy", "cholmod", "ldl", "pardiso")


def _read_only(A):
    for array in (A.data, A.indices, A.indptr):
        array.flags.writeable = False
    return A


def _indefinite(seed=577215):
    """Symmetric with a large diagonal of both signs, so that no exchange is needed."""
    rng = np.random.default_rng(seed)
    signs = rng.choice([-1.0, 1.0], 60)
    return csr_array(path(60) * 0.1 + diags_array(signs * rng.uniform(1, 3, 60)))


@pytest.mark.parametrize("name", EVERY)
def test_one_unknown_and_no_right_hand_side(name):
    factor = factorize(csr_array([[4.0]]), backend=name)
    assert factor.solve([2.0]).tolist() == [0.5]
    assert factor.solve([[2.0, 4.0]]).tolist() == [[0.5, 1.0]]
    assert factor.solve(np.zeros((1, 0))).shape == (1, 0)
    assert factorize(path(30), backend=name).solve(np.zeros((30, 0))).shape == (30, 0)
    assert name in repr(factor)


@pytest.mark.parametrize("name", EVERY)
@pytest.mark.parametrize("make", [csr_array, csc_array])
def test_what_is_given_may_be_read_only_and_in_any_layout(name, make):
    A = _read_only(make(path(40)))
    factor = factorize(A, backend=name)
    b = np.random.default_rng(1123581321).normal(size=(40, 3))
    b.flags.writeable = False
    expected = np.linalg.solve(A.toarray(), b)
    for given in (b, np.asfortranarray(b), b[:, ::-1][:, ::-1], b.tolist()):
        assert np.allclose(factor.solve(given), expected, rtol=1e-12)
    assert np.allclose(factor.solve(b[:, 1]), expected[:, 1], rtol=1e-12)
    x = factor.solve(b)
    x[:] = 0  # it is the caller's
    assert np.allclose(factor.solve(b), expected, rtol=1e-12)


@pytest.mark.parametrize("name", EVERY)
def test_duplicates_zeros_and_integers(name):
    twice = csr_array(
        (np.array([1, 3, 1, 1, 0, 3, 2]), np.array([0, 0, 1, 0, 1, 1, 2]), np.array([0, 3, 6, 7])),
        shape=(3, 3),
    )  # [[4, 1, 0], [1, 3, 0], [0, 0, 2]]
    assert np.allclose(factorize(twice, backend=name).solve([5, 4, 2]), [1, 1, 1], rtol=1e-14)
    assert np.allclose(
        factorize(coo_array(twice), backend=name).solve([5, 4, 2]), [1, 1, 1], rtol=1e-14
    )


@pytest.mark.parametrize("name", EVERY)
@pytest.mark.parametrize("unit", [1e-150, 1e-18, 1e18, 1e150])
def test_units_change_nothing(name, unit):
    A, b = grid(7, 9), np.random.default_rng(662607).normal(size=63)
    x = factorize(A, backend=name).solve(b)
    scaled = factorize(csr_array(A * unit), backend=name)
    assert np.allclose(scaled.solve(b) * unit, x, rtol=1e-12)
    if name in ("cholesky", "ldl", "superlu", "cholmod"):
        expected = np.linalg.slogdet(A.toarray())[1] + 63 * np.log(unit)
        assert scaled.logdet == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("name", EVERY)
def test_ill_conditioned_matrices_are_solved_to_rounding(name):
    for A in (mesh_pair("closed", 1e-11), NAMED["units"](), grid(30, 2) + 1e9 * path(60)):
        factor = factorize(csr_array(A), backend=name)
        b = np.random.default_rng(137035).normal(size=A.shape[0])
        x = factor.solve(b)
        scale = abs(A).sum(axis=1).max() * abs(x).max() + abs(b).max()
        assert abs(A @ x - b).max() / scale < 1e-14


@pytest.mark.parametrize("name", EVERY)
def test_the_inertia_is_that_of_the_eigenvalues(name):
    for A in (grid(6, 7), _indefinite()):
        values = np.linalg.eigvalsh(A.toarray())
        if name in DEFINITE and values.min() < 0:
            continue
        factor = factorize(A, backend=name)
        if name in TELL_INERTIA:
            assert factor.inertia == (int((values > 0).sum()), int((values < 0).sum()))
        else:
            with pytest.raises(BeltramiError, match="do not tell the inertia"):
                _ = factor.inertia


@pytest.mark.parametrize("name", EVERY)
def test_indefinite_matrices_are_solved_or_refused(name):
    A, b = _indefinite(), np.random.default_rng(299792).normal(size=60)
    if name in DEFINITE:
        with pytest.raises(NotPositiveDefiniteError) as caught:
            factorize(A, backend=name)
        first = int(np.flatnonzero(A.diagonal() <= 0)[0])
        assert caught.value.rows.tolist() == [first]
        return
    factor = factorize(A, backend=name)
    assert np.allclose(factor.solve(b), np.linalg.solve(A.toarray(), b), rtol=1e-10)
    if name in ("ldl", "superlu"):
        assert factor.logdet == pytest.approx(np.linalg.slogdet(A.toarray())[1], rel=1e-12)


@pytest.mark.parametrize("name", EVERY)
def test_indefinite_matrices_that_do_not_look_it(name):
    """The diagonal is positive, and every 2 by 2 minor: only the pivots tell."""
    n = 40
    A = csr_array(path(n) * 1.0 - 0.2 * diags_array(np.ones(n)))
    assert np.linalg.eigvalsh(A.toarray()).min() < 0
    if name in DEFINITE:
        with pytest.raises(NotPositiveDefiniteError) as caught:
            factorize(A, backend=name)
        assert len(caught.value.rows) == (0 if name == "cholespy" else 1)
        assert "not symmetric positive definite" in str(caught.value)
    else:
        b = np.random.default_rng(1).normal(size=n)
        x = factorize(A, backend=name).solve(b)
        assert np.allclose(A @ x, b, rtol=1e-10)


@pytest.mark.parametrize("name", EVERY)
@pytest.mark.parametrize("order", ["as it comes", "shuffled"])
def test_saddle_points_are_solved_or_refused(name, order):
    rng = np.random.default_rng(141421)
    C = rng.normal(size=(10, 30))
    S = np.block([[np.diag(rng.uniform(0.1, 1, 30)), C.T], [C, np.zeros((10, 10))]])
    chosen = rng.permutation(40) if order == "shuffled" else np.arange(40)
    A = csr_array(S[np.ix_(chosen, chosen)])
    b = A @ rng.normal(size=40)
    if name in DEFINITE:
        with pytest.raises(NotPositiveDefiniteError):
            factorize(A, backend=name)
        return
    try:
        factor = factorize(A, backend=name)
    except SingularMatrixError:
        assert name == "ldl"  # which makes no exchanges
        return
    assert abs(A @ factor.solve(b) - b).max() < 1e-12 * abs(b).max()


@pytest.mark.parametrize("name", EVERY)
@pytest.mark.parametrize(
    "A",
    [
        np.zeros((2, 2)),
        np.ones((2, 2)),
        np.diag([1.0, 0, 2]),
        np.outer([1.0, 2, 3], [1.0, 2, 3]),
        path(6).toarray() - np.diag([1.0, 0, 0, 0, 0, 1]),  # a Laplacian
    ],
)
def test_singular_matrices_are_refused(name, A):
    with pytest.raises((SingularMatrixError, NotPositiveDefiniteError)) as caught:
        factorize(csr_array(A), backend=name)
    if name in ("cholesky", "ldl", "cholmod"):
        assert len(caught.value.rows)


@pytest.mark.parametrize("name", EVERY)
@pytest.mark.parametrize("shape", ["closed", "tor"])
def test_a_stiffness_alone_is_refused_in_every_unit(name, shape):
    stiffness = laplacian(MESHES[shape](), mass="degree").stiffness
    for unit in (1.0, 1e-12, 1e12):
        with pytest.raises((SingularMatrixError, NotPositiveDefiniteError)):
            factorize(csr_array(stiffness * unit), backend=name)


@pytest.mark.parametrize("name", EVERY)
def test_unsymmetric_matrices_are_solved_or_refused(name):
    A = csr_array(path(20) + diags_array([0.3 * np.ones(19)], offsets=[1]))
    b = np.arange(20.0)
    if name in SYMMETRIC:
        with pytest.raises(BeltramiError, match="symmetric"):
            factorize(A, backend=name)
    else:
        assert np.allclose(factorize(A, backend=name).solve(b), np.linalg.solve(A.toarray(), b))


@pytest.mark.parametrize("name", EVERY)
def test_what_is_no_matrix_to_factorise(name):
    with pytest.raises(DimensionError, match="real"):
        factorize(csr_array(np.eye(3) * 1j), backend=name)
    with pytest.raises(DimensionError):
        factorize(csr_array((2, 3)), backend=name)
    with pytest.raises(DimensionError):
        factorize(csr_array((0, 0)), backend=name)
    with pytest.raises(DimensionError):
        factorize(path(4), backend=name).solve(np.zeros(3))


@pytest.mark.parametrize("name", EVERY)
def test_float32_matrices_are_taken_as_they_are(name):
    A = grid(5, 6).astype(np.float32)
    b = np.ones(30, np.float32)
    x = factorize(A, backend=name).solve(b)
    assert x.dtype == np.float64
    assert np.allclose(A.astype(float) @ x, b, rtol=1e-12)
    if name != "cholesky":
        with pytest.raises(BeltramiError, match="float64 only"):
            factorize(A, backend=name, dtype=np.float32)


@pytest.mark.parametrize("name", OPTIONAL)
def test_where_the_signs_are_against_it_garbage_is_not_given_out(name, monkeypatch):
    """A library that claims to have solved: the trial does not believe it."""
    from beltrami.solvers import factorize as home

    class Wrong:
        inertia = fill = memory = None

        def solve(self, b):
            return b * 0.5

    monkeypatch.setitem(home.OTHERS, name, lambda matrix: Wrong())
    with pytest.raises(SingularMatrixError, match=f"{name} cannot do it"):
        factorize(path(10), backend=name)


@pytest.mark.parametrize("name", PACKAGES)
def test_a_library_that_is_not_installed_is_named(name, monkeypatch):
    package = {"cholmod": "sksparse.cholmod"}.get(name, PACKAGES[name])
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(MissingExtraError, match="pip install") as caught:
        factorize(path(10), backend=name)
    assert caught.value.package == package
    assert caught.value.extra == ("cholmod" if name == "cholmod" else "fast")


@pytest.mark.parametrize("name", [backend("pardiso")])
def test_threads_are_as_before(name):
    import pypardiso

    library = pypardiso.PyPardisoSolver().libmkl
    library.MKL_Set_Num_Threads_Local(3)
    try:
        factorize(grid(20, 20), backend=name).solve(np.ones(400))
        assert library.MKL_Set_Num_Threads_Local(0) == 3
    finally:
        library.MKL_Set_Num_Threads_Local(0)
