"""dft and idft against sums written out, in each convention."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

import beltrami as bt
from beltrami.errors import DimensionError, NonFiniteError, UnknownNameError
from beltrami.grids.transform import CONVENTIONS, dft, idft


def written_out(f, convention):
    """The sum over all k, for each ω: factor and sign as in the table."""
    sign = 1 if convention == "text" else -1
    factor = {"text": 1 / f.size, "unitary": f.size**-0.5, "numpy": 1}[convention]
    out = f.astype(complex)
    for a, p in enumerate(f.shape):
        k = np.arange(p)
        wave = np.exp(sign * 2j * np.pi * np.outer(k, k) / p)
        out = np.moveaxis(np.tensordot(wave, out, (1, a)), 0, a)
    return factor * out


@pytest.mark.chapter("D12", "P27")
@pytest.mark.parametrize("convention", CONVENTIONS)
@pytest.mark.parametrize("shape", [(1,), (2,), (7,), (16,), (3, 4), (5, 5), (2, 3, 5)])
def test_against_the_sum(shape, convention):
    rng = np.random.default_rng(314)
    for f in (rng.normal(size=shape), rng.normal(size=shape) + 1j * rng.normal(size=shape)):
        assert np.allclose(dft(f, convention), written_out(f, convention), atol=1e-13)
        assert np.allclose(idft(dft(f, convention), convention), f, atol=1e-13)
        others = [c for c in CONVENTIONS if c != convention]
        if f.size > 2:
            assert all(np.abs(idft(dft(f, convention), c) - f).max() > 0.1 for c in others)


@st.composite
def functions(draw):
    shape = draw(arrays.array_shapes(min_dims=1, max_dims=3, max_side=9))
    rng = np.random.default_rng(draw(st.integers(0, 2**32)))
    kind = draw(st.sampled_from(["float", "complex", "integer", "bool"]))
    f = rng.normal(size=shape)
    if kind == "complex":
        return f + 1j * rng.normal(size=shape)
    return {"float": f, "integer": np.rint(5 * f).astype(int), "bool": f > 0}[kind]


@pytest.mark.chapter("D12")
@given(functions(), st.sampled_from(CONVENTIONS))
def test_round_trips(f, convention):
    scale = 1 + np.abs(f).max()
    assert np.abs(idft(dft(f, convention), convention) - f).max() < 1e-13 * scale
    assert np.abs(dft(idft(f, convention), convention) - f).max() < 1e-13 * scale
    ratio = {"text": 1 / f.size, "unitary": 1, "numpy": f.size}[convention]
    f = f.astype(complex)
    energy = np.vdot(dft(f, convention), dft(f, convention)).real
    assert energy == pytest.approx(ratio * np.vdot(f, f).real, rel=1e-12)  # Parseval


def test_input_is_left_alone_and_names_are_public():
    f = np.arange(6.0).reshape(2, 3)
    f.flags.writeable = False
    assert bt.dft(f).dtype == np.complex128
    assert np.allclose(bt.idft(bt.dft(f.tolist())), f)
    mine = np.ones(4, complex)
    dft(mine)[0] = 9
    assert (mine == 1).all()


def test_bad_input():
    with pytest.raises(UnknownNameError) as caught:
        dft([1.0], "ortho")
    assert caught.value.choices == CONVENTIONS
    for wrong in (3.0, [], [[1, 2], [3]], ["a"], [None]):
        with pytest.raises(DimensionError):
            dft(wrong)
    with pytest.raises(NonFiniteError) as caught:
        idft([[1, 2], [np.nan, 1j * np.inf]])
    assert caught.value.vertices.tolist() == [2, 3]
    with pytest.raises(NonFiniteError, match="scale it down"):
        dft(np.full(8, 1e308), "numpy")
