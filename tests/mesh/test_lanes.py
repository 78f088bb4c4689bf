import numpy as np
import pytest

from beltrami._jit import kernel
from beltrami.mesh.lanes import LANES, below, bits_in, first_bit, will_write


@kernel
def compared(words, start, bound):
    return below(np.uint64(words.ctypes.data) + np.uint64(8) * np.uint64(start), bound)


@kernel
def bits(mask):
    return bits_in(mask), first_bit(mask)


@kernel
def asked_for(words):
    will_write(np.uint64(words.ctypes.data))
    will_write(np.uint64(64))  # not our memory
    words[0] = 7
    return words[0]


@pytest.mark.parametrize("start", [0, 1, 5])
def test_eight_words_are_compared_as_unsigned_ones(start):
    rng = np.random.default_rng(8)
    words = rng.integers(0, 2**64, size=20, dtype=np.uint64)
    words[7], words[8] = 0, 2**64 - 1
    for bound in (0, 1, 2**63 - 1, 2**63, 2**64 - 1, *words.tolist()):
        mask = compared(words, start, np.uint64(bound))
        expected = [w < bound for w in words[start : start + LANES].tolist()]
        assert [bool(mask >> t & 1) for t in range(LANES)] == expected
        assert mask < 2**LANES


def test_bits_are_counted_and_found():
    for mask in (1, 6, 2**63, 2**64 - 1, 0b1011000):
        assert bits(np.uint64(mask)) == (mask.bit_count(), (mask & -mask).bit_length() - 1)


def test_asking_for_memory_changes_nothing():
    assert asked_for(np.zeros(3, np.uint64)) == 7
