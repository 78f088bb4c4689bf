"""The tables are what their formulas say, to the last unit, and never change."""

import hashlib

import numpy as np

from beltrami.compression.tables import CELLS, LN, REACH, SQUASH, STRETCH, TAILS, UNIT, WHOLE


def test_squash_is_the_logistic_function():
    logits = np.arange(-REACH, REACH + 1) / UNIT
    exact = np.clip(65536 / (1 + np.exp(-logits)), 1, 65535)
    assert abs(SQUASH - exact).max() < 1
    assert (np.diff(SQUASH) >= 0).all()
    assert (SQUASH[:REACH] + SQUASH[:REACH:-1] == 65536).all()  # neither bit is favoured


def test_stretch_inverts_squash():
    p = (np.arange(4096) + 0.5) / 4096
    logits = UNIT * np.log(p / (1 - p))
    inner = abs(logits) < 5 * UNIT
    assert abs(STRETCH - logits)[inner].max() <= 3
    assert (np.diff(STRETCH) >= 0).all()


def test_tails_and_logarithms():
    z = np.arange(TAILS.shape[1]) / CELLS
    assert abs(TAILS[0] - WHOLE / (1 + np.exp(z))).max() < 1.01
    assert abs(TAILS[1] - WHOLE / 2 * np.exp(-z)).max() < 1.01
    assert abs(LN - 65536 * np.log1p(np.arange(1025) / 1024)).max() < 1.01


def test_the_tables_are_those_of_the_format():
    """One other number in them, and old files would decode to something else."""
    data = b"".join(t.astype("<i8").tobytes() for t in (SQUASH, STRETCH, TAILS, LN))
    assert (
        hashlib.sha256(data).hexdigest()
        == "3fabcbddd7e76378150e3788df99f96db2bcbd92197785b79a4a8ce6f0a0d5c3"
    )
