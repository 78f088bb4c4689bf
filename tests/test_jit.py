"""Kernels compile and run wherever they are, also where nothing can be cached."""

import os
import subprocess
import sys
import textwrap

import numba
import numpy as np
import pytest

from beltrami import _jit
from beltrami._jit import kernel, part_of_kernels, plain_kernel, unsigned

USE = """
    from beltrami.mesh.shapes import icosphere
    mesh = icosphere(1)
    print(mesh.euler_characteristic, len(mesh.boundary_loops), round(mesh.area, 6))
"""


def run(code, **environment):
    env = {**os.environ, **environment}
    command = [sys.executable, "-W", "error", "-c", textwrap.dedent(code)]
    return subprocess.run(command, env=env, capture_output=True, text=True, check=False)


def add(a, b):
    return a + b


def test_a_kernel_gives_what_python_gives():
    x = np.random.default_rng(66123871).normal(size=7)
    assert np.array_equal(kernel(add)(x, 2.0), add(x, 2.0))


def first_of_two_rows(x):
    row = x[0]
    return row[1] + x[1, 0]


def test_a_plain_kernel_views_arrays_and_cannot_make_them():
    x = np.arange(6.0).reshape(2, 3)
    assert plain_kernel(first_of_two_rows)(x) == first_of_two_rows(x)
    assert sys.getrefcount(x) == 2
    with pytest.raises(numba.errors.NumbaError):
        plain_kernel(add)(x, 2.0)


@part_of_kernels
def larger(a, b):
    return a if a > b else b


def largest_of_three(a, b, c):
    return larger(larger(a, b), c)


def test_a_part_of_kernels_is_called_by_kernels_and_stays_plain_for_python():
    assert kernel(largest_of_three)(2.0, 5.0, 3.0) == largest_of_three(2.0, 5.0, 3.0) == 5.0
    assert larger.__globals__ is globals()


def all_but_the_first(x):
    return x[1:]


def share(a, b):
    return a / b


def test_a_plain_kernel_cannot_return_a_view_and_may_raise():
    """Nobody would count who holds the view; an error needs no memory of its own."""
    with pytest.raises(numba.errors.NumbaError, match="returning of array"):
        plain_kernel(all_but_the_first)(np.arange(4.0))
    with pytest.raises(ZeroDivisionError):
        plain_kernel(share)(1.0, 0.0)


def test_without_the_option_a_plain_kernel_is_a_kernel(monkeypatch):
    honest = numba.njit

    def old(**options):
        if "_nrt" in options:
            raise KeyError("Unrecognized options")
        return honest(**options)

    monkeypatch.setattr(numba, "njit", old)
    assert plain_kernel(first_of_two_rows)(np.ones((2, 3))) == 2


def test_kernels_release_the_gil_and_do_not_reorder_arithmetic():
    options = kernel(add).targetoptions
    assert options.get("nogil") is True
    assert not options.get("fastmath")
    assert not options.get("parallel")


def test_a_function_that_has_no_file_cannot_be_cached_and_works():
    space = {}
    exec("def twice(x):\n    return 2 * x", space)  # noqa: S102 - a function without a file
    with pytest.raises(RuntimeError, match="cannot cache"):
        numba.njit(cache=True)(space["twice"])
    assert kernel(space["twice"])(21) == 42


def test_folders_that_cannot_be_written_are_no_error(monkeypatch):
    """numba tries a folder by a temporary file; here no folder can be written."""

    def refuse(*args, **kwargs):
        raise PermissionError("read-only file system")

    monkeypatch.setattr("tempfile.TemporaryFile", refuse)
    monkeypatch.setattr("os.makedirs", refuse)
    with pytest.raises(RuntimeError, match="cannot cache"):
        numba.njit(cache=True)(add)
    assert kernel(add)(1, 2) == 3


def test_the_library_works_with_a_cache_folder_that_cannot_be_made(tmp_path):
    """Even the superuser cannot make a folder inside a file."""
    blocked = tmp_path / "file"
    blocked.write_text("in the way")
    done = run(USE, NUMBA_CACHE_DIR=str(blocked / "cache"))
    assert done.returncode == 0, done.stderr
    assert done.stdout.split()[:2] == ["2", "0"]


def test_the_library_works_where_nothing_can_be_written(tmp_path):
    """All folders refuse, as in a read-only container."""
    refuse = """
        import tempfile
        def refuse(*args, **kwargs):
            raise PermissionError("read-only file system")
        tempfile.TemporaryFile = refuse
        from beltrami._jit import kernel
        from beltrami.mesh.fans import _find
        assert type(_find._cache).__name__ == "NullCache", "this test does not test"
        import numpy as np
        assert _find(np.array([0, 0, 1]), 2) == 0
        print("fine")
    """
    done = run(refuse, NUMBA_CACHE_DIR=str(tmp_path), HOME=str(tmp_path))
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == "fine"


@pytest.mark.parametrize("bits", [8, 32, 64])
def test_unsigned_is_a_view(bits):
    signed = np.array([0, 3, 100], f"i{bits // 8}")
    view = unsigned(signed)
    assert view.dtype == np.dtype(f"u{bits // 8}")
    assert np.shares_memory(view, signed)
    assert view.tolist() == [0, 3, 100]


def test_unsigned_arrays_stay_as_they_are():
    assert unsigned(np.array([1, 2], np.uint32)).tolist() == [1, 2]


@part_of_kernels
def doubled(x):
    return 2 * x


def test_a_part_is_compiled_once_for_all_and_can_be_a_kernel_as_well():
    """A kernel of a part does not take what is on disk of it, which Python could not call."""

    def first(x):
        return doubled(x) + 1

    def second(x):
        return doubled(doubled(x))

    assert (kernel(first)(3), kernel(second)(3), kernel(doubled)(3)) == (7, 12, 6)
    part = _jit._PARTS[doubled]
    assert len(part.overloads) <= 1  # none where both kernels were on disk already
