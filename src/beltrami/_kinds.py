"""Kinds of arguments: what the signature of a public function says is asked at its door."""

from __future__ import annotations

import functools
import os
from collections.abc import Callable, Mapping
from numbers import Real
from types import FunctionType
from typing import Any, Final, TypeVar, cast

import numpy as np

from beltrami.errors import MeshError, shown

Function = TypeVar("Function", bound=Callable[..., Any])


def checked(function: Function) -> Function:
    """Refuse arguments of another kind than the annotations say; values are for the function.

    Asked are truth values, numbers (also where whole ones are needed: the function knows which),
    paths, callbacks of progress, eigenpairs and maps of them. Anything else, arrays above all, has
    a door of its own.

    Raises
    ------
    MeshError
        With one line, where Python would have a TypeError of what happens to be computed first.

    Examples
    --------
    >>> @checked
    ... def twice(x: float, exact: bool = False) -> float:
    ...     return 2 * x
    >>> twice(1.5)
    3.0
    >>> twice("1.5")
    Traceback (most recent call last):
        ...
    beltrami.errors.MeshError: x is '1.5' where a number is needed
    """
    kinds = {
        name: kind
        for name, annotation in function.__annotations__.items()
        if name != "return" and (kind := _kind_of(annotation)) is not None
    }
    code = function.__code__
    if "whole" in code.co_names:  # it asks for its whole numbers itself, in its own words
        kinds = {name: kind for name, kind in kinds.items() if set(kind) - {"int", "None"}}
    names = code.co_varnames[: code.co_argcount]
    require = require_kind

    def door(*given: Any, **named: Any) -> Any:
        for name, value in zip(names, given, strict=False):
            if name in kinds:
                require(name, value, kinds[name])
        for name, value in named.items():
            if name in kinds:
                require(name, value, kinds[name])
        return function(*given, **named)

    # With the globals of the function, so that it counts as one of its module: doctest looks there.
    own = FunctionType(door.__code__, function.__globals__, closure=door.__closure__)
    return cast(Function, functools.update_wrapper(own, function))


def require_kind(name: str, value: Any, kind: tuple[str, ...]) -> None:
    """Raise MeshError if a value is of none of these kinds; for doors that ask other things first.

    Examples
    --------
    >>> require_kind("exact", np.bool_(True), ("bool",))
    >>> require_kind("exact", "yes", ("bool",))
    Traceback (most recent call last):
        ...
    beltrami.errors.MeshError: exact is 'yes' where True or False is needed
    """
    if not any(_TESTS[word](value) for word in kind):
        wanted = [_WORDS[word] for word in kind if word != "None"]
        raise MeshError(f"{name} is {shown(value)} where {' or '.join(wanted)} is needed")


def _kind_of(annotation: object) -> tuple[str, ...] | None:
    """Return the words of an annotation, if all are known here and none has a door of its own."""
    words = tuple(word.strip() for word in str(annotation).split("|"))
    elsewhere = any(set(words) <= {word, "None"} for word in ("str", "Laplacian"))
    elsewhere |= words == ("FourierBasis", "None")  # an option of some methods only
    return words if set(words) <= set(_TESTS) and not elsewhere else None


def _is_number(value: Any) -> bool:
    if isinstance(value, np.ndarray):
        return value.ndim == 0 and value.dtype.kind in "biuf"
    return isinstance(value, Real)


def _is_row(value: Any) -> bool:
    """Say whether it has a length and an order, and is no text."""
    return isinstance(value, list | tuple) or (isinstance(value, np.ndarray) and value.ndim > 0)


def _is_a(name: str) -> Callable[[Any], bool]:
    """Return a test for a class of a later room, by its name."""
    return lambda value: any(one.__name__ == name for one in type(value).__mro__)


_TESTS: Final[dict[str, Callable[[Any], bool]]] = {
    "None": lambda value: value is None,
    "bool": lambda value: isinstance(value, bool | np.bool_),
    "int": _is_number,
    "float": _is_number,
    "str": lambda value: isinstance(value, str),
    "bytes": lambda value: isinstance(value, bytes | bytearray | memoryview),
    "os.PathLike[str]": lambda value: isinstance(value, os.PathLike),
    "PathLike[str]": lambda value: isinstance(value, os.PathLike),
    "Progress": callable,
    "Light": lambda value: callable(getattr(value, "towards", None)),
    "Mapping[str, float]": lambda value: isinstance(value, Mapping),
    "Mapping[str, ArrayLike]": lambda value: isinstance(value, Mapping),
    "Watcher": callable,
    "tuple[str, ...]": lambda value: _is_row(value) and all(isinstance(one, str) for one in value),
    "Sequence[str]": lambda value: _is_row(value) and all(isinstance(one, str) for one in value),
    "Sequence[ArrayLike]": _is_row,
    "Sequence[RowBlock]": lambda value: _is_row(value) and all(map(_is_a("RowBlock"), value)),
    "tuple[float, float]": lambda value: (
        _is_row(value) and len(value) == 2 and all(map(_is_number, value))
    ),
    "FourierBasis": _is_a("FourierBasis"),
    "FunctionalMap": _is_a("FunctionalMap"),
    "Laplacian": _is_a("Laplacian"),
}
_WORDS: Final = {
    "bool": "True or False",
    "int": "a whole number",
    "float": "a number",
    "str": "a text",
    "bytes": "bytes",
    "os.PathLike[str]": "a path",
    "PathLike[str]": "a path",
    "Progress": "a function",
    "Light": "a light",
    "Mapping[str, float]": "a mapping of names to numbers",
    "Mapping[str, ArrayLike]": "a mapping of names to arrays",
    "Watcher": "a function",
    "tuple[str, ...]": "a list of texts",
    "Sequence[str]": "a list of texts",
    "Sequence[ArrayLike]": "a list of arrays",
    "Sequence[RowBlock]": "a list of blocks of rows",
    "tuple[float, float]": "a pair of numbers",
    "FourierBasis": "a FourierBasis (fourier_basis makes one)",
    "FunctionalMap": "a FunctionalMap (functional_map makes one)",
    "Laplacian": "a Laplacian (laplacian makes one)",
}
