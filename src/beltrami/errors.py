"""What can go wrong, as classes: each error names the guilty ones and the remedy."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beltrami._nearest import nearest

__all__ = [
    "ApproximationError", "BeltramiError", "BoundaryCurveError", "ConvergenceError",
    "DatasetError", "DegenerateFaceError", "DimensionError", "EmptyMeshError", "FileFormatError",
    "FoldedMapError", "IncompatibleError", "MeshError", "MissingExtraError",
    "NegativeWeightError", "NonFiniteError", "NotADiskError", "NotClosedError",
    "NotDifferentiableError", "NotManifoldError", "NotOrientableError",
    "NotPositiveDefiniteError", "RankLossError", "SingularMatrixError", "StepTooLongError",
    "SurfaceError", "TruncationError", "UnknownNameError", "UnreferencedVertexError",
]  # fmt: skip

_SHOWN = 5
_LONGEST = 60


def _named(kind: str, indices: NDArray[Any]) -> str:
    """Write the first few indices: ``vertices 3, 8, 9 and 20 more``."""
    shown = ", ".join(str(i if np.ndim(i) == 0 else tuple(i)) for i in indices[:_SHOWN].tolist())
    more = len(indices) - _SHOWN
    return f"{kind} {shown}" + (f" and {more} more" if more > 0 else "")


def shown(value: object) -> str:
    """Write what a user gave in one short line, for a message.

    Examples
    --------
    >>> shown(np.eye(2)), shown("x" * 99)
    ('array([[1., 0.], [0., 1.]])', "'xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx...")
    """
    text = " ".join(repr(value).split())
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 3]}..."


def _rebuild(cls: type[BeltramiError], args: tuple[Any, ...], state: dict[str, Any]) -> Any:
    error = cls.__new__(cls, *args)
    error.args = args
    error.__dict__.update(state)
    return error


class BeltramiError(Exception):
    """Every error that this library raises on purpose."""

    def __reduce__(self) -> Any:  # keyword arguments do not survive the default pickling
        return _rebuild, (type(self), self.args, self.__dict__)


class MeshError(BeltramiError, ValueError):
    """A mesh, or a function on it, is not what the operation needs.

    Parameters
    ----------
    problem
        What is wrong, without a final stop.
    vertices, faces, edges
        The guilty indices (edges as pairs of vertices).
    remedy
        What to do about it, as a sentence.
    """

    def __init__(
        self,
        problem: str,
        *,
        vertices: ArrayLike = (),
        faces: ArrayLike = (),
        edges: ArrayLike = (),
        remedy: str = "",
    ) -> None:
        self.problem = problem
        self.vertices = np.asarray(vertices, dtype=np.int64).reshape(-1)
        self.faces = np.asarray(faces, dtype=np.int64).reshape(-1)
        self.edges = np.asarray(edges, dtype=np.int64).reshape(-1, 2)
        self.remedy = remedy
        groups = (("vertices", self.vertices), ("faces", self.faces), ("edges", self.edges))
        guilty = "; ".join(_named(kind, which) for kind, which in groups if len(which))
        text = problem + (f" ({guilty})" if guilty else "")
        super().__init__(f"{text}. {remedy}" if remedy else text)


class EmptyMeshError(MeshError):
    """The operation needs at least one face."""


class DimensionError(MeshError):
    """The vertices have the wrong number of coordinates, or a function the wrong length."""


class NonFiniteError(MeshError):
    """A coordinate or a value is NaN or infinite."""


class UnreferencedVertexError(MeshError):
    """Some vertices belong to no face."""


class DegenerateFaceError(MeshError):
    """Some faces have no area, or name a vertex twice."""


class NotManifoldError(MeshError):
    """An edge has more than two faces, or a vertex more than one fan of faces."""


class NotOrientableError(MeshError):
    """No choice of orientations of the faces is consistent."""


class NotClosedError(MeshError):
    """The operation needs a surface without boundary."""


class NegativeWeightError(MeshError):
    """The operation needs non-negative weights; ``edges`` lists those that are not."""


class IncompatibleError(MeshError):
    """A Poisson problem without a solution; ``vertices`` has one of each component at fault."""


class NotADiskError(MeshError):
    """The operation needs a disk: connected, one boundary loop, no handle."""


class FoldedMapError(MeshError):
    """A map to the plane is not a bijection; ``faces`` are those turned over or without area."""


class BoundaryCurveError(MeshError):
    """A curve is not convex (``vertices``: its corners), or inner edges divide a side (E89)."""


class SurfaceError(BeltramiError, ValueError):
    """A parametric surface is not what the operation needs; ``parameters`` are the guilty (u, v).

    Parameters
    ----------
    problem
        What is wrong, without a final stop.
    parameters
        (q, 2) parameters where it is wrong.
    remedy
        What to do about it, as a sentence.
    """

    def __init__(self, problem: str, *, parameters: ArrayLike = (), remedy: str = "") -> None:
        self.problem = problem
        self.parameters = np.asarray(parameters, dtype=np.float64).reshape(-1, 2)
        self.remedy = remedy
        guilty = f" ({_named('(u, v) =', self.parameters)})" if len(self.parameters) else ""
        super().__init__(f"{problem}{guilty}. {remedy}" if remedy else f"{problem}{guilty}")


class RankLossError(SurfaceError):
    """The Jacobian has not rank 2, so that det I = 0: no immersion there (E2)."""


class NotDifferentiableError(SurfaceError):
    """A map is written with something whose derivatives are not known, or has none there."""


class StepTooLongError(BeltramiError, ValueError):
    """A step beyond the bound of stability; ``longest`` is the longest allowed."""

    def __init__(
        self,
        step: float,
        longest: float,
        scheme: str = "the explicit scheme",
        remedy: str = "Take more steps, or the implicit scheme, which has no such bound",
    ) -> None:
        self.step, self.longest = step, longest
        super().__init__(
            f"{scheme} is unstable with a step of {step:.6g}: the longest allowed is "
            f"{longest:.6g}. {remedy}"
        )


class TruncationError(BeltramiError, ValueError):
    """A basis leaves out more than was allowed: ``left_out`` of the norm of the function."""

    def __init__(self, left_out: float, count: int) -> None:
        self.left_out = left_out
        super().__init__(
            f"the {count} modes of the basis leave out up to {left_out:.2g} of the norm of the "
            "result. Take more modes, another method, or a larger tolerance"
        )


class SingularMatrixError(BeltramiError, ValueError):
    """A matrix to factorise is singular (to working precision); ``rows`` are without a pivot."""

    def __init__(self, problem: str, rows: ArrayLike = ()) -> None:
        self.rows = np.asarray(rows, dtype=np.int64).reshape(-1)
        super().__init__(problem)


class NotPositiveDefiniteError(BeltramiError, ValueError):
    """A matrix is not symmetric positive definite; ``rows`` show it, where they are known."""

    def __init__(
        self,
        rows: ArrayLike = (),
        problem: str = "the matrix is not symmetric positive definite",
        remedy: str = 'factorize(A, backend="superlu") takes every invertible matrix',
    ) -> None:
        self.rows = np.asarray(rows, dtype=np.int64).reshape(-1)
        shown = f" ({_named('rows', self.rows)})" if len(self.rows) else ""
        super().__init__(f"{problem}{shown}. {remedy}")


class ConvergenceError(BeltramiError, RuntimeError):
    """An iteration stopped before it reached its tolerance; ``residuals`` is its history."""

    def __init__(self, problem: str, residuals: ArrayLike = ()) -> None:
        self.residuals = np.asarray(residuals, dtype=np.float64)
        super().__init__(problem)


class ApproximationError(ConvergenceError):
    """h(B⁻¹L) is not as near as wanted; ``estimate`` is the error, beside the largest |h|."""

    def __init__(self, problem: str, estimate: float, remedy: str) -> None:
        self.estimate = estimate
        self.remedy = remedy
        super().__init__(f"{problem}. {remedy}")


class UnknownNameError(BeltramiError, ValueError):
    """A name of a method or kind that does not exist; ``choices`` lists those that do."""

    def __init__(self, what: str, name: object, choices: Iterable[str]) -> None:
        self.name, self.choices = name, tuple(choices)
        near = nearest("" if name is None else str(name), self.choices)
        listed = ", ".join(map(repr, self.choices)) + (f". Did you mean {near!r}?" if near else ".")
        wrong = f"no {what} was named" if name is None else f"unknown {what} {shown(name)}"
        super().__init__(f"{wrong}: choose one of {listed}")


class FileFormatError(BeltramiError, ValueError):
    """A file is not what its format promises.

    ``problem`` says what was expected and what was found; ``line`` (of a text file, from 1) or
    ``byte`` (of a binary one, from 0) says where.
    """

    def __init__(
        self, path: object, problem: str, *, line: int | None = None, byte: int | None = None
    ) -> None:
        self.path = str(path)
        self.problem = problem
        self.line = line
        self.byte = byte
        place = f", line {line}" if line is not None else ""
        place += f", byte {byte}" if byte is not None else ""
        super().__init__(f"{self.path}{place}: {problem}")


class DatasetError(BeltramiError, RuntimeError):
    """The file of a data set cannot be had; ``path`` is where it is looked for."""

    def __init__(self, problem: str, path: object) -> None:
        self.path = str(path)
        super().__init__(problem)


class MissingExtraError(BeltramiError, ImportError):
    """An optional package is not installed; ``extra`` brings it."""

    def __init__(self, package: str, extra: str, purpose: str) -> None:
        self.package = package
        self.extra = extra
        super().__init__(
            f"{purpose} needs the package {package!r}: pip install 'beltrami[{extra}]'"
        )


def check_name(what: str, name: object, choices: Sequence[str]) -> str:
    """Return ``name`` if it is one of ``choices``; UnknownNameError, with the nearest, if not.

    Examples
    --------
    >>> check_name("weights", "distance", ("combinatorial", "distance"))
    'distance'
    """
    if isinstance(name, str) and name in choices:
        return name
    raise UnknownNameError(what, name, choices)
