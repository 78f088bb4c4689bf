"""Definition 14: L = D - W, positive semi-definite (E15, E42, E44)."""

import numpy as np
import pytest
from scipy.sparse import csr_array

import dense_oracles as oracle
from beltrami.errors import MeshError
from beltrami.operators.laplacian import laplacian
from beltrami.operators.weights import WEIGHTS
from meshes_of_the_errata import IRREGULAR, MESHES

pytestmark = pytest.mark.chapter("D14")


@pytest.mark.chapter("R1")
@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("kind", WEIGHTS)
def test_symmetric_with_constants_in_its_kernel(name, kind):
    pair = laplacian(MESHES[name](), kind)
    L = pair.stiffness.toarray()
    assert np.array_equal(L, L.T)
    assert np.abs(L.sum(axis=1)).max() < 1e-12 * L.max()
    assert np.array_equal(L - np.diag(L.diagonal()), -pair.weights.toarray())
    assert np.abs(np.diag(pair.degrees).sum(axis=1)).max() > 1  # printed: "the Laplacian D" (E42)


@pytest.mark.chapter("P36")
@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("kind", WEIGHTS)
def test_semi_definite_whatever_the_signs(name, kind):
    pair = laplacian(MESHES[name](), kind)
    values = np.linalg.eigvalsh(pair.stiffness.toarray())
    scale = values[-1]
    assert values[0] > -1e-12 * scale
    assert values[0] < 1e-12 * scale  # printed: definite (E44)
    assert values[1] > 1e-7 * scale


@pytest.mark.parametrize("name", IRREGULAR)
def test_made_of_the_normalised_averaging_it_is_not_symmetric(name):
    """Printed: "given a local averaging W" (E15); the library refuses such weights."""
    A = laplacian(MESHES[name](), "combinatorial").averaging
    assert abs(A - A.T).max() > 0.1
    with pytest.raises(MeshError, match="symmetric"):
        laplacian(csr_array(A))


@pytest.mark.chapter("P21")
@pytest.mark.parametrize("name", ["open", "bad", "pl"])
def test_linear_functions_are_harmonic_inside_planar_meshes(name):
    mesh = MESHES[name]()
    inside = np.setdiff1d(np.arange(mesh.n_vertices), mesh.topology.boundary_edges)
    off = {}
    for kind in WEIGHTS:
        pair = laplacian(mesh, kind, "degree")
        off[kind] = np.abs(pair.apply(mesh.vertices))[inside].max()
    assert off["cotangent"] < 1e-12
    if name != "pl":
        assert off["combinatorial"] > 0.03
        assert off["distance"] > 0.02
        wrong = oracle.weights(mesh, "cotangent", apex="printed")
        literal = oracle.stiffness(wrong) / wrong.sum(axis=1)[:, None]
        assert np.abs((literal @ mesh.vertices)[inside]).max() > 0.05
