"""What a verb of a pipeline is: parameters, columns of the table, and what it does to a mesh."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Any, TypeAlias

from beltrami.batch.parameters import Parameter
from beltrami.mesh.mesh import Mesh
from beltrami.operators.laplacian import laplacian
from beltrami.operators.pair import Laplacian
from beltrami.spectrum.basis import FourierBasis

Options: TypeAlias = Mapping[str, Any]
Writer: TypeAlias = Callable[[Path], object]

# The kinds of columns: a whole number, a number, a truth value, a text, a list of numbers.
KINDS = ("whole", "number", "flag", "text", "numbers")


@dataclass(frozen=True, eq=False)
class Scene:
    """What the steps before have made of a mesh: itself, its pair, its eigenpairs."""

    mesh: Mesh
    pair: Laplacian | None = None
    basis: FourierBasis | None = None

    def pair_of(self, weights: str | None, mass: str | None) -> Laplacian:
        """Return the pair of these weights; without any, that of the step before or the default."""
        if weights is None and mass is None and self.pair is not None:
            return self.pair
        return laplacian(self.mesh, weights, mass)


@dataclass(frozen=True, eq=False)
class Told:
    """What a step found: numbers for the table, a file, and the scene for the steps after it."""

    scene: Scene
    facts: Mapping[str, Any] = field(default_factory=dict)
    suffix: str = ""
    write: Writer | None = None


@dataclass(frozen=True)
class Size:
    """What an estimate of memory knows of a mesh."""

    n_vertices: int
    n_faces: int


Estimate: TypeAlias = Callable[[Options, Size], tuple[int, int]]


def _nothing(_options: Options) -> None:
    """Accept every combination of valid parameters."""


@dataclass(frozen=True)
class Verb:
    """A verb of a pipeline.

    Attributes
    ----------
    run
        From a scene and the options to what is told.
    columns
        Names and kinds of the facts; a step may leave some out.
    parameters
        By name; parameters without a value and a default are not given to ``run``.
    memory
        Bytes at the peak beyond what the scene holds, and bytes held after it, for a size.
    needs
        ``"basis"`` if a spectrum must be there.
    changes
        Whether the mesh is another one after it, so that pair and basis are no longer its own.
    check
        Raises BeltramiError if parameters do not go together.
    """

    run: Callable[[Scene, Options], Told]
    columns: Mapping[str, str]
    parameters: Mapping[str, Parameter]
    memory: Estimate
    needs: str = ""
    gives: str = ""
    changes: bool = False
    check: Callable[[Options], None] = _nothing


def table(**verbs: Verb) -> Mapping[str, Verb]:
    """Return verbs by name, read-only."""
    return MappingProxyType(verbs)
