"""Theorem 7: the kernels of L and of the normalised Laplacian (E19, E45)."""

import numpy as np
import pytest
from scipy.linalg import null_space

from beltrami.errors import UnreferencedVertexError
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import icosphere
from beltrami.operators.laplacian import laplacian
from beltrami.operators.weights import WEIGHTS
from meshes_of_the_errata import IRREGULAR, MESHES

pytestmark = pytest.mark.chapter("T7")


@pytest.mark.parametrize("name", IRREGULAR)
@pytest.mark.parametrize("kind", WEIGHTS)
def test_of_a_connected_mesh(name, kind):
    """Also for negative cotangents: the energy of the interpolant decides, not the graph."""
    pair = laplacian(MESHES[name](), kind)
    L, N = pair.stiffness.toarray(), pair.normalized.toarray()
    for matrix, direction in ((L, np.ones(pair.n)), (N, np.sqrt(pair.degrees))):
        kernel = null_space(matrix, rcond=1e-9)
        assert kernel.shape[1] == 1
        cosine = abs(kernel[:, 0] @ direction) / np.linalg.norm(direction)
        assert cosine == pytest.approx(1, abs=1e-12)
    plain = np.ones(pair.n) / np.sqrt(pair.n)
    assert abs(null_space(N, rcond=1e-9)[:, 0] @ plain) < 0.9999


def test_one_dimension_for_each_component():
    sphere, other = icosphere(1), icosphere(2)
    n = sphere.n_vertices
    two = Mesh(
        np.concatenate([sphere.vertices, other.vertices + 3]),
        np.concatenate([sphere.faces, other.faces + n]),
    )
    for kind in WEIGHTS:
        values = np.linalg.eigvalsh(laplacian(two, kind).stiffness.toarray())
        assert (values < 1e-10).sum() == 2


def test_an_unreferenced_vertex_would_be_another_one():
    mesh = MESHES["open"]()
    more = Mesh(np.concatenate([mesh.vertices, [[0.5, 0.5]]]), mesh.faces)
    for kind in WEIGHTS:
        with pytest.raises(UnreferencedVertexError) as caught:
            laplacian(more, kind)
        assert caught.value.vertices.tolist() == [192]
