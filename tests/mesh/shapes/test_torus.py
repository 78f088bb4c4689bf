import numpy as np
import pytest

from beltrami.errors import MeshError
from beltrami.mesh.shapes import torus


@pytest.mark.parametrize("counts", [(3, 3), (3, 4), (7, 5), (48, 24)])
def test_genus_one_at_any_counts(survey, counts):
    mesh = torus(*counts)
    facts = survey(mesh)
    assert (mesh.n_vertices, mesh.n_faces) == (np.prod(counts), 2 * np.prod(counts))
    assert (facts.euler, facts.boundary_edges, facts.components) == (0, 0, 1)
    assert facts.is_manifold
    assert facts.volume > 0


def test_area_and_volume_converge_at_order_two(survey, rate):
    R, r = 1.5, 0.4
    facts = [survey(torus(k * 12, k * 6, R, r)) for k in (4, 8, 16)]
    assert rate([4 * np.pi**2 * R * r - f.area for f in facts]) == pytest.approx(2, abs=0.03)
    assert rate([2 * np.pi**2 * R * r**2 - f.volume for f in facts]) == pytest.approx(2, abs=0.03)


def test_numbering_and_implicit_equation():
    nu, nv, R, r = 8, 6, 2.0, 0.5
    x, y, z = torus(nu, nv, R, r).vertices.T
    assert np.allclose((np.hypot(x, y) - R) ** 2 + z**2, r**2)
    i, j = 3, 2
    u, v = 2 * np.pi * i / nu, 2 * np.pi * j / nv
    at = i + j * nu
    assert np.allclose([np.arctan2(y[at], x[at]), z[at]], [u, r * np.sin(v)])


@pytest.mark.parametrize(
    "bad", [{"nu": 2}, {"nv": 2}, {"minor": 1.0}, {"minor": -1}, {"major": np.inf}]
)
def test_bad_parameters(bad):
    with pytest.raises(MeshError, match=next(iter(bad))):
        torus(**bad)
