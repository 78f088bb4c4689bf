"""Something of another kind for each parameter of everything public: an answer, or one clear line.

What a function of the caller raises is the caller's; an ``OSError`` of the system is the system's.
"""

import inspect
import warnings

import numpy as np
import pytest

import beltrami as bt
from beltrami._kinds import _kind_of
from beltrami.errors import BeltramiError, MeshError
from public_calls import CALLS, SLOW
from public_scene import Scene
from recorded_calls import recording

CALLED = ("weights", "kind", "h", "f", "preconditioner", "progress", "watch")  # may be functions


def sound():
    disk = bt.shapes.disk(3, dimension=3)
    moved = np.random.default_rng(5).normal(0, 0.02, disk.vertices.shape)
    return bt.Mesh(disk.vertices + moved, disk.faces)


@pytest.fixture(scope="module")
def things():
    """Everything that a caller may mistake for something else."""
    scene = Scene(sound())
    return {
        "None": None,
        "a text": "abc",
        "two lines": "a\nb",
        "a number": 3.5,
        "a list": [1, 2],
        "a set": {1, 2},
        "a mapping": {"a": 1},
        "a function": len,
        "a class": bt.Mesh,
        "a mesh": scene.mesh,
        "a pair": scene.pair,
        "a basis": scene.basis,
        "an array": np.ones(3),
        "an object": object(),
        "bytes": b"abc",
    }


def mistaken(call, parameter, label, value):
    """Say what is wrong with the answer, if anything is."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            result = call.with_value(parameter, value)
            if inspect.isgenerator(result):
                next(result, None)
        except BeltramiError as error:
            return f"{label}: two lines" if "\n" in str(error) else ""
        except OSError:
            return ""
        except Exception as error:  # noqa: BLE001 - whatever it is, it is told
            if callable(value) and parameter in CALLED:
                return ""
            return f"{label}: {type(error).__name__}: {error}"
    return ""


@pytest.mark.parametrize("row", [name for name in CALLS if name not in SLOW])
def test_something_of_another_kind(row, things, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    scene = Scene(sound())
    with recording() as calls:
        CALLS[row](scene)
    found = {}
    for call in calls[-3:]:  # the last is what the row is about
        for parameter in call.parameters():
            wrong = [mistaken(call, parameter, *thing) for thing in things.items()]
            if any(wrong):
                found[f"{call.name}({parameter})"] = [text for text in wrong if text]
    assert found == {}


@pytest.mark.parametrize("row", [name for name in SLOW if name in CALLS])
@pytest.mark.heavy
def test_something_of_another_kind_in_slow_rows(row, things, tmp_path, monkeypatch):
    test_something_of_another_kind(row, things, tmp_path, monkeypatch)


def test_calls_are_recorded_with_all_their_parameters():
    scene = Scene(sound())
    with recording() as calls:
        CALLS["Frame.power"](scene)
    assert calls[-1].name == "Frame.power"
    assert calls[-1].parameters() == ["eigenvalues"]
    frame = next(call for call in calls if call.name == "meyer_frame")
    assert frame.parameters() == list(inspect.signature(bt.meyer_frame).parameters)
    with pytest.raises(MeshError, match=r"bound is .* where a number is needed"):
        frame.with_value("bound", scene.pair)
    assert bt.meyer_frame.__name__ == "meyer_frame"  # and all is as it was
    with recording() as again:
        pass
    assert again == []


def test_kinds_of_annotations():
    assert _kind_of("float | None") == ("float", "None")
    assert _kind_of("str | os.PathLike[str]") == ("str", "os.PathLike[str]")
    for elsewhere in (
        "str",
        "str | None",
        "Laplacian",
        "FourierBasis | None",
        "Laplacian | None",
        "ArrayLike",
        "Mesh",
    ):
        assert _kind_of(elsewhere) is None


def test_numbers_and_truth_values_of_numpy_are_of_the_kind():
    pair = bt.laplacian(sound())
    for number in (np.float32(0.5), np.int8(1), np.array(0.5), True):
        assert bt.regularize(pair, np.ones(pair.n), number).shape == (pair.n,)
    assert bt.repair(sound(), orient=np.bool_(True)).done == bt.repair(sound(), orient=True).done
    with pytest.raises(MeshError, match=r"orient is 1 where True or False is needed"):
        bt.repair(sound(), orient=1)
