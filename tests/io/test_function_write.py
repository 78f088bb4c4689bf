"""Functions written come back: arrays, text, neuroimaging files."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from beltrami.errors import DimensionError, FileFormatError, NonFiniteError, UnknownNameError
from beltrami.io.function import MORPHOMETRY, read_function
from beltrami.io.function_write import WRITERS, write_function, write_results

ONE = np.array([0.1, -2.5, 3e-7, 1e30])
FUNCTIONS = (ONE, np.stack([ONE, 2 * ONE, -ONE], axis=1), np.array([3, 0, -1, 7]))
EXACT = (".npy", ".txt", ".csv", ".tsv", ".dat")


@pytest.mark.parametrize("suffix", [*EXACT, ".npy.gz", ".csv.gz"])
def test_doubles_come_back_bit_for_bit(tmp_path, suffix):
    for f in FUNCTIONS:
        write_function(tmp_path / f"f{suffix}", f)
        assert np.array_equal(read_function(tmp_path / f"f{suffix}"), f)


@given(arrays(np.float64, st.integers(1, 5), elements=st.floats(allow_infinity=False)))
@settings(max_examples=30)
def test_text_holds_every_double(tmp_path_factory, f):
    place = tmp_path_factory.mktemp("t") / "f.txt"
    write_function(place, f, missing=True)
    again = read_function(place, missing=True)
    assert np.array_equal(again, f, equal_nan=True)


@pytest.mark.parametrize("suffix", [".gii", ".func.gii", ".shape.gii.gz", ".mgh", ".mgz", ".curv"])
def test_neuroimaging_files_hold_single_precision(tmp_path, suffix):
    pytest.importorskip("nibabel")
    for f in FUNCTIONS:
        place = tmp_path / f"lh{suffix}"
        if suffix in MORPHOMETRY and f.ndim == 2:
            with pytest.raises(DimensionError, match="one column"):
                write_function(place, f)
            write_function(place, f[:, :1])
            assert np.array_equal(read_function(place), f[:, 0].astype(np.float32))
        else:
            write_function(place, f)
            assert np.array_equal(read_function(place), f.astype(np.float32))


def test_declarations_of_gifti(tmp_path):
    nibabel = pytest.importorskip("nibabel")
    labels = np.array([3, 0, 3, 2**31 - 1])
    codes = nibabel.nifti1.intent_codes
    for name, intent in (("label", "LABEL"), ("shape", "SHAPE"), ("func", "NONE")):
        place = tmp_path / f"a.{name}.gii"
        write_function(place, labels)
        image = nibabel.load(place)
        assert image.darrays[0].intent == codes[f"NIFTI_INTENT_{intent}"]
        assert image.darrays[0].data.dtype == np.int32
        assert np.array_equal(read_function(place), labels)  # in single precision 2³¹ would be
        table = {one.key: one.label for one in image.labeltable.labels}
        assert (table == {0: "0", 3: "3", 2**31 - 1: str(2**31 - 1)}) == (name == "label")
    for wrong in (ONE, np.array([2**31]), np.array([2**64 - 1], np.uint64)):
        with pytest.raises(DimensionError, match="labels"):
            write_function(tmp_path / "b.label.gii", wrong)
    assert not (tmp_path / "b.label.gii").exists()


@pytest.mark.parametrize("suffix", WRITERS)
def test_missing_values_are_written_and_read_when_asked(tmp_path, suffix):
    if suffix != ".npy":
        pytest.importorskip("nibabel")
    f = np.array([1.5, np.nan, 2.5])
    place = tmp_path / f"f{suffix}"
    with pytest.raises(NonFiniteError, match="missing=True") as caught:
        write_function(place, f)
    assert caught.value.vertices.tolist() == [1]
    assert not place.exists()
    write_function(place, f, missing=True)
    with pytest.raises(FileFormatError, match="missing=True"):
        read_function(place)
    assert np.array_equal(read_function(place, missing=True), f, equal_nan=True)


def test_infinity_is_never_missing(tmp_path):
    for suffix in (".npy", ".txt"):
        with pytest.raises(NonFiniteError):
            write_function(tmp_path / f"f{suffix}", [np.inf, np.nan], missing=True)
    np.save(tmp_path / "f.npy", [np.inf, np.nan])
    (tmp_path / "f.txt").write_text("inf\nnan\n")
    for name in ("f.npy", "f.txt"):
        with pytest.raises(FileFormatError, match="inf"):
            read_function(tmp_path / name, missing=True)


def test_too_large_for_32_bits(tmp_path):
    pytest.importorskip("nibabel")
    write_function(tmp_path / "f.npy", [1e300])
    for suffix in (".gii", ".mgh", ".curv"):
        with pytest.raises(NonFiniteError, match="too large"):
            write_function(tmp_path / f"f{suffix}", [1e300])


@pytest.mark.parametrize("f", [[], np.zeros((2, 2, 2)), 3.0, ["a"], np.zeros((3, 0))])
def test_what_is_no_function(tmp_path, f):
    with pytest.raises(DimensionError):
        write_function(tmp_path / "f.npy", f)
    with pytest.raises(UnknownNameError, match=r"\.npy"):
        write_function(tmp_path / "f.xyz", ONE)


def test_a_name_that_tells_no_format_and_regions(tmp_path):
    nibabel = pytest.importorskip("nibabel")
    write_function(tmp_path / "lh.curv", ONE)
    (tmp_path / "lh.curv").rename(tmp_path / "lh.jacobian_white")
    with pytest.raises(UnknownNameError):
        read_function(tmp_path / "lh.jacobian_white")
    found = read_function(tmp_path / "lh.jacobian_white", format="curv")
    assert np.array_equal(found, ONE.astype(np.float32))
    regions = np.array([1, 0, -1, 1])
    table = np.array([[10, 20, 30, 0, 1], [40, 50, 60, 0, 2]])
    place = tmp_path / "lh.aparc.annot"
    nibabel.freesurfer.write_annot(place, regions, table, ["a", "b"], fill_ctab=True)
    assert read_function(place).tolist() == regions.tolist()


@pytest.mark.parametrize("suffix", [".npy", ".txt", ".csv"])
def test_results_may_be_infinite_but_not_missing(tmp_path, suffix):
    write_results(tmp_path / f"d{suffix}", [0.5, np.inf])
    load = np.load if suffix == ".npy" else np.loadtxt
    assert load(tmp_path / f"d{suffix}").tolist() == [0.5, np.inf]
    with pytest.raises(NonFiniteError):
        write_results(tmp_path / "f.npy", [np.nan])
    with pytest.raises(NonFiniteError):
        write_function(tmp_path / "f.npy", [0.5, np.inf])
