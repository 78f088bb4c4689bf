import numpy as np
import pytest

from beltrami.errors import MeshError
from beltrami.mesh.shapes import icosphere


@pytest.mark.parametrize("s", [0, 1, 3])
def test_counts_and_topology(survey, s):
    mesh = icosphere(s)
    facts = survey(mesh)
    assert (mesh.n_vertices, mesh.n_faces) == (10 * 4**s + 2, 20 * 4**s)
    assert (facts.euler, facts.boundary_edges, facts.components) == (2, 0, 1)
    assert facts.is_manifold
    assert sorted(np.unique(np.bincount(mesh.faces.ravel()))) == ([5] if s == 0 else [5, 6])
    assert (np.bincount(mesh.faces.ravel()) == 5).sum() == 12


def test_area_and_volume_converge_from_below_at_order_two(survey, rate):
    facts = [survey(icosphere(s, radius=2.0)) for s in (2, 3, 4)]
    areas = [16 * np.pi - f.area for f in facts]
    volumes = [32 / 3 * np.pi - f.volume for f in facts]
    assert rate(areas) == pytest.approx(2, abs=0.03)
    assert rate(volumes) == pytest.approx(2, abs=0.03)
    assert areas[-1] < 0.01 * 16 * np.pi


def test_vertices_are_on_the_sphere_and_symmetric():
    mesh = icosphere(3, radius=0.7)
    assert np.allclose(np.linalg.norm(mesh.vertices, axis=1), 0.7, rtol=1e-14)
    rows = {tuple(row) for row in mesh.vertices.round(9) + 0.0}
    assert {tuple(row) for row in (-mesh.vertices).round(9) + 0.0} == rows
    assert {tuple(row) for row in np.roll(mesh.vertices, 1, axis=1).round(9) + 0.0} == rows


def test_coarser_vertices_come_first():
    assert np.array_equal(icosphere(3).vertices[:162], icosphere(2).vertices)


@pytest.mark.parametrize("bad", [{"subdivisions": -1}, {"subdivisions": 1.5}, {"radius": 0}])
def test_bad_parameters(bad):
    with pytest.raises(MeshError, match=next(iter(bad))):
        icosphere(**bad)
