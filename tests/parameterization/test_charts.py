"""Charts: each is mapped once without a seam, however many seams may follow."""

import numpy as np
import pytest

from beltrami.mesh.shapes import icosphere
from beltrami.parameterization import components
from beltrami.parameterization.atlas import atlas
from beltrami.parameterization.charts import Asked, map_chart
from beltrami.parameterization.reweighting import assess


@pytest.fixture
def solved(monkeypatch):
    """Note the vertices of all disks that are mapped."""
    sizes = []
    one = components._solved

    def noted(current, part, number, asked):
        sizes.append(part.n_vertices)
        return one(current, part, number, asked)

    monkeypatch.setattr(components, "_solved", noted)
    return sizes


def test_what_is_known_without_a_seam_is_not_mapped_again(solved):
    """A sphere is a disk of 2 more vertices at least when it is cut, and more with each seam."""
    ball = icosphere(2)
    every, corners = np.arange(ball.n_faces), np.arange(ball.n_vertices)
    asked = Asked("free", 2, 1.01, 0.0)
    assert map_chart(ball, every, corners, ball, asked) is None
    assert len(solved) > 1
    assert solved.count(solved[0]) == 1
    assert min(solved[1:]) > solved[0]


def test_seams_are_only_tried_where_a_chart_needs_them(solved):
    """Halves of a sphere are charts of 1.035, without a seam."""
    found = atlas(icosphere(2), 2, size=128)
    assert (found.count, len(solved)) == (2, 2)


def test_a_map_that_was_rescued_by_seams_is_not_taken_for_one_without(monkeypatch):
    """Its cut has more vertices than the disk that the next trial begins with."""
    one, solved = components._solved, []

    def folded_at_first(current, part, number, asked):
        found = one(current, part, number, asked)
        solved.append(part.n_vertices)
        return found if len(solved) > 1 else assess(part, found.uv * [-1, 1])

    monkeypatch.setattr(components, "_solved", folded_at_first)
    ball = icosphere(2)
    every, corners = np.arange(ball.n_faces), np.arange(ball.n_vertices)
    assert map_chart(ball, every, corners, ball, Asked("free", 2, 1.01, 0.0)) is None
    assert solved.count(solved[0]) == 1
