import numpy as np
import pytest

from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes.concentric import disk_faces, ring_points


@pytest.mark.parametrize("counts", [[1, 3], [1, 5, 5], [1, 4, 11, 9], [1, 7, 6, 20]])
def test_any_counts_make_a_disk_oriented_upward(survey, counts):
    points = ring_points(counts, list(range(len(counts))))
    numbers = np.split(np.arange(len(points)), np.cumsum(counts)[:-1])
    mesh = Mesh(points, disk_faces(numbers))
    facts = survey(mesh)
    assert (facts.euler, facts.boundary_edges, facts.is_manifold) == (1, counts[-1], True)
    a, b, c = points[mesh.faces].transpose(1, 0, 2)
    assert ((b - a)[:, 0] * (c - a)[:, 1] > (b - a)[:, 1] * (c - a)[:, 0]).all()
