"""Which mode and which step: tried on a sample, and not on all vertices again and again."""

import numpy as np
import pytest

import beltrami as bt
from beltrami.compression import bounded, choosing
from beltrami.compression.block_basis import BlockBasis
from beltrami.compression.contents import describe
from beltrami.compression.descent import downhill
from beltrami.compression.neighbourhood import coding_order, look_around
from beltrami.compression.numbers import surroundings
from beltrami.compression.sampling import order_of_sample, part_of, sample_of
from beltrami.compression.transform import analyse
from beltrami.mesh.mesh import Mesh
from made_once import creature


def around(mesh):
    return surroundings(mesh.faces, mesh.n_vertices)


@pytest.mark.parametrize("size", [50, 1999, 4500])
def test_a_sample_is_of_regions(size):
    sample = sample_of(around(creature(6000)), size)
    assert size // max(1, size // 2000) <= len(sample) <= size  # regions may meet
    assert (np.diff(sample) > 0).all()
    faces = part_of(creature(6000).faces, creature(6000).n_vertices, sample)
    part = Mesh(creature(6000).vertices[sample], faces)
    np.testing.assert_array_equal(
        np.sort(sample[faces], axis=1),
        np.sort(creature(6000).faces[np.isin(creature(6000).faces, sample).all(axis=1)], axis=1),
    )
    assert part.topology.n_components <= max(1, size // 2000)


def test_a_sample_of_what_hangs_together_nowhere():
    near = look_around(np.zeros((0, 3), int), 9000)
    assert len(sample_of(near, 6000)) == 3  # the middles alone
    order = order_of_sample(near, 6000)
    assert sorted(set(order.tolist())) == sorted(order.tolist())


def test_the_order_of_a_sample_is_how_coding_would_begin():
    near = around(creature(6000))
    order = order_of_sample(near, 4000)
    assert len(order) == len(set(order.tolist())) == 4000
    start = order[0]
    moved = np.roll(
        np.arange(creature(6000).n_vertices), -start
    )  # so that the seed has the number 0
    place = np.argsort(moved)
    other = look_around(place[creature(6000).faces], creature(6000).n_vertices)
    assert moved[coding_order(other)[0]] == start
    ring = np.flatnonzero(np.isin(order[:2000], near.around[near.starts[start] :][:6]))
    assert ring.max() < 60  # a region grows from its middle


@pytest.mark.parametrize("start", range(6))
def test_downhill(start):
    looked = []
    heights = [7, 5, 4, 2, 3, 9]

    def height(i):
        looked.append(i)
        return heights[i]

    assert downhill(height, 6, start) == 3
    assert len(set(looked)) == len(looked)


def coded(monkeypatch):
    """Count how many vertices every way of writing is given."""
    counts = {"grid": 0, "smooth": 0, "spectral": 0, "sizes": 0}

    def counting(name, label, count):
        honest = getattr(bounded, name)

        def counted(x, *rest, **options):
            counts[label] += count(x, options)
            return honest(x, *rest, **options)

        monkeypatch.setattr(bounded, name, counted)

    counting("encode_positions", "grid", lambda x, _: len(x))
    counting("encode_freely", "smooth", lambda x, _: len(x))
    counting("analyse_all", "spectral", lambda x, _: len(x))
    counting("encode_numbers", "sizes", lambda _, options: len(options["order"]))
    counting("encode_offsets", "sizes", lambda _, options: len(options["order"]))
    return counts


@pytest.mark.parametrize("part", [0.02, 1e-3, 2e-6])
def test_all_vertices_are_written_once_and_few_are_tried(monkeypatch, part):
    counts = coded(monkeypatch)
    error = part * np.ptp(creature(6000).vertices)
    data = bt.compress(creature(6000), max_error=error, effort="fast", verify=False)
    n = creature(6000).n_vertices
    assert n <= counts["grid"] + counts["smooth"] + counts["spectral"] <= n + choosing.LEAST
    assert counts["sizes"] <= 2 * choosing.LEAST
    if part < 1e-5:
        assert counts["spectral"] == counts["smooth"] == 0
    assert counts[describe(data).mode] >= n


@pytest.mark.parametrize("mode", ["grid", "smooth", "spectral"])
def test_a_mode_that_is_asked_for_is_written_once(monkeypatch, mode):
    counts = coded(monkeypatch)
    bt.compress(creature(6000), max_error=0.02, mode=mode, effort="fast", verify=False)
    tried = choosing.LEAST if mode == "spectral" else 0
    assert creature(6000).n_vertices <= counts.pop(mode) <= creature(6000).n_vertices + tried
    assert not any(counts.values())


@pytest.mark.parametrize("part", [0.03, 3e-3, 5e-4, 1e-4])
def test_what_the_sample_chooses_is_the_shortest_or_near(part):
    options = {
        "max_error": part * np.ptp(creature(6000).vertices),
        "effort": "fast",
        "verify": False,
    }
    sizes = [
        len(bt.compress(creature(6000), mode=mode, **options))
        for mode in ("grid", "smooth", "spectral")
    ]
    assert len(bt.compress(creature(6000), **options)) <= 1.05 * min(sizes)


def test_frugal_blocks_lose_little():
    """What is left out beyond small coefficients is small: as many bytes, or hardly more."""
    mesh = bt.shapes.blob(1500)
    near = around(mesh)
    error = 0.01 * np.ptp(mesh.vertices)
    part = bounded.Bounded(mesh.vertices, near, error, "fast", None)
    frugal = part.spectral((2.5,))[0]
    grid = part._stepping(2.5)
    whole = bounded.analyse_all(mesh.vertices, near, [grid], "fast")
    bound = bounded.analyse_all(mesh.vertices, near, [grid], "fast", None, error)
    few, all_of_them = bound.roundings[0].numbers, whole.roundings[0].numbers
    assert (few != all_of_them).any(axis=1).mean() < 0.01
    assert len(frugal.payload) < 1.02 * len(whole.written(0, 3)) + 400


@pytest.mark.parametrize(
    ("sizes", "mode"),
    [((100, 200), "grid"), ((200, 100), "smooth"), ((2500, 2400), "spectral")],
)
def test_all_vertices_are_written_as_the_sample_is_shortest(monkeypatch, sizes, mode):
    monkeypatch.setattr(bounded.Bounded, "size_on_grid", lambda self, order: sizes[0])
    monkeypatch.setattr(bounded.Bounded, "size_smooth", lambda self, order: sizes[1])
    error = 0.02 * np.ptp(creature(6000).vertices)
    data = bt.compress(creature(6000), max_error=error, effort="fast", verify=False)
    assert describe(data).mode == mode


def test_more_vectors_are_made_until_those_behind_are_small():
    """However few are expected, a rough block gets them all, and a smooth one few."""
    mesh = bt.shapes.blob(500)
    n = mesh.n_vertices
    basis, vertices = BlockBasis(around(mesh)), np.arange(n)
    rough = np.random.default_rng(0).normal(size=(n, 3))
    U, c = analyse(rough, vertices, basis, 1e-3, n, 8)
    assert len(c) > n - 4
    np.testing.assert_allclose(U @ c, rough, atol=5e-3)
    few, smooth = analyse(mesh.vertices, vertices, basis, 0.5, n, 8)
    assert few.shape[1] < n / 4
    np.testing.assert_array_equal(few, basis.vectors(vertices, len(smooth)))
