"""Distances along the sphere and the disk under refinement."""

import numpy as np
import pytest

from beltrami.geodesics.distance import geodesic_distance
from beltrami.mesh.shapes import disk, icosphere


def _slope(errors):
    sizes = 2.0 ** -np.arange(len(errors))
    return np.polyfit(np.log(sizes), np.log(errors), 1)[0]


def _errors(meshes, distance, **options):
    errors = []
    for mesh in meshes:
        found = geodesic_distance(mesh, 0, **options)
        errors.append(np.abs(found - distance(mesh.vertices, mesh.vertices[0])).mean())
    return errors


def _great_circle(x, y):
    return np.arctan2(np.linalg.norm(np.cross(x, y), axis=1), x @ y)


def _straight(x, y):
    return np.linalg.norm(x - y, axis=1)


@pytest.mark.parametrize("intrinsic", [False, True])
def test_heat_on_the_sphere_is_of_first_order(intrinsic):
    errors = _errors([icosphere(s) for s in (2, 3, 4, 5)], _great_circle, intrinsic=intrinsic)
    assert _slope(errors) == pytest.approx(1, abs=0.25)
    assert errors[-1] < 0.012


def test_exact_on_the_sphere_is_of_second_order():
    """The polyhedron is at fault, not its distances."""
    errors = _errors([icosphere(s) for s in (2, 3, 4)], _great_circle, method="exact")
    assert _slope(errors) == pytest.approx(2, abs=0.1)


def test_edges_on_the_sphere_do_not_converge():
    errors = _errors([icosphere(s) for s in (2, 3, 4)], _great_circle, method="edges")
    assert abs(_slope(errors)) < 0.3
    assert min(errors) > 0.03


def test_heat_on_the_disk_is_of_first_order():
    errors = _errors([disk(k) for k in (8, 16, 32)], _straight)
    assert _slope(errors) == pytest.approx(1, abs=0.25)
