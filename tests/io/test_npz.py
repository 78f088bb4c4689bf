import io
import json
import pickle
import zipfile

import numpy as np
import pytest

from beltrami.errors import FileFormatError
from beltrami.io import npz
from beltrami.io.npz import read_arrays, write_arrays

ARRAYS = {
    "a": np.arange(6.0).reshape(2, 3),
    "b": np.asfortranarray(np.arange(6.0).reshape(2, 3)),
    "c": np.arange(5, dtype=np.int32),
    "d": np.zeros((0, 4)),
    "e": np.array(True),
}


@pytest.fixture
def place(tmp_path):
    path = tmp_path / "some.arrays"
    write_arrays(path, "sample", 3, ARRAYS)
    return path


def test_round_trip(place):
    found = read_arrays(place, "sample", 3)
    assert sorted(found) == sorted(ARRAYS)
    for name, array in ARRAYS.items():
        assert np.array_equal(found[name], array)
        assert found[name].dtype == array.dtype
        assert found[name].flags.f_contiguous == array.flags.f_contiguous
        if array.size:
            with pytest.raises(ValueError, match="read-only"):
                found[name][...] = 0


def test_the_same_arrays_give_the_same_bytes(place, tmp_path):
    other = tmp_path / "other.npz"
    write_arrays(other, "sample", 3, dict(reversed(ARRAYS.items())))
    assert other.read_bytes() == place.read_bytes()
    strided = {**ARRAYS, "a": np.arange(12.0).reshape(2, 6)[:, ::2] / 2}
    write_arrays(other, "sample", 3, strided)
    assert other.read_bytes() == place.read_bytes()


def test_numpy_reads_it(place):
    with np.load(place) as file:
        assert np.array_equal(file["b"], ARRAYS["b"])
        assert json.loads(str(file["header"]))["version"] == 3


def test_another_kind_or_version(place):
    with pytest.raises(FileFormatError, match="expected a basis, found 'sample'"):
        read_arrays(place, "basis", 3)
    with pytest.raises(FileFormatError, match=r"expected version 2 .* found 3"):
        read_arrays(place, "sample", 2)


def test_no_such_file(tmp_path):
    with pytest.raises(FileNotFoundError):
        read_arrays(tmp_path / "none.npz", "sample", 3)
    with pytest.raises(FileFormatError, match="directory"):
        read_arrays(tmp_path, "sample", 3)
    with pytest.raises(OSError, match="none"):
        write_arrays(tmp_path / "none" / "a.npz", "sample", 3, ARRAYS)


def test_an_old_file_stays_when_writing_fails(place, monkeypatch):
    before = place.read_bytes()

    def broken(file, **_):
        file.write(b"half")
        raise KeyboardInterrupt

    monkeypatch.setattr(npz.np, "savez", broken)
    with pytest.raises(KeyboardInterrupt):
        write_arrays(place, "sample", 3, {})
    assert place.read_bytes() == before
    assert [path.name for path in place.parent.iterdir()] == [place.name]


STEPS = [11, pytest.param(1, marks=pytest.mark.heavy)]


@pytest.mark.parametrize("step", STEPS)
def test_every_cut_is_noticed(place, step):
    content = place.read_bytes()
    for end in range(0, len(content), step):
        place.write_bytes(content[:end])
        with pytest.raises(FileFormatError):
            read_arrays(place, "sample", 3)


@pytest.mark.parametrize("step", STEPS)
def test_every_changed_byte_is_noticed_or_harmless(place, step):
    content = place.read_bytes()
    rng = np.random.default_rng(602)
    noticed = 0
    for position in range(0, len(content), step):
        changed = bytearray(content)
        changed[position] ^= int(rng.integers(1, 256))
        place.write_bytes(changed)
        try:
            found = read_arrays(place, "sample", 3)
        except FileFormatError:
            noticed += 1
            continue
        assert all(np.array_equal(found[name], ARRAYS[name]) for name in ARRAYS)
    assert noticed > 0.6 * len(content) / step  # the rest are dates, permissions and the like


@pytest.mark.parametrize("seed", range(60))
def test_longer_damage(place, seed):
    rng = np.random.default_rng(seed)
    content = bytearray(place.read_bytes())
    at, length = rng.integers(len(content)), rng.integers(1, 60)
    middle = rng.integers(0, 256, length).astype(np.uint8).tobytes()
    place.write_bytes(content[:at] + middle + content[at + int(rng.integers(0, 60)) :])
    try:
        found = read_arrays(place, "sample", 3)
    except FileFormatError:
        return
    assert all(np.array_equal(found[name], ARRAYS[name]) for name in ARRAYS)


class _Evil:
    def __reduce__(self):
        return (pytest.fail, ("a pickle was executed",))


@pytest.mark.parametrize(
    "content",
    [b"", b"not a zip file", b"\x93NUMPY", pickle.dumps(_Evil()), b"PK\x05\x06" + 18 * b"\0"],
)
def test_foreign_files(place, content):
    place.write_bytes(content)
    with pytest.raises(FileFormatError):
        read_arrays(place, "sample", 3)


def _member(array):
    file = io.BytesIO()
    np.lib.format.write_array(file, np.asarray(array), allow_pickle=True)
    return file.getvalue()


def _zip(members, compression=zipfile.ZIP_STORED):
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", compression) as archive:
        for name, content in members:
            archive.writestr(name, content)
    return file.getvalue()


def _promises(shape, descr="<f8"):
    """A member whose header promises more than there is."""
    file = io.BytesIO()
    header = {"descr": descr, "fortran_order": False, "shape": shape}
    np.lib.format.write_array_header_1_0(file, header)
    return file.getvalue() + 16 * b"\0"


@pytest.mark.parametrize(
    "members",
    [
        [("a.npy", _member(np.array([_Evil()], dtype=object)))],
        [("header.npy", _member(np.array(_Evil(), dtype=object)))],
        [("header.npy", _member(np.array("{}")))],
        [("header.npy", _member(np.array("[[[")))],
        [("header.npy", _member(np.array("[" * 100_000)))],
        [("header.npy", _member(np.zeros(0)))],
        [("a.npy", _promises((10**15,)))],
        [("a.npy", _promises((2**40, 2**40)))],
        [("a.npy", _promises((0, 2)))],
        [("a.npy", _promises((2,), "|V8"))],
        [("a.npy", _promises((2,), "|S8"))],
        [("a.npy", _promises((2,), "<M8[s]"))],
        [("a.npy", _promises((10**17,), "|V0"))],
        [("a.npy", b"no array")],
        [("../a.npy", b"")],
    ],
)
def test_crafted_members(place, members):
    place.write_bytes(_zip(members))
    with pytest.raises(FileFormatError) as caught:
        read_arrays(place, "sample", 3)
    assert caught.value.path == str(place)


def test_compressed_and_doubled_members(place):
    header = {"kind": "sample", "version": 3, "sha256": npz._digest({})}
    good = ("header.npy", _member(np.array(json.dumps(header))))
    place.write_bytes(_zip([good]))
    assert read_arrays(place, "sample", 3) == {}
    place.write_bytes(_zip([good], zipfile.ZIP_DEFLATED))
    with pytest.raises(FileFormatError):
        read_arrays(place, "sample", 3)
    bomb = ("a.npy", bytes(10_000_000))
    place.write_bytes(_zip([good, bomb], zipfile.ZIP_DEFLATED))
    with pytest.raises(FileFormatError, match="longer than the file"):
        read_arrays(place, "sample", 3)
    with pytest.warns(UserWarning, match="Duplicate"):
        place.write_bytes(_zip([good, good]))
    with pytest.raises(FileFormatError, match="twice"):
        read_arrays(place, "sample", 3)
