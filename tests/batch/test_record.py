import json
import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from beltrami.batch.pipeline import as_pipeline
from beltrami.batch.record import Problem, Record, decoded
from beltrami.batch.store import Kept

PIPELINE = as_pipeline("integrate, spectrum k=3")
KEY = "ab" * 32
FILE = Kept("files/cd/" + "cd" * 32 + ".npz", "cd" * 32, 99)
RECORD = Record(
    KEY,
    {"sha256": "ef" * 32, "bytes": 7, "suffix": ".ply"},
    PIPELINE.plain,
    {"beltrami": "1"},
    {"integrate.area": 2.0, "spectrum.eigenvalues": [0.0, 1.5, 0.1 + 0.2]},
    {"spectrum": FILE},
    {"reading": 0.25},
    None,
    "2026-01-01T00:00:00+00:00",
)


def changed(**parts):
    return json.dumps(json.loads(RECORD.encoded()) | parts).encode()


def test_a_record_reads_back_bit_for_bit():
    assert decoded(RECORD.encoded(), KEY, PIPELINE) == RECORD
    failed = Record(*list(vars(RECORD).values())[:7], Problem("MeshError", "é\n", "spectrum"))
    assert decoded(failed.encoded(), KEY, PIPELINE) == failed
    assert (RECORD.outcome, failed.outcome) == ("done", "failed")


def test_numbers_that_json_does_not_know_are_null():
    row = {"integrate.area": math.nan, "spectrum.eigenvalues": [math.inf, 1.0]}
    content = Record(*list(vars(RECORD).values())[:4], row).encoded()
    assert decoded(content, KEY, PIPELINE).row == {
        "integrate.area": None,
        "spectrum.eigenvalues": [None, 1.0],
    }


@pytest.mark.parametrize(
    "content",
    [
        None,
        b"",
        RECORD.encoded()[:-1],
        RECORD.encoded()[:40],
        b"\xff" + RECORD.encoded(),
        b"[" * 100_000,
        b"3",
        changed(format=2),
        changed(key="cd" * 32),
        changed(outcome="failed"),
        changed(more=1),
        changed(row={"integrate.area": "2"}),
        changed(row={"integrate.area": [2.0]}),
        changed(row={"other": 2.0}),
        changed(row=3),
        changed(files={"spectrum": {"name": "../x", "sha256": "", "bytes": 1}}),
        changed(files={"spectrum": {"name": FILE.name, "sha256": "", "bytes": "1"}}),
        changed(files={"spectrum": vars(FILE) | {"sha256": "ef" * 32}}),
        changed(files={"other": vars(FILE)}),
        changed(files={"spectrum": vars(FILE) | {"path": "/etc"}}),
        changed(error={"kind": "a", "message": 3, "step": ""}, outcome="failed"),
        changed(input={"sha256": 3, "bytes": 7}),
        changed(input={}),
        changed(seconds={"reading": "long"}),
        changed(seconds={"reading": 10**400}),
        changed(seconds={"reading": None}),
        changed(seconds={"\ud800": 1}),
        changed(finished=3),
        changed(finished="\ud800"),
        changed(versions=3),
        changed(row={"integrate.area": 10**400}),
        changed(error={"kind": "a", "message": "\ud800", "step": ""}, outcome="failed"),
    ],
)
def test_a_record_that_is_not_whole_or_not_valid_is_none(content):
    assert decoded(content, KEY, PIPELINE) is None


def test_a_record_of_other_work_is_none():
    assert decoded(RECORD.encoded(), "cd" * 32, PIPELINE) is None
    assert decoded(RECORD.encoded(), KEY, as_pipeline("diagnose")) is None


@given(st.integers(0, len(RECORD.encoded()) - 1), st.binary(min_size=1, max_size=3))
def test_damaged_bytes_never_raise(where, bytes_):
    content = RECORD.encoded()
    decoded(content[:where] + bytes_ + content[where + len(bytes_) :], KEY, PIPELINE)


@settings(max_examples=25)
@given(
    st.recursive(
        st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=4),
        lambda inner: (
            st.lists(inner, max_size=3)
            | st.dictionaries(st.sampled_from(list(vars(RECORD))), inner)
        ),
    )
)
def test_other_json_never_raises(thing):
    decoded(json.dumps(thing).encode(), KEY, PIPELINE)
