"""Parameters of a step: what they may be, checked before anything runs."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Protocol

from beltrami.errors import BeltramiError, check_name, shown


class Parameter(Protocol):
    """A parameter has a default, and takes a value or refuses it with a BeltramiError."""

    @property
    def default(self) -> Any:
        """The value where none is given."""

    def take(self, name: str, value: Any) -> Any:
        """Return the value as it is used and written into the manifest."""


@dataclass(frozen=True)
class Whole:
    """A whole number from ``least`` to ``most``."""

    default: int | None = None
    least: int = 0
    most: int = 2**53

    def take(self, name: str, value: Any) -> int:
        """Return the number."""
        if isinstance(value, bool) or not isinstance(value, int):
            raise BeltramiError(f"{name} is {shown(value)} where a whole number is needed")
        if not self.least <= value <= self.most:
            ends = f"from {self.least} to {self.most}"
            wanted = f"{self.least} or more" if self.most == 2**53 else ends
            raise BeltramiError(f"{name} is {value} where {wanted} is needed")
        return value


@dataclass(frozen=True)
class Number:
    """A finite number, at least ``least``; more than that if it is ``open``."""

    default: float | None = None
    least: float = 0.0
    most: float = math.inf
    open: bool = False

    def take(self, name: str, value: Any) -> float:
        """Return the number."""
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise BeltramiError(f"{name} is {shown(value)} where a number is needed")
        number = float(value) if abs(value) < 1e300 else math.inf
        low = number > self.least if self.open else number >= self.least
        if not (math.isfinite(number) and low and number <= self.most):
            wanted = f"{'>' if self.open else '>='} {self.least:g}"
            wanted += "" if math.isinf(self.most) else f" and <= {self.most:g}"
            raise BeltramiError(f"{name} is {value} where a finite number {wanted} is needed")
        return number


@dataclass(frozen=True)
class Numbers:
    """A list of finite numbers >= 0; one number is a list of one."""

    default: None = None

    def take(self, name: str, value: Any) -> list[float]:
        """Return the list."""
        given = list(value) if isinstance(value, list | tuple) else [value]
        if not given:
            raise BeltramiError(f"{name} is empty where numbers are needed")
        return [Number().take(name, item) for item in given]


@dataclass(frozen=True)
class Flag:
    """True or false; None where it matters whether it was given."""

    default: bool | None = False

    def take(self, name: str, value: Any) -> bool:
        """Return the truth value."""
        if not isinstance(value, bool):
            raise BeltramiError(f"{name} is {shown(value)} where true or false is needed")
        return value


@dataclass(frozen=True)
class Choice:
    """One of several names."""

    choices: tuple[str, ...]
    default: str | None = None

    def take(self, name: str, value: Any) -> str:
        """Return the name."""
        return check_name(name, value, self.choices)
