"""Any faces come back, in the order that is stated; and they are cheap."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from beltrami.compression.connectivity import decode_connectivity, encode_connectivity
from beltrami.compression.cutting import cut_into_pieces
from beltrami.compression.leftovers import code_leftovers, leftovers_to_fill
from beltrami.compression.range_coder import POSITION, new_decoder, ran_dry
from beltrami.compression.varint import Reader, to_varints
from beltrami.errors import FileFormatError
from beltrami.mesh import shapes
from beltrami.mesh.topology import Topology
from strategies import any_arrays


def there_and_back(topology):
    """Encode and decode, check every face and every vertex; return the bytes."""
    data, found = encode_connectivity(topology)
    faces, n = decode_connectivity(Reader(data, "x"), 10**6)
    assert n == topology.n_vertices
    np.testing.assert_array_equal(faces, found.faces)
    assert sorted(found.vertices.tolist()) == list(range(n))
    assert sorted(found.source.tolist()) == list(range(topology.n_faces))
    old, new = topology.faces[found.source], found.vertices[faces]
    turns = [(np.roll(old, k, axis=1) == new).all(axis=1) for k in range(3)]
    assert np.logical_or.reduce(turns).all()
    return data


@given(any_arrays())
@settings(max_examples=120)
def test_damaged_meshes_come_back(arrays):
    there_and_back(Topology(arrays[1], len(arrays[0])))


@given(
    st.integers(1, 8).flatmap(
        lambda n: st.tuples(
            st.just(n), st.lists(st.tuples(*[st.integers(0, n - 1)] * 3), max_size=25)
        )
    )
)
@settings(max_examples=120)
def test_arbitrary_faces_come_back(drawn):
    n, faces = drawn
    there_and_back(Topology(np.array(faces, np.int64).reshape(-1, 3), n))


@pytest.mark.parametrize(
    ("faces", "n"),
    [
        ([], 0),
        ([], 3),
        ([[0, 1, 2]], 3),
        ([[0, 0, 1], [1, 1, 1]], 4),  # no proper face
        ([[0, 1, 2], [0, 1, 2], [2, 1, 0]], 3),  # said thrice
        ([[0, 1, 2], [0, 1, 3], [0, 1, 4]], 5),  # three faces at an edge
        ([[0, 1, 2], [0, 3, 4]], 5),  # a bow tie
        ([[5, 6, 7], [0, 1, 2]], 9),  # two components and strays
    ],
)
def test_odd_faces_come_back(faces, n):
    there_and_back(Topology(np.array(faces, np.int64).reshape(-1, 3), n))


def genus(g):
    """Glue g tori of 6 x 6 squares in a chain, through removed faces."""
    torus = shapes.torus(6, 6).faces
    n = torus.max() + 1
    parts, names = [], np.arange(g * n)
    for i in range(g):
        part = torus + i * n
        parts.append(part[1:-1] if 0 < i < g - 1 else part[1:] if i else part[:-1])
        if i:  # the last face of the one before meets the first face of this, turned over
            a, b, c = part[0]
            names[[a, b, c]] = names[(torus[-1] + (i - 1) * n)[[0, 2, 1]]]
    return Topology(names[np.concatenate(parts)] if g > 1 else torus)


@pytest.mark.parametrize("g", [1, 2, 5])
def test_handles_come_back(g):
    topology = genus(g)
    assert topology.genus == g
    there_and_back(topology)


def test_turned_faces_cost_little_where_the_surface_is_orientable():
    faces = shapes.icosphere(3).faces.copy()
    straight = len(there_and_back(Topology(faces)))
    turned = np.random.default_rng(0).random(len(faces)) < 0.5
    faces[turned] = faces[turned][:, ::-1]
    mixed = len(there_and_back(Topology(faces)))
    assert mixed <= straight + len(faces) / 8 * 1.05 + 4  # a bit a face, and no cuts


def test_regular_meshes_cost_almost_nothing():
    data = there_and_back(shapes.torus(60, 60).topology)
    assert 8 * len(data) < 0.1 * 3600


@pytest.mark.parametrize(
    "mesh", [shapes.icosphere(4), shapes.cylinder(40, 30), shapes.grid(40, 40)]
)
def test_shapes_cost_less_than_a_bit_and_a_half(mesh):
    assert 8 * len(there_and_back(mesh.topology)) < 1.5 * mesh.n_vertices


def test_the_topology_alone_decides():
    """The same faces give the same bytes, and nothing else is looked at."""
    mesh = shapes.cylinder(12, 7)
    first, _ = encode_connectivity(mesh.topology)
    second, _ = encode_connectivity(Topology(mesh.faces.tolist(), mesh.n_vertices))
    assert first == second


@given(any_arrays())
def test_pieces_are_closed_oriented_manifolds(arrays):
    pieces = cut_into_pieces(Topology(arrays[1], len(arrays[0])))
    half = np.arange(len(pieces.twins))
    np.testing.assert_array_equal(pieces.twins[pieces.twins], half)
    start = pieces.faces[half // 3, (half + 1) % 3]
    end = pieces.faces[half // 3, (half + 2) % 3]
    np.testing.assert_array_equal(start[pieces.twins], end)
    fans = np.zeros(len(pieces.vertex), np.int64)
    seen = np.zeros(len(half), bool)
    for h in half:  # around each vertex: leaving half-edges form one cycle
        if not seen[h]:
            fans[start[h]] += 1
        while not seen[h]:
            seen[h] = True
            t = pieces.twins[h]
            h = t - t % 3 + (t + 1) % 3
    assert (fans == 1).all()


def test_more_than_is_allowed_is_refused():
    data, _ = encode_connectivity(shapes.icosphere(2).topology)
    with pytest.raises(FileFormatError, match="at most 100"):
        decode_connectivity(Reader(data, "x"), 100)


@pytest.mark.parametrize("counts", [(40_000, 0, 0, 0), (0, 40_000, 0, 0), (0, 0, 0, 40_000)])
def test_reading_ends_where_the_bytes_do(counts):
    """A few bytes that declare much are refused, before all that they declare is made."""
    buffer = np.arange(7, 27, dtype=np.uint8)
    left, state = leftovers_to_fill(*counts), new_decoder(buffer)
    code_leftovers(left, 10**6, np.full((3, 128), 1 << 15, np.int64), state, buffer)
    assert ran_dry(state, buffer)
    assert state[POSITION] < 2 * len(buffer)


def test_improper_faces_that_are_not_there_are_refused():
    data, _ = encode_connectivity(Topology([[0, 0, 1], [4, 4, 4]], 900))
    varints = to_varints([900, 0, 0, 0, 0, 0, 2])
    assert data.startswith(varints)
    more = to_varints([900, 0, 0, 0, 0, 0, 9])
    with pytest.raises(FileFormatError, match="less than it declares"):
        decode_connectivity(Reader(more + data[len(varints) :], "x"), 1000)


@given(st.binary(max_size=40), st.integers(0, 10_000))
def test_any_bytes_are_faces_or_an_error(noise, seed):
    rng = np.random.default_rng(seed)
    counts = bytes(rng.integers(0, 100, 7, dtype=np.uint8))
    try:
        faces, n = decode_connectivity(Reader(counts + noise, "x"), 1000)
    except FileFormatError:
        return
    Topology(faces, n)
