import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltrami._arrays import (
    as_function,
    as_indices,
    frozen,
    read_only,
    require_finite,
    unwritten,
)
from beltrami.errors import DimensionError, MeshError, NonFiniteError


def test_read_only_marks_in_place():
    array = np.zeros(3)
    assert read_only(array) is array
    assert not array.flags.writeable


# ------------------------------------------------------------------------------ frozen


def test_what_somebody_could_write_is_copied():
    mine = np.zeros((2, 3))
    for given_array in (mine, mine[:, :], mine[::1], mine.reshape(3, 2)):
        result = frozen(given_array, np.float64)
        assert not np.shares_memory(result, mine)
        assert not result.flags.writeable
    assert mine.flags.writeable
    mine[0] = 5
    view = mine[:]
    view.flags.writeable = False  # read-only itself, but not what it looks at
    assert not np.shares_memory(frozen(view, np.float64), mine)


def test_what_nobody_can_write_is_shared():
    fixed = np.arange(6.0)
    fixed.flags.writeable = False
    assert np.shares_memory(frozen(fixed, np.float64), fixed)
    assert np.shares_memory(frozen(frozen(fixed, np.float64), np.float64), fixed)
    assert np.shares_memory(frozen(fixed.reshape(2, 3), np.float64), fixed)


def test_memory_that_is_not_numpys_is_copied():
    buffer = bytearray(np.arange(3.0).tobytes())
    view = np.frombuffer(buffer)
    view.flags.writeable = False
    result = frozen(view, np.float64)
    buffer[:8] = np.float64(9).tobytes()
    assert result.tolist() == [0, 1, 2]


@given(
    st.sampled_from(["f2", "f4", "i1", "u8", ">f8", "?"]),
    st.sampled_from(["C", "F"]),
    st.sampled_from([(0,), (3,), (2, 3), (2, 0), (2, 3, 4)]),
)
def test_type_order_and_shape(dtype, order, shape):
    given_array = np.ones(shape, dtype, order=order)
    result = frozen(given_array, np.float64)
    assert result.dtype == np.float64
    assert result.flags.c_contiguous
    assert result.shape == shape
    assert (result == 1).all()
    assert not result.flags.writeable
    assert given_array.flags.writeable


def test_reversed_and_strided_views():
    base = np.arange(10.0)
    assert frozen(base[::-2], np.float64).tolist() == [9, 7, 5, 3, 1]


# ------------------------------------------------------------------------------ functions


@pytest.mark.parametrize("f", [[1, 2, 3], np.ones((3, 2)), np.ones((3, 0)), np.ones(3, "f4")])
def test_functions_have_a_row_for_each_vertex(f):
    values = as_function(f, 3)
    assert values.dtype == np.float64
    assert values.shape == np.shape(f)


@pytest.mark.parametrize(
    "f", [np.ones(2), np.ones((2, 3)), np.ones((3, 1, 1)), np.ones((1, 3)), []]
)
def test_functions_of_the_wrong_shape(f):
    with pytest.raises(DimensionError) as caught:
        as_function(f, 3, "the heat")
    assert str(np.shape(f)) in str(caught.value)
    assert "the heat" in str(caught.value)
    assert "(3,)" in str(caught.value)


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_values_that_are_not_finite_are_named(value):
    f = np.zeros((6, 2))
    f[4, 1] = f[2, 0] = value
    with pytest.raises(NonFiniteError) as caught:
        as_function(f, 6)
    assert caught.value.vertices.tolist() == [2, 4]
    with pytest.raises(NonFiniteError) as caught:
        require_finite(f[:, 0], "the noise")
    assert caught.value.vertices.tolist() == [2]
    assert "the noise" in str(caught.value)


def test_no_vertices():
    assert as_function([], 0).shape == (0,)
    require_finite(np.zeros((0, 3)), "nothing")


def test_functions_are_not_changed():
    f = np.arange(3)
    values = as_function(f, 3)
    values[0] = 9
    assert f.tolist() == [0, 1, 2]


# ------------------------------------------------------------------------------ indices


def test_indices_and_masks():
    assert as_indices([2, 0, 2], 3, "sources").tolist() == [2, 0, 2]
    assert as_indices(1, 3, "sources").tolist() == [1]
    assert as_indices(np.array([1], np.uint8), 3, "sources").dtype == np.int64
    assert as_indices([True, False, True], 3, "sources").tolist() == [0, 2]
    assert as_indices([], 3, "sources").tolist() == []
    assert as_indices([], 3, "sources").dtype == np.int64


def test_indices_out_of_range_are_named():
    for outside in (3, -1, 10**12):
        with pytest.raises(MeshError, match=r"sources outside 0\.\.2") as caught:
            as_indices([0, outside, 2], 3, "sources")
        assert caught.value.vertices.tolist() == [outside]
    with pytest.raises(MeshError):
        as_indices(np.array([2**64 - 1], np.uint64), 3, "sources")


@pytest.mark.parametrize("wrong", [[0.0, 1.0], [True, False], ["a"], [None], [1j]])
def test_what_is_neither_indices_nor_a_mask(wrong):
    with pytest.raises(MeshError):
        as_indices(wrong, 3, "sources")


@pytest.mark.parametrize("shape", [0, 3, (0, 3), (2, 5, 3), 2**18, 2**18 + 1, (100_001, 3)])
@pytest.mark.parametrize("kind", [np.uint8, np.int32, np.float64])
def test_unwritten_arrays_are_those_of_numpy(shape, kind):
    array = unwritten(shape, kind)
    assert (array.shape, array.dtype) == (np.empty(shape).shape, kind)
    assert array.flags.c_contiguous
    assert array.flags.writeable
    assert array.flags.aligned
    array[...] = 1
    assert array.sum() == array.size
    if array.nbytes >= 2**21:
        assert array.ctypes.data % 2**21 == 0


def test_large_arrays_are_copied_once():
    mine = np.arange(600_000).reshape(-1, 3)
    kept = frozen(mine, np.int64)
    assert np.array_equal(kept, mine)
    assert not np.may_share_memory(kept, mine)
    assert np.may_share_memory(frozen(kept, np.int64), kept)
    with pytest.raises(ValueError, match="read-only"):
        kept[0] = 7
    with pytest.raises(ValueError, match="cannot set WRITEABLE"):
        kept.flags.writeable = True


@pytest.mark.parametrize("kind", [RuntimeError, TypeError])
def test_what_refuses_to_become_an_array_is_one_clear_line(kind):
    class Tensor:
        def __array__(self, dtype=None, copy=None):
            raise kind("Use tensor.detach().numpy() instead.")

    with pytest.raises(DimensionError, match=r"of type Tensor: Use tensor\.detach"):
        as_function(Tensor(), 3)


@pytest.mark.parametrize("kind", [np.uint8, np.int64])
def test_a_mask_of_zeros_and_ones_is_not_taken_for_indices(kind):
    mask = np.array([0, 1, 1, 0], kind)
    with pytest.raises(MeshError, match=r"4 zeros and ones.*astype\(bool\)"):
        as_indices(mask, 4, "held vertices")
    assert as_indices(mask.astype(bool), 4, "held vertices").tolist() == [1, 2]
    assert as_indices(mask, 5, "held vertices").tolist() == [0, 1, 1, 0]  # no mask: too short
    assert as_indices(mask, 4, "images", repeated=True).tolist() == [0, 1, 1, 0]
    assert as_indices([1, 0], 2, "held vertices").tolist() == [1, 0]  # all of both


def test_values_behind_a_mask_are_not_used():
    hidden = np.ma.masked_where([False, True, False], [1.0, 99.0, 2.0])
    with pytest.raises(NonFiniteError, match=r"filled") as caught:
        as_function(hidden, 3)
    assert caught.value.vertices.tolist() == [1]
    assert as_function(np.ma.array([1.0, 2.0]), 2).tolist() == [1, 2]  # nothing is hidden
    assert as_function(hidden.filled(0), 3).tolist() == [1, 0, 2]
