"""Coefficients: rounding, coding, and what a beginning of the bytes says."""

import itertools

import numpy as np
import pytest

from beltrami.compression.coefficients import code_coefficients, new_memory
from beltrami.compression.corrections import (
    corrections_for,
    decode_corrections,
    encode_corrections,
)
from beltrami.compression.range_coder import finished, new_decoder, new_encoder, readable
from beltrami.compression.transform import add_up, length_of, project, rounded
from beltrami.compression.varint import Reader
from beltrami.errors import FileFormatError


def decaying(rng, sizes, d, strength):
    """Whole numbers that decay with the frequency, block by block."""
    blocks = []
    for size in sizes:
        spread = strength / (1 + np.arange(size)[:, None])
        blocks.append(np.rint(rng.laplace(size=(size, d)) * spread))
    starts = np.concatenate([[0], np.cumsum(sizes)])
    return np.concatenate(blocks).astype(np.int64), starts


def run(numbers, starts, terms, slack, state, buffer):
    k = len(starts) - 1
    lengths = np.array([length_of(numbers[a:b]) for a, b in itertools.pairwise(starts)])
    known = np.zeros(k, np.int64)
    memory = new_memory(k, numbers.shape[1])
    code_coefficients(numbers, starts, lengths, terms, slack, memory, state, buffer, known)
    return known


def there(numbers, starts, terms):
    state, buffer = new_encoder(), np.zeros(10**5, np.uint8)
    run(numbers.copy(), starts, terms, 0, state, buffer)
    return finished(state, buffer)


def back(data, shape, starts, terms, slack):
    numbers, buffer = np.zeros(shape, np.int64), readable(data)
    known = run(numbers, starts, terms, slack, new_decoder(buffer), buffer)
    return numbers, known


@pytest.mark.parametrize("d", [2, 3, 7])
@pytest.mark.parametrize("strength", [0.0, 3.0, 1e4, 1e9])
def test_they_come_back(d, strength):
    rng = np.random.default_rng(d)
    numbers, starts = decaying(rng, [40, 41, 1, 40], d, strength)
    terms = max(length_of(numbers[a:b]) for a, b in itertools.pairwise(starts))
    found, _ = back(there(numbers, starts, terms), numbers.shape, starts, terms, 4)
    np.testing.assert_array_equal(found, numbers)


def test_they_cost_about_their_entropy():
    """Laplace of known spreads: log2(2 e s) bits each where they are large."""
    numbers, starts = decaying(np.random.default_rng(0), [250] * 12, 3, 3000.0)
    spread = np.tile(3000.0 / (1 + np.arange(250)), 12)
    ideal = 3 * np.log2(2 * np.e * spread).sum()
    assert 0.9 * ideal < 8 * len(there(numbers, starts, 250)) < 1.03 * ideal


@pytest.mark.chapter("P66")
def test_a_beginning_gives_the_lowest_frequencies_exactly():
    numbers, starts = decaying(np.random.default_rng(1), [60, 60, 59], 3, 500.0)
    data = there(numbers, starts, 60)
    total = []
    for size in range(0, len(data), 7):
        found, known = back(data[:size], numbers.shape, starts, 60, 0)
        for b, count in enumerate(known):
            rows = slice(starts[b], starts[b] + count)
            np.testing.assert_array_equal(found[rows], numbers[rows])
        assert np.ptp(known) <= 1 + 59 * (known.min() > 40)  # a block that ended stays behind
        total.append(known.sum())
    assert (np.diff(total) >= 0).all()
    assert total[-1] > 0.9 * total.__len__()


@pytest.mark.chapter("P67")
def test_rounding_adds_a_twelfth_of_the_square_of_the_step_for_each_coefficient():
    """E86: quantising; where no coefficient is small. Dead zones make small ones 0."""
    rng = np.random.default_rng(0)
    c = rng.normal(size=(4000, 3)) * 100
    error = c - rounded(c)
    assert (error**2).mean() == pytest.approx(1 / 12, rel=0.06)
    assert abs(error).max() <= 0.6
    small = rng.uniform(-0.59, 0.59, size=(50, 3))
    assert not rounded(small)[1:].any()
    assert abs(small[0] - rounded(small)[0]).max() <= 0.5  # means have no dead zone


def test_sums_and_projections():
    rng = np.random.default_rng(0)
    U, c, x = rng.normal(size=(20, 6)), rng.normal(size=(9, 3)), rng.normal(size=(20, 3))
    out, vertices = np.zeros((30, 3)), rng.permutation(30)[:20]
    add_up(U, c, vertices, out)
    np.testing.assert_allclose(out[vertices], U @ c[:6], atol=1e-12)
    found = np.zeros((6, 3))
    project(U, x, found)
    np.testing.assert_allclose(found, U.T @ x, atol=1e-12)


def test_corrections_bring_vertices_within_the_bound():
    rng = np.random.default_rng(3)
    x = rng.normal(size=(500, 3))
    near = x + rng.normal(size=x.shape) * 0.1
    vertices, numbers, step = corrections_for(x, near, 0.2)
    off = np.linalg.norm(near - x, axis=1) > 0.2
    np.testing.assert_array_equal(vertices, np.flatnonzero(off))
    near[vertices] += step * numbers
    assert np.linalg.norm(near - x, axis=1).max() <= 0.2
    data = encode_corrections(vertices, numbers)
    found = decode_corrections(Reader(data, "x"), len(vertices), 500, 3)
    np.testing.assert_array_equal(found[0], vertices)
    np.testing.assert_array_equal(found[1], numbers)
    with pytest.raises(FileFormatError, match="vertices that are not there"):
        decode_corrections(Reader(data, "x"), len(vertices), int(vertices[-1]), 3)
    with pytest.raises(FileFormatError, match="vertices that are not there"):
        decode_corrections(Reader(data[: len(data) // 2], "x"), len(vertices), 500, 3)
