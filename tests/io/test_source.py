"""Source: the blocks of a text file are whole lines, and all of it."""

import numpy as np
import pytest

from beltrami.errors import FileFormatError
from beltrami.io import source as module
from beltrami.io.obj import read_obj
from beltrami.io.source import Source, load


def in_memory(text):
    return Source("a.obj", np.frombuffer(text, np.uint8))


def on_disk(tmp_path, text):
    path = tmp_path / "a.obj"
    path.write_bytes(text)
    return load(path)


def obj_text(rng, vertices, faces):
    """A triangle soup with comments, continued lines and ends of lines of two kinds."""
    lines = []
    for x in rng.normal(size=(vertices, 3)):
        blank = rng.choice([b" ", b"   ", b" \\\n ", b" \\   \r\n "])
        lines.append(blank.join([b"v", *(b"%.*g" % (int(rng.integers(1, 17)), c) for c in x)]))
    for face in rng.integers(1, vertices + 1, size=(faces, 3)):
        blank = rng.choice([b" ", b" \\\n"])
        lines.append(b"f " + blank.join(b"%d" % i for i in face))
        if rng.random() < 0.1:
            lines.append(b"# " + b"long " * rng.integers(200))
    return b"".join(line + rng.choice([b"\n", b"\r\n"]) for line in lines)


@pytest.mark.parametrize("block", [1, 7, 64, 1000, 1 << 20])
def test_reading_in_blocks_is_reading_at_once(tmp_path, monkeypatch, block):
    monkeypatch.setattr(module, "_BLOCK", block)
    rng = np.random.default_rng(block)
    text = obj_text(rng, 40, 60)
    source = on_disk(tmp_path, text)
    pieces = [(start, bytes(piece)) for start, piece in source.blocks()]
    assert b"".join(piece for _, piece in pieces) == text
    assert [start for start, _ in pieces] == np.cumsum([0, *(len(p) for _, p in pieces)])[
        :-1
    ].tolist()
    assert (len(pieces) > 3) == (block <= 1000)
    for _, piece in pieces:
        assert piece.endswith(b"\n")
        assert not piece.rstrip().endswith(b"\\")
    whole, parts = read_obj(in_memory(text)), read_obj(source)
    assert np.array_equal(whole.vertices, parts.vertices)
    assert np.array_equal(whole.faces, parts.faces)


@pytest.mark.parametrize("block", [16, 64, 1 << 20])
def test_a_fault_is_named_with_its_line_in_the_file(tmp_path, monkeypatch, block):
    monkeypatch.setattr(module, "_BLOCK", block)
    text = b"v 0 0 0\n" * 50 + b"f 1 2 3\n" * 20 + b"f 1 two 3\n" + b"f 1 2 3\n" * 20
    with pytest.raises(FileFormatError, match=r"line 71: .*'two'"):
        read_obj(on_disk(tmp_path, text))


def test_the_last_line_needs_no_end(tmp_path, monkeypatch):
    monkeypatch.setattr(module, "_BLOCK", 8)
    mesh = read_obj(on_disk(tmp_path, b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3"))
    assert mesh.faces.tolist() == [[0, 1, 2]]


def test_what_cannot_be_opened_is_known_when_it_is_loaded(tmp_path):
    with pytest.raises(FileNotFoundError):
        load(tmp_path / "none.obj")
