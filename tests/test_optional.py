import sys

import pytest

from beltrami._optional import require
from beltrami.errors import MissingExtraError


def test_a_package_that_is_there_is_returned():
    assert require("json", "io", "reading").loads("[1]") == [1]
    assert require("os.path", "io", "reading") is sys.modules["os.path"]


def test_a_package_that_is_not_there_names_its_extra():
    with pytest.raises(MissingExtraError) as caught:
        require("no_such_package_anywhere", "view", "the window")
    assert (caught.value.package, caught.value.extra) == ("no_such_package_anywhere", "view")
    assert "the window needs" in str(caught.value)
    assert "pip install 'beltrami[view]'" in str(caught.value)
    assert isinstance(caught.value, ImportError)
    assert isinstance(caught.value.__cause__, ModuleNotFoundError)


def test_a_package_that_is_blocked(monkeypatch):
    monkeypatch.setitem(sys.modules, "json", None)
    with pytest.raises(MissingExtraError):
        require("json", "io", "reading")


def test_other_errors_of_a_package_are_not_hidden(tmp_path, monkeypatch):
    (tmp_path / "broken_package_of_this_test.py").write_text("1 / 0")
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(ZeroDivisionError):
        require("broken_package_of_this_test", "io", "reading")
