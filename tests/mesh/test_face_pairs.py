import numpy as np
import pytest
from hypothesis import given

from beltrami.mesh.face_pairs import pair_faces
from beltrami.mesh.half_edges import pair_sides
from beltrami.mesh.shapes import icosphere
from beltrami.mesh.topology import Topology
from dictionary_of_sides import sides_of
from strategies import any_arrays


@given(any_arrays())
def test_pairs_by_a_dictionary(arrays):
    x, faces = arrays
    pairs = pair_faces(faces, pair_sides(faces, len(x)).twins)
    two = sorted(sides for sides in sides_of(faces).values() if len(sides) == 2)
    expected = [(h, g, start != other) for (h, start, _), (g, other, _) in two]
    assert list(zip(*(part.tolist() for part in pairs), strict=True)) == expected
    assert pairs.faces.tolist() == [[h // 3, g // 3] for h, g in zip(*pairs[:2], strict=True)]


def test_no_pair_across_an_edge_of_three_faces_nor_at_the_boundary():
    fan = Topology([[0, 1, 2], [0, 1, 3], [1, 0, 4], [2, 1, 5]])
    assert fan.edges[fan.face_edges.ravel()[fan.face_pairs.side]].tolist() == [[1, 2]]


def test_a_closed_surface_has_one_pair_for_each_edge():
    sphere = icosphere(2).topology
    assert len(sphere.face_pairs.side) == sphere.n_edges
    assert sphere.face_pairs.agree.all()


@pytest.mark.parametrize("turned", [[], [0, 1, 2], [3]])
def test_a_moebius_strip_disagrees_somewhere_however_it_is_turned(turned):
    strip = np.array([[i, (i + 1) % 5, (i + 2) % 5] for i in range(5)])
    strip[turned] = strip[turned, ::-1]
    pairs = Topology(strip).face_pairs
    assert len(pairs.side) == 5
    assert not pairs.agree.all()


def test_what_a_topology_gives_cannot_be_written():
    for part in icosphere(1).topology.face_pairs:
        with pytest.raises(ValueError, match="read-only"):
            part[0] = 0
