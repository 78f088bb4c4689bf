"""Bits, numbers and mixed bits: what goes in comes out, in about as many bits as it must."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltrami._jit import kernel
from beltrami.compression.mixing import code_mixed, new_mixer
from beltrami.compression.range_coder import (
    code,
    code_number,
    code_uniform,
    finished,
    new_decoder,
    new_encoder,
    new_number_model,
    ran_dry,
    readable,
)
from beltrami.compression.tables import REACH, SQUASH, STRETCH


@kernel
def run_bits(bits, chances, state, buffer):
    for i in range(bits.size):
        bits[i] = code(bits[i], chances[i], state, buffer)


@kernel
def run_numbers(numbers, counts, model, state, buffer):
    for i in range(numbers.size):
        if counts[i] > 0:
            numbers[i] = code_uniform(numbers[i], counts[i], state, buffer)
        else:
            numbers[i] = code_number(numbers[i], model, state, buffer)


@kernel
def run_mixed(bits, contexts, opinions, mixer, state, buffer):
    for i in range(bits.size):
        mixer.logits[0] = opinions[i]
        mixer.contexts[0] = contexts[i]
        mixer.contexts[1] = contexts[i] % 4
        bits[i] = code_mixed(bits[i], contexts[i] % 2, 0, 655, mixer, state, buffer)


def there_and_back(values, run):
    """Write the values with ``run(values, state, buffer)``, read them; return the bytes."""
    buffer, state = np.zeros(20 * len(values) + 64, np.uint8), new_encoder()
    run(values.copy(), state, buffer)
    data = finished(state, buffer)
    read, bytes_read = np.zeros_like(values), readable(data)
    state = new_decoder(bytes_read)
    run(read, state, bytes_read)
    assert read.tolist() == values.tolist()
    assert not ran_dry(state, bytes_read)
    return data


@given(st.lists(st.tuples(st.integers(0, 1), st.integers(1, 65535)), max_size=300))
def test_bits_come_back_whatever_their_probability(pairs):
    bits = np.array([bit for bit, _ in pairs], np.int64)
    chances = np.array([p for _, p in pairs], np.int64)
    data = there_and_back(bits, lambda b, s, d: run_bits(b, chances, s, d))
    ideal = sum(-np.log2(p / 65536 if bit else 1 - p / 65536) for bit, p in pairs)
    assert len(data) <= ideal / 8 * 1.01 + 5


def test_the_length_is_the_entropy():
    rng = np.random.default_rng(1)
    bits = (rng.random(80_000) < 0.03).astype(np.int64)
    chances = np.full(len(bits), int(0.03 * 65536))
    data = there_and_back(bits, lambda b, s, d: run_bits(b, chances, s, d))
    p = bits.mean()
    entropy = -(p * np.log2(p) + (1 - p) * np.log2(1 - p)) * len(bits) / 8
    assert len(data) == pytest.approx(entropy, rel=0.005)


@given(st.lists(st.tuples(st.integers(0, 2**36), st.integers(0, 2**38)), max_size=60))
def test_numbers_come_back(pairs):
    numbers = np.array([min(v, max(c - 1, 0)) if c else v for v, c in pairs], np.int64)
    counts = np.array([c for _, c in pairs], np.int64)
    there_and_back(numbers, lambda v, s, d: run_numbers(v, counts, new_number_model(), s, d))


def test_equally_likely_numbers_cost_their_logarithm():
    rng = np.random.default_rng(2)
    counts = np.full(5000, 1000)
    numbers = rng.integers(1000, size=5000)
    data = there_and_back(numbers, lambda v, s, d: run_numbers(v, counts, new_number_model(), s, d))
    assert len(data) == pytest.approx(5000 * np.log2(1000) / 8, rel=0.002)


def mixer():
    return new_mixer(1, 2, 64, (2, 1), trust=(200, 300), limit=60)


def test_mixed_bits_come_back_and_are_learned():
    rng = np.random.default_rng(3)
    contexts = rng.integers(64, size=20_000)
    chance = rng.random(64) ** 3
    bits = (rng.random(20_000) < chance[contexts]).astype(np.int64)
    opinions = rng.integers(-2000, 2000, 20_000)  # worth nothing: to be ignored
    data = there_and_back(bits, lambda b, s, d: run_mixed(b, contexts, opinions, mixer(), s, d))
    p = np.clip(chance[contexts], 1e-4, 1 - 1e-4)
    ideal = -(bits * np.log2(p) + (1 - bits) * np.log2(1 - p)).sum() / 8
    assert ideal * 0.98 < len(data) < ideal * 1.07


def test_mixing_in_plain_python():
    """The kernel against its formulas, with Python's integers."""
    rng = np.random.default_rng(4)
    bits, contexts = rng.integers(2, size=300), rng.integers(64, size=300)
    opinions = rng.integers(-900, 900, 300)
    ours, buffer = mixer(), np.zeros(4000, np.uint8)
    run_mixed(bits.copy(), contexts, opinions, ours, new_encoder(), buffer)
    plain = mixer()
    for bit, context, opinion in zip(bits.tolist(), contexts.tolist(), opinions, strict=True):
        where = [context, context % 4]
        x = [int(opinion), *(int(STRETCH[plain.chance[e, where[e]] >> 10]) for e in (0, 1)), 80]
        for weights in (plain.first[context % 2], plain.second[0]):
            z = (sum(int(w) * v for w, v in zip(weights, x, strict=True)) + 2**19) >> 20
            error = 65536 * bit - int(SQUASH[min(max(z, -REACH), REACH) + REACH])
            for e in range(4):
                step = (x[e] * error * 655 + 2**19) >> 20
                weights[e] = min(max(int(weights[e]) + step, -(2**26)), 2**26)
        for e in (0, 1):
            goal, seen = (2**22 - 1) * bit, plain.seen[e, where[e]]
            old = int(plain.chance[e, where[e]])
            plain.chance[e, where[e]] = old + ((goal - old) * int(plain.rates[seen]) >> 16)
            plain.seen[e, where[e]] = min(seen + 1, 1023)
    for name in ("chance", "seen", "first", "second"):
        np.testing.assert_array_equal(getattr(ours, name), getattr(plain, name), err_msg=name)


def test_what_does_not_fit_is_told():
    bits = np.ones(100, np.int64)
    buffer, state = np.zeros(3, np.uint8), new_encoder()
    run_bits(bits, np.full(100, 500), state, buffer)
    assert finished(state, buffer) is None


def test_reading_beyond_the_end_is_told():
    buffer = readable(b"\x12")
    state = new_decoder(buffer)
    run_bits(np.zeros(1000, np.int64), np.full(1000, 32768), state, buffer)
    assert ran_dry(state, buffer)
