"""The parts of the eigensolver, each against a few lines of numpy."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg
from scipy.sparse import csr_array

import beltrami as bt
from beltrami.errors import ConvergenceError
from beltrami.solvers import completing, finding, nearest_pairs
from beltrami.solvers.columns import Columns
from beltrami.solvers.davidson import enriched
from beltrami.solvers.eigenpairs import eigenpairs
from beltrami.solvers.inertia import census, count_below
from beltrami.solvers.inverse import definite_inverse, signed_inverse
from beltrami.solvers.lanczos import Lanczos
from beltrami.solvers.orthonormal import new_block, orthonormalize
from beltrami.solvers.pencil import make_pencil
from beltrami.solvers.polish import polish
from beltrami.solvers.rayleigh import projected, rotate, rotation
from beltrami.solvers.residuals import residuals
from beltrami.solvers.sign_rule import fix_signs
from beltrami.solvers.skinny import add_products, add_transposed_products, padded
from made_once import MadeOnce, creature

PAIRS = MadeOnce({
    "diagonal": lambda: bt.laplacian(creature(620)),
    "consistent": lambda: bt.laplacian(creature(620), mass="consistent"),
})  # fmt: skip


def pencil(pair=None, k=12):
    pair = pair or PAIRS["diagonal"]
    return make_pencil(pair.stiffness, pair.mass, k, pair.domain.vertices)


def spectrum(given):
    return scipy.linalg.eigh(given.stiffness.toarray(), given.mass.toarray())


@pytest.mark.parametrize("kind", PAIRS)
def test_the_pencil_is_the_pair_scaled_and_permuted(kind):
    pair = PAIRS[kind]
    made = pencil(pair)
    order = made.elimination.order
    root = np.sqrt(pair.mass.diagonal())
    assert np.allclose(made.root, root[order])
    L = (pair.stiffness.toarray() / root / root[:, None] / made.unit)[order][:, order]
    B = (pair.mass.toarray() / root / root[:, None])[order][:, order]
    assert np.allclose(made.stiffness.toarray(), L, rtol=1e-14)
    assert np.allclose(made.mass.toarray(), B, rtol=1e-14)
    assert made.plain == (kind == "diagonal")
    assert abs(made.stiffness @ made.kernel).max() < 1e-12
    assert np.allclose(made.kernel.T @ made.mass @ made.kernel, 1)
    values, X = spectrum(made)
    assert 0.2 < values[12] < 5  # the guess of Weyl's law
    assert values[-1] <= made.bound
    phi = made.physical(made.kernel, X, np.array([0, 3]))
    assert phi[order[7], 1] == pytest.approx(X[7, 2] / made.root[7], rel=1e-14)
    assert phi[order[7], 0] == pytest.approx(made.kernel[7, 0] / made.root[7], rel=1e-14)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_inverses(dtype):
    made = pencil(PAIRS["consistent"])
    b = np.random.default_rng(3).standard_normal((made.n, 5)).astype(dtype)
    A = (made.stiffness + 0.3 * made.mass).toarray()
    inverse = definite_inverse(made, -0.3, dtype)
    assert inverse.dtype == dtype
    assert inverse.definite
    assert np.allclose(
        inverse(b), np.linalg.solve(A, b), atol=1e-4 if dtype == np.float32 else 1e-11
    )
    assert definite_inverse(made, 0.5, dtype) is None
    assert definite_inverse(made, -1e-5, np.float32).dtype == np.float64  # it would drown
    values = spectrum(made)[0]
    inside = signed_inverse(made, values[5], 0.01)  # an eigenvalue: it steps aside
    assert inside.shift != values[5]
    assert not inside.definite
    A = (made.stiffness - inside.shift * made.mass).toarray()
    assert np.allclose(inside(b), np.linalg.solve(A, b), atol=1e-7)


def test_columns_across_panels():
    rng = np.random.default_rng(5)
    Q = rng.standard_normal((300, 330))
    columns = Columns(300, np.float64)
    for start in range(0, 330, 30):
        columns.append(Q[:, start : start + 30])
    Z, S = rng.standard_normal((300, 7)), rng.standard_normal((330, 11))
    assert np.allclose(columns.transposed_times(Z, 0, 330), Q.T @ Z)
    assert np.allclose(columns.transposed_times(Z, 100, 290), Q[:, 100:290].T @ Z)
    W = Z.copy()
    columns.subtract(W, S[:200, :7], 100)
    assert np.allclose(W, Z - Q[:, 100:300] @ S[:200, :7])
    assert np.allclose(columns.times(S, np.float64), Q @ S)
    columns.replace_last(Q[:, :30])
    assert np.allclose(columns.transposed_times(Z, 290, 330)[10:], Q[:, :30].T @ Z)
    columns.replace_last(Q[:, 300:])
    columns.contract(S)
    assert columns.count == 11
    assert np.allclose(columns.transposed_times(Z, 0, 11), (Q @ S).T @ Z)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("kind", PAIRS)
def test_blocks_are_orthonormal_whatever_is_left_of_them(kind, dtype):
    pair = PAIRS[kind]
    made, rng = pencil(pair), np.random.default_rng(11)
    rounding = np.finfo(dtype).eps
    known = Columns(made.n, dtype)
    basis = orthonormalize(made, rng.standard_normal((made.n, 6)).astype(dtype))
    known.append(orthonormalize(made, basis))
    healthy = rng.standard_normal((made.n, 5)).astype(dtype)
    twice = healthy.copy()
    twice[:, 3] = twice[:, 0]
    for W in (healthy, twice, np.zeros_like(healthy)):
        before = W.astype(np.float64)
        for _ in range(2):
            known.subtract(W, known.transposed_times(made.weighed(W), 0, 6))
            before = W.astype(np.float64)
        Q, R = new_block(made, W, 25.0, known, rng)
        gram = Q.T @ made.weighed(Q)
        assert abs(gram - np.eye(5)).max() < 100 * rounding
        assert abs(known.transposed_times(made.weighed(Q), 0, 6)).max() < 100 * rounding
        assert abs(Q @ R - before).max() < 1e4 * rounding


def test_residuals_against_numpy():
    for pair in PAIRS.values():
        made, rng = pencil(pair), np.random.default_rng(13)
        X, values = rng.standard_normal((made.n, 9)), rng.uniform(0.1, 2, 4)
        found = residuals(made, X, slice(3, 7), values, np.float64)
        R = made.stiffness @ X[:, 3:7] - made.mass @ X[:, 3:7] * values
        assert np.allclose(found.vectors, R, atol=1e-12)
        d = made.root[:, None]
        norms = np.linalg.norm(d * R, axis=0) / np.linalg.norm(
            d * (made.mass @ X[:, 3:7]) * values, axis=0
        )
        assert np.allclose(found.norms, norms)
        assert (found.rounding < 1e-12).all()


@pytest.mark.parametrize("fresh", [True, False])
def test_rayleigh_ritz_in_the_form_of_a_correction(fresh):
    """Against the projection of L on Z itself, in float64."""
    for pair in PAIRS.values():
        made, rng = pencil(pair), np.random.default_rng(17)
        exact, vectors = spectrum(made)
        L, B = made.stiffness.toarray(), made.mass.toarray()
        X = vectors[:, 1:9] + 1e-4 * rng.standard_normal((made.n, 8))
        X = np.ascontiguousarray(X @ np.linalg.inv(np.linalg.cholesky(X.T @ B @ X)).T)
        values = np.diag(X.T @ L @ X).copy()
        shift = -0.1
        E = np.linalg.solve(L - shift * B, L @ X - B @ X * values)
        Z = X - E
        small, change = projected(made, X, E, np.arange(8), values - shift, fresh)
        assert np.allclose(small.gram, Z.T @ B @ Z, atol=1e-12)
        assert np.allclose(small.operator, Z.T @ (L - shift * B) @ Z, atol=1e-12)
        assert change == pytest.approx(abs(X.T @ B @ E).max())
        distances, S = rotation(small, gentle=False)
        rotate(X, E, np.arange(8), S, fresh)
        assert np.allclose(X, Z @ S, atol=1e-12)
        assert np.allclose(shift + distances, exact[1:9], rtol=1e-6)
        assert abs(X.T @ B @ X - np.eye(8)).max() < 1e-12


def test_davidson_separates_what_is_beyond_the_last():
    for pair in PAIRS.values():
        made = pencil(pair)
        exact, vectors = spectrum(made)
        mixed = np.ascontiguousarray(vectors[:, 1:6])
        mixed[:, 4] = 0.8 * vectors[:, 5] + 0.6 * vectors[:, 6]
        rayleigh = exact[1:6].copy()
        rayleigh[4] = 0.64 * exact[5] + 0.36 * exact[6]
        E = (0.6 * vectors[:, 5] - 0.3 * vectors[:, 6])[:, None].astype(np.float32)
        X, values = enriched(made, mixed, rayleigh, E, -0.1)
        assert np.allclose(values, exact[1:6], rtol=1e-6)
        assert abs(X.T @ made.weighed(X) - np.eye(5)).max() < 1e-10


def test_signs():
    X = np.array([[0.5, -1.0, 0.0], [-2.0, 1.0, 0.0], [1.9, 0.3, 0.0]])
    fix_signs(X)
    assert X.tolist() == [[-0.5, 1.0, 0.0], [2.0, -1.0, 0.0], [-1.9, -0.3, 0.0]]


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("kind", PAIRS)
def test_lanczos_with_restarts(kind, dtype):
    pair = PAIRS[kind]
    made = pencil(pair)
    exact = spectrum(made)[0]
    inverse = definite_inverse(made, -0.1, dtype)
    start = np.random.default_rng(23).standard_normal((made.n, 4))
    process = Lanczos(made, inverse, start, made.kernel, seed=1)
    restarts = 0
    while True:
        process.extend()
        if process.size < 28:
            continue
        ritz = process.ritz(16)
        if ritz.errors[:12].max() < 1e-6:
            break
        process.restart(ritz)
        restarts += 1
        assert restarts < 30
    assert restarts >= 2
    assert np.allclose(-0.1 + 1 / ritz.values[:12], exact[1:13], rtol=1e-5)
    X = process.vectors(ritz)[:, :12]
    close = 1e-4 if dtype == np.float32 else 1e-12
    assert abs(X.T @ made.weighed(X) - np.eye(12)).max() < close
    assert abs(made.kernel.T @ made.weighed(X)).max() < close


def test_the_search_restarts_where_memory_is_short(monkeypatch):
    """Thick restart: a basis of at most 40 columns, for 12 eigenpairs."""
    kept = []
    original = Lanczos.restart

    def restart(process, ritz):
        kept.append(process.size)
        original(process, ritz)

    monkeypatch.setattr(Lanczos, "restart", restart)
    monkeypatch.setattr(nearest_pairs, "_most_columns", lambda k, b: 40)
    L, B = PAIRS["diagonal"].stiffness, PAIRS["diagonal"].mass
    found = eigenpairs(L, B, 13, coordinates=PAIRS["diagonal"].domain.vertices)
    assert kept
    assert max(kept) <= 40
    assert found.computation.basis <= 40
    exact = scipy.linalg.eigh(L.toarray(), B.toarray(), eigvals_only=True)[:13]
    assert np.allclose(found.values, exact, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("near", [0.0, 30.0])
def test_the_census_notices_one_that_is_missing_and_one_too_many(near):
    made = pencil()
    values = spectrum(made)[0]
    values[0] = 0
    near /= made.unit
    nearest = np.argsort(abs(values - near), kind="stable")[:20]
    doubts = np.full(20, 1e-9)
    for k in (5, 13):
        count = census(made, values[nearest], doubts, near, k, near == 0)
        assert count.there == count.found == k
        one_less = np.delete(nearest, 3)
        count = census(made, values[one_less], doubts[1:], near, k, near == 0)
        assert count.there == count.found + 1
        twice = np.insert(nearest, 3, nearest[3])
        count = census(made, values[twice], np.full(21, 1e-9), near, k, near == 0)
        assert count.there == count.found - 1
    assert count_below(made, 0.5 * (values[40] + values[41])) == 41


def test_pairs_that_the_search_missed_are_found_by_the_census(monkeypatch):
    """Lanczos loses two pairs; certify=True brings them back, and without a way to it fails."""
    L, B = PAIRS["diagonal"].stiffness, PAIRS["diagonal"].mass
    right = eigenpairs(L, B, 12, coordinates=PAIRS["diagonal"].domain.vertices)
    original = finding.polish

    def forgetful(*given):
        found = original(*given)
        kept = np.delete(np.arange(len(found.values)), [2, 5])
        return found._replace(
            vectors=np.ascontiguousarray(found.vectors[:, kept]),
            values=found.values[kept],
            residuals=found.residuals[kept],
        )

    monkeypatch.setattr(finding, "polish", forgetful)
    wrong = eigenpairs(L, B, 12, coordinates=PAIRS["diagonal"].domain.vertices)
    assert abs(wrong.values - right.values).max() > 1
    mended = eigenpairs(L, B, 12, coordinates=PAIRS["diagonal"].domain.vertices, certify=True)
    assert np.allclose(mended.values, right.values, rtol=1e-9)
    assert abs(mended.vectors - right.vectors).max() < 1e-5
    assert mended.computation.counted_within > right.values[10]
    monkeypatch.setattr(completing, "_SEARCHES", 0)
    with pytest.raises(ConvergenceError, match="were found"):
        eigenpairs(L, B, 12, coordinates=PAIRS["diagonal"].domain.vertices, certify=True)


def test_what_cannot_be_polished_is_refused():
    made = pencil()
    inverse = definite_inverse(made, -0.1, np.float64)
    broken = replace(inverse, scale=inverse.scale * 0)  # it corrects nothing
    X = np.random.default_rng(29).standard_normal((made.n, 4))
    X = np.linalg.qr(X)[0]
    with pytest.raises(ConvergenceError):
        polish(made, broken, X, np.full(4, 0.5), made.kernel, 4, 1e-6)


def test_a_known_kernel_of_many_components_is_not_larger_than_needed():
    islands = csr_array(np.kron(np.eye(400), [[0.0, 1.0], [1.0, 0.0]]))
    for certify in (False, True):
        basis = bt.fourier_basis(bt.laplacian(islands), 3, certify=certify)
    assert basis.eigenvalues.tolist() == [0, 0, 0]
    assert basis.computation.method == "kernel"
    pairs = [np.flatnonzero(column).tolist() for column in basis.eigenvectors.T]
    assert pairs == [[0, 1], [2, 3], [4, 5]]


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("c", [4, 8, 16, 24, 48])
def test_tall_products(dtype, c):
    """Panels of several widths, cut at both ends; rows that fill no tile; sums in parts."""
    rng = np.random.default_rng(c)
    n, widths = 1003, [1, 8, 37, 16]
    panels = [rng.standard_normal((n, width)).astype(dtype) for width in widths]
    where = np.array([panel.ctypes.data for panel in panels[1:]])
    P = np.hstack(panels[1:]).astype(np.float64)[:, 3:50]
    Z = rng.standard_normal((n, c)).astype(dtype)
    C = np.ones((47, c), dtype)
    add_transposed_products(where, np.array(widths[1:]), 3, 300, Z, C, np.empty_like(C))
    close = 300 * np.finfo(dtype).eps
    assert np.allclose(C, 1 + P.T @ Z.astype(np.float64), rtol=0, atol=100 * close)
    D = rng.standard_normal((47, c)).astype(dtype)
    W = Z.copy()
    add_products(W, where, np.array(widths[1:]), 3, D)
    assert np.allclose(W, Z + P @ D.astype(np.float64), rtol=0, atol=close)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("c", [1, 3, 8])
def test_rows_are_padded_to_whole_vectors(dtype, c):
    Z = np.ones((5, c), dtype)
    wide = padded(Z)
    assert wide.shape[1] * wide.itemsize % 16 == 0
    assert (wide[:, :c] == 1).all()
    assert (wide[:, c:] == 0).all()
    assert (wide is Z) == (wide.shape == Z.shape)


def test_the_residual_of_an_eigenvalue_without_digits_is_a_number():
    """Rounding may leave 0 of it; beside 0 every residual would be infinite."""
    pair = bt.laplacian(bt.shapes.icosphere(1), mass="unit")
    pencil = make_pencil(1e9 * pair.stiffness, pair.mass, 3, None)
    X = np.random.default_rng(0).normal(size=(pair.n, 3))
    with np.errstate(all="raise"):
        found = residuals(pencil, X, slice(0, 3), np.array([0.0, -1e-300, 1.0]), np.float64)
    assert (found.norms[:2] > 1e20).all()
    assert np.isfinite(found.norms).all()
    assert (found.norms[:2] > found.rounding[:2]).all()  # these are no eigenvectors
    far = residuals(pencil, 1e9 * X, slice(0, 3), np.array([0.0, -1e-300, 1.0]), np.float64)
    assert np.allclose(far.norms, found.norms)
