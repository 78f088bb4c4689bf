"""Definition 20, theorems 17 and 18: the quadratic regulariser, its spectrum and limit (E76, E77).

The text prints one formula; the library has the three problems that it mixes, under their names.
"""

import math

import numpy as np
import pytest

import dense_oracles as oracle
from beltrami.diffusion.regularize import regularize
from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.fourier_basis import fourier_basis
from meshes_of_the_errata import IRREGULAR, MESHES

T = 2.0
KINDS = ("combinatorial", "cotangent")
cases = pytest.mark.parametrize(
    ("name", "kind"), [(name, kind) for name in IRREGULAR for kind in KINDS]
)


def matrices(pair):
    """L̃, its eigenvalues and eigenvectors, and the transform of definition 19."""
    d = pair.stiffness.toarray().diagonal()
    L_tilde = pair.stiffness.toarray() / np.sqrt(np.outer(d, d))
    values, U = np.linalg.eigh(L_tilde)
    return L_tilde, values, U, U.T * np.sqrt(d), d


@pytest.mark.chapter("D20", "T17")
@cases
def test_definition_20_is_minimised_by_theorem_17(name, kind):
    """As printed: ||f - g||² + t ||G̃ g||², and (Id + t L̃)⁻¹ f; the other forms are not it."""
    pair = laplacian(MESHES[name](), kind, "degree")
    L_tilde, _, _, _, d = matrices(pair)
    f, *changes = oracle.rough_functions(MESHES[name](), 5).T
    W = oracle.weights(MESHES[name](), kind)

    def objective(g):
        h = g / np.sqrt(d)
        return ((f - g) ** 2).sum() + T * (W * (h[:, None] - h) ** 2).sum() / 2

    def check(g):
        for change in changes:
            for size in (-1e-2, 1e-2):
                assert objective(g + size * change) > objective(g)
        assert np.allclose(g, np.linalg.solve(np.eye(pair.n) + T * L_tilde, f), atol=1e-9)

    check(regularize(pair, f, T, "normalized"))
    for wrong in ("identity", "mass"):
        with pytest.raises(AssertionError):
            check(regularize(pair, f, T, wrong))


@pytest.mark.chapter("U34", "T17")
@cases
def test_frequencies_are_attenuated_in_the_right_coefficients(name, kind):
    """1 / (1 + tλ): in U'f for the printed problem, in U'D½f for that of the degree mass (E76)."""
    pair = laplacian(MESHES[name](), kind, "degree")
    _, values, U, transform, _ = matrices(pair)
    f = oracle.rough_functions(MESHES[name]())

    def check(form, coefficients, factor=1 / (1 + T * values)):
        found = coefficients @ regularize(pair, f, T, form)
        assert np.allclose(found, factor[:, None] * (coefficients @ f), atol=1e-9)

    check("normalized", U.T)
    check("mass", transform)
    wrong = [("normalized", transform), ("mass", U.T), ("identity", U.T), ("identity", transform)]
    for form, coefficients in wrong:
        with pytest.raises(AssertionError):
            check(form, coefficients)
    for factor in (np.exp(-T * values), 1 / (1 + 2 * T * values), 1 - T * values):
        with pytest.raises(AssertionError):
            check("normalized", U.T, factor)


@pytest.mark.chapter("U34")
@pytest.mark.parametrize("mass", ["degree", "voronoi", "consistent", "unit"])
@pytest.mark.parametrize("name", IRREGULAR)
def test_the_transform_of_the_pair_makes_the_mass_form_diagonal(name, mass):
    pair = laplacian(MESHES[name](), mass=mass)
    basis = fourier_basis(pair, pair.n)
    f = oracle.rough_functions(MESHES[name]())
    t = 10 / basis.eigenvalues[-1]
    after = basis.forward(regularize(pair, f, t))
    factor = 1 / (1 + t * basis.eigenvalues)
    assert np.allclose(after, factor[:, None] * basis.forward(f), atol=1e-9)
    plain = basis.eigenvectors.T @ f
    if mass != "unit":
        found = basis.eigenvectors.T @ regularize(pair, f, t)
        assert not np.allclose(found, factor[:, None] * plain, atol=1e-4)


def limits(pair, f):
    d = pair.degrees
    return {
        "normalized": np.sqrt(d) * (np.sqrt(d) @ f) / d.sum(),
        "identity": np.full(pair.n, f.mean()),
        "mass": np.full(pair.n, d @ f / d.sum()),
    }


@pytest.mark.chapter("T18")
@cases
def test_each_form_has_its_own_limit(name, kind):
    """The printed plain mean is that of Id + tL alone."""
    pair = laplacian(MESHES[name](), kind, "degree")
    f = MESHES[name]().vertices[:, 0] + oracle.rough_functions(MESHES[name](), 1)[:, 0]

    def check(form, expected):
        for t, error in ((1e7, 1e-3), (math.inf, 1e-9)):
            assert np.abs(regularize(pair, f, t, form) - expected).max() < error * np.ptp(f)

    expected = limits(pair, f)
    for form in expected:
        check(form, expected[form])
        for wrong in set(expected) - {form}:
            with pytest.raises(AssertionError):
                check(form, expected[wrong])


@pytest.mark.chapter("T18")
@cases
def test_the_printed_problem_does_not_keep_constants(name, kind):
    pair = laplacian(MESHES[name](), kind, "degree")
    one = np.ones(pair.n)
    for form in ("mass", "identity"):
        for t in (1.0, 1000.0, math.inf):
            assert np.allclose(regularize(pair, one, t, form), 1, atol=1e-9)
    far = regularize(pair, one, 1000.0, "normalized")
    assert far.min() < 0.9
    assert far.max() > 1.1


@pytest.mark.chapter("T18")
def test_numbers_of_the_errata():
    """E77: ``closed`` with combinatorial weights; only ranges are printed there."""
    pair = laplacian(MESHES["closed"](), "combinatorial")
    far = regularize(pair, np.ones(pair.n), 1000.0, "normalized")
    d = pair.degrees
    assert far == pytest.approx(np.sqrt(d) * np.sqrt(d).sum() / d.sum(), abs=2e-3)


@pytest.mark.chapter("T18")
def test_a_regular_mesh_cannot_tell_them_apart():
    pair = laplacian(MESHES["tor"](), "combinatorial", "degree")
    f = oracle.rough_functions(MESHES["tor"](), 1)[:, 0]
    found = [regularize(pair, f, math.inf, form) for form in ("mass", "identity", "normalized")]
    assert np.allclose(found, f.mean(), atol=1e-12)
