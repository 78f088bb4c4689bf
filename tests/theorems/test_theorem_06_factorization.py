"""Theorem 6: L = G'G and the normalised one, for w >= 0; signed weights otherwise (E40)."""

import numpy as np
import pytest

from beltrami.operators.gradient import face_divergence, face_gradient
from beltrami.operators.laplacian import laplacian
from beltrami.operators.weights import WEIGHTS
from meshes_of_the_errata import IRREGULAR, MESHES

pytestmark = pytest.mark.chapter("T6")

POSITIVE = [(name, kind) for name in IRREGULAR for kind in ("combinatorial", "distance")]


@pytest.mark.parametrize(("name", "kind"), [*POSITIVE, ("closed", "cotangent")])
def test_for_non_negative_weights(name, kind):
    pair = laplacian(MESHES[name](), kind)
    G, L = pair.gradient.toarray(), pair.stiffness.toarray()
    assert np.abs(G.T @ G - L).max() < 1e-13 * L.max()
    scaled = G / np.sqrt(pair.degrees)
    assert np.abs(scaled.T @ scaled - pair.normalized.toarray()).max() < 1e-13


@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("kind", WEIGHTS)
def test_for_weights_of_any_sign(name, kind):
    pair = laplacian(MESHES[name](), kind)
    G0, L = pair.incidence.toarray(), pair.stiffness.toarray()
    assert np.abs(G0.T @ (pair.edge_weight[:, None] * G0) - L).max() < 1e-13 * L.max()


@pytest.mark.parametrize("name", ["obt", "bad"])
def test_a_complex_root_does_not_help(name):
    pair = laplacian(MESHES[name]())
    G = np.sqrt(pair.edge_weight.astype(complex))[:, None] * pair.incidence.toarray()
    L = pair.stiffness.toarray()
    assert np.abs(G.T @ G - L).max() < 1e-12 * L.max()
    assert np.abs(G.conj().T @ G - L).max() > 1


@pytest.mark.chapter("U19")
@pytest.mark.parametrize("name", IRREGULAR)
def test_three_expressions_of_the_energy(name):
    """<Lf, f> = |Gf|² = Σ over the edges once; over both orders it is twice that (E28)."""
    pair = laplacian(MESHES[name](), "distance")
    f = np.random.default_rng(7297352).normal(size=pair.n)
    energy = pair.dirichlet_energy(f)
    i, j = pair.edges.T
    assert ((pair.gradient @ f) ** 2).sum() == pytest.approx(energy)
    assert pair.edge_weight @ (f[i] - f[j]) ** 2 == pytest.approx(energy)
    W = pair.weights.tocoo()
    assert W.data @ (f[W.row] - f[W.col]) ** 2 == pytest.approx(2 * energy)


@pytest.mark.chapter("P38")
@pytest.mark.parametrize("name", IRREGULAR)
def test_the_stiffness_is_minus_divergence_of_gradient(name):
    """For cotangents of any sign, with the gradient inside the faces: L = -div grad (E41)."""
    mesh = MESHES[name]()
    gradient, divergence = face_gradient(mesh), face_divergence(mesh)
    pair = laplacian(mesh)
    f, g = np.random.default_rng(16021766).normal(size=(2, pair.n))

    def check(operator):
        assert np.allclose(pair.stiffness @ f, operator @ f, atol=1e-9 * abs(pair.stiffness).max())

    check(-(divergence @ gradient))
    for wrong in (divergence @ gradient, gradient.T @ gradient, -2 * (divergence @ gradient)):
        with pytest.raises(AssertionError):  # the first one as printed
            check(wrong)
    inside = np.tile(mesh.face_areas, mesh.dimension) * (gradient @ f)
    assert g @ (divergence @ (gradient @ f)) == pytest.approx(-(gradient @ g) @ inside, rel=1e-9)
