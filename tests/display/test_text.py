import pytest

from beltrami.display.text import load_font, plain, wrapped
from beltrami.errors import MeshError


def test_what_the_font_lacks_is_spelled_out():
    assert plain("a-Z 0~!\n") == "a-Z 0~!\n"
    assert plain("λ₂ ≤ 2 Δφ − é × ά ς") == "lambda2 <= 2 Deltaphi - e x alpha sigma"
    assert plain("網") == "?"


def test_ascii_is_in_the_bundled_font():
    font = load_font(None, 20)
    box = bytes(font.getmask("\ue123"))
    for character in map(chr, range(33, 127)):
        assert bytes(font.getmask(character)) != box


def test_lines_fit_where_words_allow():
    font = load_font(None, 20)
    text = wrapped("the quick brown fox jumps over the lazy dog\nand sleeps", font, 150)
    lines = text.split("\n")
    assert all(font.getlength(line) <= 150 for line in lines)
    assert " ".join(lines) == "the quick brown fox jumps over the lazy dog and sleeps"
    assert "and sleeps" in lines  # the line end of the user is kept
    assert len(lines) < 6
    assert wrapped("incomprehensibilities", font, 20) == "incomprehensibilities"


def test_what_is_no_font_is_refused(tmp_path):
    (tmp_path / "a.ttf").write_bytes(b"no font")
    for path in (tmp_path / "a.ttf", tmp_path / "missing.ttf"):
        with pytest.raises(MeshError, match=path.name):
            load_font(path, 12)
