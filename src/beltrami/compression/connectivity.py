"""Connectivity: any faces to bytes and back, up to a numbering that is stated."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Integers
from beltrami.compression.conquest import (
    BAD_SPLIT,
    ENDS_EARLY,
    NOT_CLOSED,
    TOO_MANY_FACES,
    TOO_MANY_VERTICES,
    Surface,
    conquer,
    new_conquest,
    surface_to_conquer,
    surface_to_fill,
)
from beltrami.compression.cutting import Pieces, cut_into_pieces
from beltrami.compression.leftovers import (
    Leftovers,
    as_gaps,
    code_leftovers,
    from_gaps,
    leftovers_to_fill,
)
from beltrami.compression.range_coder import (
    POSITION,
    finished,
    new_decoder,
    new_encoder,
    ran_dry,
    readable,
)
from beltrami.compression.varint import Reader, to_varints
from beltrami.mesh.topology import Topology

_PROBLEMS = {
    TOO_MANY_FACES: "more faces than it declares",
    TOO_MANY_VERTICES: "more vertices than it declares",
    NOT_CLOSED: "faces that do not close",
    BAD_SPLIT: "a face that touches what is not there",
    ENDS_EARLY: "less than it declares",
}


@dataclass(frozen=True, eq=False)
class Connectivity:
    """A topology in the order of its file.

    Parameters
    ----------
    faces
        (m, 3) in the new numbers.
    vertices
        (n,) the old number of each vertex.
    source
        (m,) the old number of each face.
    """

    faces: Integers
    vertices: Integers
    source: Integers


def encode_connectivity(topology: Topology) -> tuple[bytes, Connectivity]:
    """Write the faces to bytes; the same topology gives the same bytes; O(m log m).

    Examples
    --------
    >>> data, found = encode_connectivity(Topology([[0, 1, 2], [2, 1, 3]]))
    >>> found.vertices.tolist(), found.faces.tolist()
    ([0, 1, 2, 3], [[0, 1, 2], [1, 3, 2]])
    """
    pieces = cut_into_pieces(topology)
    m, n = len(pieces.faces), len(pieces.vertex)
    valence = np.bincount(pieces.faces.ravel(), minlength=n)
    size = 2 * m + 1024
    while True:
        surface = surface_to_conquer(pieces.faces, pieces.twins, n)
        buffer, state = np.zeros(size, np.uint8), new_encoder()
        conquer(surface, new_conquest(m, n), valence, state, buffer)
        left, found = _collect(topology, pieces, surface)
        final = topology.n_vertices
        code_leftovers(left, final, _models(), state, buffer)
        payload = finished(state, buffer)
        if payload is not None:
            break
        size = int(state[POSITION]) + 1024  # the state counts what was lost
    counts = (
        final,
        m,
        n,
        *(len(part) for part in (left.middles, left.merged, left.turned, left.improper)),
    )
    return to_varints(counts) + payload, found


def _models() -> NDArray[np.int64]:
    return np.full((3, 128), 1 << 15, np.int64)


def _collect(
    topology: Topology, pieces: Pieces, surface: Surface
) -> tuple[Leftovers, Connectivity]:
    """Give the vertices new numbers, and list what the conquest has left out."""
    order = np.argsort(surface.number)
    vertex = pieces.vertex[order]  # of the mesh, in the order of the conquest; -1 for middles
    middles = np.flatnonzero(vertex < 0)
    named = vertex[vertex >= 0]
    unique, first = np.unique(named, return_index=True)
    ranked = unique[np.argsort(first)]
    alone = np.setdiff1d(np.arange(topology.n_vertices), unique, assume_unique=True)
    vertices = np.concatenate([ranked, alone])
    new = np.empty(topology.n_vertices, np.int64)
    new[vertices] = np.arange(len(vertices))
    again = np.ones(len(named), np.bool_)
    again[first] = False
    kept = surface.source < len(pieces.source)
    source = surface.source[kept]
    turned = pieces.turned[source]
    name = np.full(len(vertex), -1)
    name[vertex >= 0] = new[named]
    proper = name[surface.conquered[kept]]
    proper[turned] = proper[turned][:, [0, 2, 1]]
    improper = np.flatnonzero(topology.face_edges[:, 0] < 0)
    left = Leftovers(
        as_gaps(middles),
        as_gaps(np.flatnonzero(again)),
        new[named[again]],
        turned.astype(np.uint8) if turned.any() else np.zeros(0, np.uint8),
        new[topology.faces[improper]],
    )
    faces = np.concatenate([proper, left.improper])
    return left, Connectivity(faces, vertices, np.concatenate([pieces.source[source], improper]))


def decode_connectivity(reader: Reader, max_vertices: int) -> tuple[Integers, int]:
    """Read (faces, number of vertices); what cannot be is a FileFormatError.

    Memory and time are proportional to the numbers of faces and vertices that the file declares,
    of which no more than some multiple of ``max_vertices`` is accepted.
    """
    what = "vertices (max_vertices can be raised)"
    final = reader.varint(max_vertices, what)
    most = 8 * max_vertices + 64
    m = reader.varint(most, "faces")
    n, middles, merged, turned, improper = (reader.varint(most, "counts") for _ in range(5))
    if n > 3 * m or middles > n or merged + middles > n or turned > m:
        raise reader.fault("the counts contradict each other")
    if n - middles - merged > final or (improper and not final):
        raise reader.fault("more vertices than it declares")
    buffer = readable(reader.rest())
    state = new_decoder(buffer)
    surface, conquest = surface_to_fill(m), new_conquest(m, n)
    status = conquer(surface, conquest, np.zeros(0, np.int64), state, buffer)
    if status or conquest.counts[1] != n:
        raise reader.fault(_PROBLEMS.get(status, "fewer vertices than it declares"))
    left = leftovers_to_fill(middles, merged, turned, improper)
    code_leftovers(left, final, _models(), state, buffer)
    if ran_dry(state, buffer):
        raise reader.fault(_PROBLEMS[ENDS_EARLY])
    return _assemble(surface.conquered, left, n, reader), final


def _assemble(conquered: NDArray[np.int32], left: Leftovers, n: int, reader: Reader) -> Integers:
    """Make the final faces of the conquered ones."""
    middles, merged = from_gaps(left.middles), from_gaps(left.merged)
    others = n - len(middles)
    if (len(middles) and not 0 <= middles[-1] < n) or (
        len(merged) and not 0 <= merged[-1] < others
    ):
        raise reader.fault("a vertex that is not there")
    again = np.zeros(others, np.bool_)
    again[merged] = True
    name = np.cumsum(~again) - 1
    name[merged] = left.target
    closed = np.zeros(n, np.bool_)
    closed[middles] = True
    of_piece = np.full(n, -1)
    of_piece[~closed] = name
    proper = of_piece[conquered]
    proper = proper[(proper >= 0).all(axis=1)]
    if len(left.turned):
        if len(left.turned) != len(proper):
            raise reader.fault("turned faces that are not there")
        turned = left.turned.astype(np.bool_)
        proper[turned] = proper[turned][:, [0, 2, 1]]
    return np.concatenate([proper, left.improper])
