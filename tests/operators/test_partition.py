import numpy as np
import pytest
from scipy.sparse import coo_array

import beltrami as bt
from beltrami.errors import BeltramiError, DimensionError
from beltrami.operators.partition import gather_rows, partition_rows

MESHES = {
    "torus": bt.shapes.torus(15, 9),
    "open": bt.shapes.grid(7, 5),
    "tiny": bt.Mesh([[0, 0, 0], [1, 0, 0], [0, 1e-9, 0]], [[0, 1, 2]]),
}


def put_together(blocks, name):
    """Return the matrix that the rows of all blocks make, in the numbers of the vertices."""
    order = np.concatenate([block.owned for block in blocks])
    n = blocks[0].n
    rows, columns, data = [], [], []
    for block in blocks:
        matrix = getattr(block, name).tocoo()
        rows.append(order[block.start + matrix.row])
        columns.append(order[block.columns[matrix.col]])
        data.append(matrix.data)
    return coo_array(
        (np.concatenate(data), (np.concatenate(rows), np.concatenate(columns))), (n, n)
    ).tocsr()


@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("mass", ["voronoi", "consistent"])
@pytest.mark.parametrize("parts", [1, 2, 3])
def test_the_blocks_are_the_pair_bit_for_bit(name, mass, parts):
    pair = bt.laplacian(MESHES[name], mass=mass)
    blocks = partition_rows(pair, parts)
    assert len(blocks) == parts
    sizes = [len(block.owned) for block in blocks]
    assert max(sizes) - min(sizes) <= 1
    assert [block.start for block in blocks] == [0, *np.cumsum(sizes)[:-1]]
    assert sorted(np.concatenate([block.owned for block in blocks])) == list(range(pair.n))
    assert (put_together(blocks, "stiffness") != pair.stiffness).nnz == 0
    assert (put_together(blocks, "mass") != pair.mass).nnz == 0


@pytest.mark.parametrize("parts", [2, 5])
def test_products_need_the_ghosts_and_nothing_else(parts):
    pair = bt.laplacian(bt.shapes.icosphere(3))
    f = np.random.default_rng(8).normal(size=pair.n)
    blocks = bt.partition_rows(pair, parts)
    parts_of_f = [np.concatenate([f[b.owned], f[b.ghost_vertices]]) for b in blocks]
    found = gather_rows(blocks, [b.stiffness @ x for b, x in zip(blocks, parts_of_f, strict=True)])
    assert np.allclose(found, pair.stiffness @ f, rtol=0, atol=1e-13)
    for block in blocks:
        inside = np.isin(block.ghosts, np.arange(block.start, block.start + len(block.owned)))
        assert not inside.any()
        assert set(block.stiffness.indices) == set(range(len(block.columns)))


def test_a_mesh_is_cut_where_it_is_thin():
    pair = bt.laplacian(bt.shapes.cylinder(12, 80, height=20))
    left, right = partition_rows(pair, 2)
    assert max(len(left.ghosts), len(right.ghosts)) <= 14  # a ring around, not a line along


def test_labels_of_yours():
    pair = bt.laplacian(bt.shapes.grid(4, 4))
    labels = np.arange(25) % 3
    blocks = partition_rows(pair, labels)
    assert [block.owned.tolist() for block in blocks] == [
        list(range(first, 25, 3)) for first in range(3)
    ]


def test_a_graph_without_positions():
    pair = bt.laplacian(bt.shapes.torus(40, 5).topology)
    blocks = partition_rows(pair, 2)
    assert (put_together(blocks, "stiffness") != pair.stiffness).nnz == 0
    assert len(blocks[0].ghosts) <= 24  # two rings and a little


@pytest.mark.parametrize(
    "parts", [0, -1, 2.5, "two", 13, [0, 1], np.zeros(12), np.r_[[-1], np.zeros(11, int)],
              np.full(12, 1), [[0] * 12], np.full(12, 2**60), None, True]
)  # fmt: skip
def test_what_is_no_partition(parts):
    pair = bt.laplacian(bt.shapes.icosphere(0))
    with pytest.raises(BeltramiError):
        partition_rows(pair, parts)


def test_it_needs_a_pair():
    with pytest.raises(DimensionError, match="a Laplacian is needed for a partition"):
        partition_rows(bt.shapes.icosphere(0), 2)
    block = partition_rows(bt.laplacian(bt.shapes.icosphere(0)), 2)[0]
    assert not block.stiffness.data.flags.writeable


def test_what_cannot_be_put_together():
    blocks = partition_rows(bt.laplacian(bt.shapes.icosphere(0)), 3)
    ones = [np.ones(len(block.owned)) for block in blocks]
    assert gather_rows(list(blocks), ones).tolist() == [1.0] * 12
    columns = [np.ones((len(block.owned), 2)) for block in blocks]
    assert gather_rows(blocks, columns).shape == (12, 2)
    for some in ((), blocks[:2]):
        with pytest.raises(BeltramiError, match="from all blocks"):
            gather_rows(some, ones[: len(some)])
    for wrong in (ones[:2], [*ones, ones[0]], [*ones[:2], columns[2]], [*ones[:2], [1.0]]):
        with pytest.raises(DimensionError):
            gather_rows(blocks, wrong)
