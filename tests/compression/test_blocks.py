"""Blocks: every vertex once, few and compact, from the faces alone."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from beltrami.compression.blocks import cut_into_blocks
from beltrami.compression.numbers import surroundings
from beltrami.mesh import shapes
from strategies import any_meshes


def cut(faces, n, most):
    blocks = cut_into_blocks(surroundings(np.asarray(faces), n), n, most)
    return [blocks.vertices[a:b] for a, b in blocks.each()]


@given(any_meshes(), st.integers(1, 9))
@settings(max_examples=60)
def test_every_vertex_is_in_one_block_and_blocks_are_as_few_as_can_be(mesh, most):
    parts = cut(mesh.faces, mesh.n_vertices, most)
    assert len(parts) == -(-mesh.n_vertices // most)
    assert sorted(v for part in parts for v in part.tolist()) == list(range(mesh.n_vertices))
    assert all(0 < len(part) <= most for part in parts)


@pytest.mark.parametrize("mesh", [shapes.icosphere(3), shapes.grid(40, 10)], ids=["ball", "sheet"])
def test_blocks_are_compact(mesh):
    """A block of k vertices has about 4 sqrt(k) edges to others; strips or dust have more."""
    parts = cut(mesh.faces, mesh.n_vertices, 100)
    label = np.empty(mesh.n_vertices, int)
    for i, part in enumerate(parts):
        label[part] = i
    across = (label[mesh.edges[:, 0]] != label[mesh.edges[:, 1]]).sum()
    assert across < len(parts) * 4 * np.sqrt(100)


def test_pieces_apart_are_cut_apart():
    one = shapes.grid(5, 5)
    faces = np.concatenate([one.faces, one.faces + one.n_vertices])
    parts = cut(faces, 2 * one.n_vertices, one.n_vertices)
    assert [len(part) for part in parts] == [one.n_vertices] * 2
    assert {tuple(set((part // one.n_vertices).tolist())) for part in parts} == {(0,), (1,)}
