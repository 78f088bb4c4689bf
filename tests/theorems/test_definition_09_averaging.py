"""Definition 9: the normalised averaging D⁻¹ W (E14, E16)."""

import numpy as np
import pytest

import dense_oracles as oracle
from beltrami.errors import NegativeWeightError
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import IRREGULAR, MESHES, triangle

pytestmark = pytest.mark.chapter("D9")

POSITIVE = [(name, kind) for name in IRREGULAR for kind in ("combinatorial", "distance")]


@pytest.mark.chapter("P18")
@pytest.mark.parametrize(("name", "kind"), [*POSITIVE, ("closed", "cotangent")])
def test_rows_are_averages(name, kind):
    mesh = MESHES[name]()
    pair = laplacian(mesh, kind)
    A, W = pair.averaging.toarray(), oracle.weights(mesh, kind)
    assert np.allclose(A, W / W.sum(axis=1)[:, None], rtol=1e-10, atol=1e-14)
    ones = np.ones(pair.n)
    assert np.allclose(A @ ones, 1, atol=1e-14)
    assert np.abs(W @ ones - 1).max() > 1  # printed: an eigenvector of W (E16)
    literal = W / W.sum()  # printed: divided by the sum over all of E (E14)
    assert (literal.sum(axis=1) < 0.1).all()
    assert (A >= 0).all()
    f = oracle.rough_functions(mesh)
    assert ((A @ f).max(axis=0) <= f.max(axis=0)).all()
    assert ((A @ f).min(axis=0) >= f.min(axis=0)).all()


def test_it_does_not_depend_on_the_mass():
    mesh = MESHES["bad"]()
    A = laplacian(mesh, "distance", "degree").averaging
    for mass in ("voronoi", "consistent", "unit"):
        assert abs(laplacian(mesh, "distance", mass).averaging - A).max() < 1e-15


def test_the_smallest_mesh_where_it_has_no_meaning():
    """S3 of the errata: angles 15, 150, 15."""
    pair = laplacian(triangle(15, 150))
    W = 2 * pair.weights.toarray()  # the constant of the text
    text = [[0, 3.7321, -1.7321], [3.7321, 0, 3.7321], [-1.7321, 3.7321, 0]]
    assert np.allclose(W, text, atol=1e-4)
    with pytest.raises(NegativeWeightError) as caught:
        _ = pair.averaging
    assert caught.value.edges.tolist() == [[0, 2]]
    A = W / W.sum(axis=1)[:, None]
    assert np.abs(np.linalg.matrix_power(A, 50)).max() > 1e12  # what the refusal prevents
