import numpy as np
import pytest

from beltrami.errors import MeshError
from beltrami.mesh.shapes import cylinder


@pytest.mark.parametrize(("around", "along"), [(3, 1), (7, 4), (32, 10)])
def test_open_tube_and_closed_can(survey, around, along):
    tube, can = cylinder(around, along), cylinder(around, along, caps=True)
    open_facts, facts = survey(tube), survey(can)
    assert (tube.n_vertices, tube.n_faces) == (around * (along + 1), 2 * around * along)
    assert (open_facts.euler, open_facts.boundary_edges) == (0, 2 * around)
    assert (facts.euler, facts.boundary_edges, facts.components) == (2, 0, 1)
    assert open_facts.is_manifold
    assert facts.is_manifold
    assert np.array_equal(can.vertices[: tube.n_vertices], tube.vertices)
    assert np.array_equal(can.faces[: tube.n_faces], tube.faces)


def test_area_and_volume_are_those_of_the_prism(survey):
    k, r, h = 9, 0.6, 1.7
    base = k / 2 * np.sin(2 * np.pi / k) * r**2
    side = 2 * r * np.sin(np.pi / k) * k * h
    assert survey(cylinder(k, 3, r, h)).area == pytest.approx(side, rel=1e-13)
    facts = survey(cylinder(k, 3, r, h, caps=True))
    assert facts.area == pytest.approx(side + 2 * base, rel=1e-13)
    assert facts.volume == pytest.approx(base * h, rel=1e-13)


def test_area_and_volume_converge_at_order_two(survey, rate):
    facts = [survey(cylinder(k, 4, 0.5, 3.0, caps=True)) for k in (16, 32, 64)]
    assert rate([np.pi * 3.5 - f.area for f in facts]) == pytest.approx(2, abs=0.02)
    assert rate([np.pi * 0.75 - f.volume for f in facts]) == pytest.approx(2, abs=0.02)


def test_caps_have_no_thin_triangles(survey):
    assert survey(cylinder(100, 30, caps=True)).min_angles.min() > 30


@pytest.mark.parametrize("bad", [{"n_around": 2}, {"n_along": 0}, {"radius": -1}, {"height": 0}])
def test_bad_parameters(bad):
    with pytest.raises(MeshError, match=next(iter(bad))):
        cylinder(**bad)
