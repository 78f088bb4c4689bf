import numpy as np
import pytest

from beltrami.errors import MeshError
from beltrami.mesh.shapes import cube, octahedron, tetrahedron


@pytest.mark.parametrize("s", [1, 2, 5])
def test_cube(survey, s):
    mesh = cube(s, size=3.0)
    facts = survey(mesh)
    assert (mesh.n_vertices, mesh.n_faces) == (6 * s**2 + 2, 12 * s**2)
    assert (facts.euler, facts.boundary_edges, facts.is_manifold) == (2, 0, True)
    assert facts.area == pytest.approx(54, rel=1e-13)
    assert facts.volume == pytest.approx(27, rel=1e-13)
    assert (np.abs(mesh.vertices).max(axis=1) == 1.5).all()
    assert np.array_equal(np.lexsort(mesh.vertices.T[::-1]), np.arange(mesh.n_vertices))


@pytest.mark.parametrize(
    ("make", "n", "m", "area", "volume"),
    [
        (tetrahedron, 4, 4, 8 / np.sqrt(3), 8 / (9 * np.sqrt(3))),
        (octahedron, 6, 8, 4 * np.sqrt(3), 4 / 3),
    ],
)
def test_regular_solids(survey, make, n, m, area, volume):
    mesh = make(2.0)
    facts = survey(mesh)
    assert (mesh.n_vertices, mesh.n_faces) == (n, m)
    assert (facts.euler, facts.boundary_edges, facts.is_manifold) == (2, 0, True)
    assert facts.area == pytest.approx(4 * area, rel=1e-13)
    assert facts.volume == pytest.approx(8 * volume, rel=1e-13)
    assert np.allclose(facts.min_angles, 60)
    assert np.allclose(np.linalg.norm(mesh.vertices, axis=1), 2.0, rtol=1e-14)


@pytest.mark.parametrize(
    ("make", "bad"),
    [(cube, "subdivisions"), (cube, "size"), (tetrahedron, "radius"), (octahedron, "radius")],
)
def test_bad_parameters(make, bad):
    with pytest.raises(MeshError, match=bad):
        make(**{bad: 0})
