"""Calls of public functions, as ``public_calls`` makes them, to be made again otherwise."""

from __future__ import annotations

import contextlib
import functools
import inspect
from dataclasses import dataclass
from typing import Any

import beltrami as bt
from public_calls import public_names


@dataclass(frozen=True)
class Call:
    """A call from outside of the library: its name, and all that it takes to repeat it."""

    name: str
    function: Any
    given: tuple
    named: dict

    def parameters(self):
        """The names of all parameters, those with defaults too, but for the object of a method."""
        found = inspect.signature(self.function).parameters.values()
        kinds = (inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY)
        return [p.name for p in found if p.kind in kinds and p.name != "self"]

    def with_value(self, parameter, value):
        """Call it with another value for one parameter."""
        names = list(inspect.signature(self.function).parameters)
        place = names.index(parameter)
        given, named = list(self.given), dict(self.named)
        if place < len(given):
            given[place] = value
        else:
            named[parameter] = value
        return self.function(*given, **named)


@contextlib.contextmanager
def recording():
    """Note every call of something public that comes from outside; yield the list of them."""
    calls, depth = [], [0]

    def noting(name, function, again=None):
        @functools.wraps(function)
        def noted(*given, **named):
            if not depth[0]:
                skip = 1 if again is not None else 0  # the object that is being made
                calls.append(Call(name, again or function, given[skip:], named))
            depth[0] += 1
            try:
                return function(*given, **named)
            finally:
                depth[0] -= 1

        return noted

    undo = []
    for name in public_names():
        owner, _, inner = name.rpartition(".")
        home = getattr(bt, owner) if owner else bt
        thing = getattr(home, inner)
        if inspect.isclass(thing):
            if "__init__" in vars(thing) and not issubclass(thing, BaseException):
                undo.append((thing, "__init__", thing.__init__))
                thing.__init__ = noting(name, thing.__init__, thing)
        elif inspect.isfunction(vars(home).get(inner)):
            undo.append((home, inner, vars(home)[inner]))
            setattr(home, inner, noting(name, vars(home)[inner]))
    try:
        yield calls
    finally:
        for home, inner, before in reversed(undo):
            setattr(home, inner, before)
