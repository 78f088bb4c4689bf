import numpy as np
import pytest

from beltrami.errors import DimensionError, NonFiniteError, SingularMatrixError
from beltrami.operators.laplacian import laplacian
from beltrami.operators.pair import MASSES
from beltrami.operators.projection import project
from meshes_of_the_errata import MESHES

pytestmark = pytest.mark.chapter("D6", "P14")


@pytest.mark.parametrize("mass", MASSES)
@pytest.mark.parametrize("name", ["closed", "bad"])
def test_against_least_squares(name, mass):
    pair = laplacian(MESHES[name](), mass=mass)
    rng = np.random.default_rng(2)
    f, basis = rng.normal(size=(pair.n, 2)), rng.normal(size=(pair.n, 5))
    root = np.linalg.cholesky(pair.mass.toarray()).T
    expected = basis @ np.linalg.lstsq(root @ basis, root @ f, rcond=None)[0]
    nearest = project(pair, f, basis)
    assert np.allclose(nearest, expected, atol=1e-12)
    left = f - nearest
    assert np.abs(basis.T @ (pair.mass @ left)).max() < 1e-12 * pair.norm(f) * pair.norm(basis)
    assert pair.norm(f) ** 2 == pytest.approx(pair.norm(nearest) ** 2 + pair.norm(left) ** 2)
    assert np.allclose(project(pair, nearest, basis), nearest, atol=1e-12)
    assert np.allclose(project(pair, f[:, 0], basis), nearest[:, 0], atol=1e-13)
    if mass not in ("unit",):  # the other inner product has another nearest function (E12)
        plain = basis @ np.linalg.lstsq(basis, f, rcond=None)[0]
        assert np.abs(plain - nearest).max() > 1e-3


def test_onto_constants_it_is_the_mean():
    pair = laplacian(MESHES["obt"]())
    f = np.random.default_rng(3).normal(size=(pair.n, 2))
    assert np.allclose(project(pair, f, np.ones(pair.n)), pair.mean(f), atol=1e-14)


def test_badly_scaled_and_nearly_dependent_functions():
    pair = laplacian(MESHES["open"]())
    x = MESHES["open"]().vertices[:, 0]
    f = np.sin(3 * x)
    powers = np.stack([1e200 * x**0, 1e-200 * x, x**2, x**2 + 1e-4 * x**3], axis=1)
    left = f - project(pair, f, powers)
    for p in range(4):
        assert abs(pair.inner(left, x**p)) < 1e-11


def test_what_is_refused():
    pair = laplacian(MESHES["open"]())
    n = pair.n
    one, f = np.ones(n), np.arange(n) / n
    for basis in (np.stack([one, f, one + f], axis=1), np.stack([one, 0 * one], axis=1)):
        with pytest.raises(SingularMatrixError):
            project(pair, f, basis)
    for basis in (np.ones((n + 1, 2)), np.zeros((n, 0)), np.ones((n, 2, 2))):
        with pytest.raises(DimensionError):
            project(pair, f, basis)
    with pytest.raises(DimensionError):
        project(pair, f[1:], one)
    with pytest.raises(NonFiniteError, match="basis"):
        project(pair, f, one * np.nan)
