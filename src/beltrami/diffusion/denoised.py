"""What denoise returns: the mesh, and what was found and done."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from beltrami._arrays import Integers
from beltrami._carded import Carded
from beltrami.diffusion.noise import NoiseLevel
from beltrami.mesh.mesh import Mesh


@dataclass(frozen=True, eq=False, repr=False)
class DenoisedPart:
    """What was found and done in one component, or in all the smaller ones together.

    Attributes
    ----------
    vertices
        Their numbers.
    noise
        What was found of the noise.
    sigma
        The level it was taken for: standard deviation along the normals, in the unit of length; 0
        where nothing is done.
    mixture, second
        (filter, weight) of the mixture that was applied, and of the one that was applied to its
        result.
    corrected
        Root mean square of the corrections by curvature and length of edges that came after them,
        in the unit of length; 0 if none did.
    predicted_error
        Root mean square distance of the vertices from the truth that is expected (Stein), in the
        unit of length.
    spikes
        The numbers of those of its vertices that were taken for spikes.
    """

    vertices: Integers
    noise: NoiseLevel
    sigma: float
    mixture: tuple[tuple[str, float], ...]
    second: tuple[tuple[str, float], ...]
    corrected: float
    predicted_error: float
    spikes: Integers


@dataclass(frozen=True, eq=False, repr=False)
class Denoised(Carded):
    """A denoised mesh, and what was found and done.

    Attributes
    ----------
    mesh
        The result; the topology is the same.
    parts
        What was found and done in each component, the largest first; small ones are one part, and
        those of less than 40 vertices the last one.
    noise, sigma, mixture, second, corrected
        Of the largest: see ``DenoisedPart``.
    predicted_error
        Root mean square distance of the vertices from the truth that is expected (Stein), in the
        unit of length.
    spikes
        (k,) the vertices that were taken for spikes.
    volume_change
        Relative; NaN if the mesh has a boundary, or no volume.
    warnings
        Why the result may be worse than predicted, and how many vertices were taken for spikes.
        Where only spikes were odd, all filters were used, else only low passes.
    """

    mesh: Mesh
    parts: tuple[DenoisedPart, ...]
    volume_change: float

    @property
    def noise(self) -> NoiseLevel:
        """What was found of the noise of the largest part."""
        return self.parts[0].noise

    @property
    def sigma(self) -> float:
        """Its level."""
        return self.parts[0].sigma

    @property
    def mixture(self) -> tuple[tuple[str, float], ...]:
        """Its first mixture."""
        return self.parts[0].mixture

    @property
    def second(self) -> tuple[tuple[str, float], ...]:
        """Its second mixture."""
        return self.parts[0].second

    @property
    def corrected(self) -> float:
        """Root mean square of its corrections."""
        return self.parts[0].corrected

    @property
    def predicted_error(self) -> float:
        """Over all vertices of parts."""
        sizes = [len(part.vertices) for part in self.parts]
        squares = [part.predicted_error**2 for part in self.parts]
        return math.sqrt(float(np.average(squares, weights=sizes)))

    @property
    def spikes(self) -> Integers:
        """(k,) the vertices of all parts that were taken for spikes, in order."""
        return np.sort(np.concatenate([part.spikes for part in self.parts]))

    @property
    def warnings(self) -> tuple[str, ...]:
        """Of all parts, told apart where there are several."""
        if len(self.parts) == 1:
            return self.noise.warnings
        return tuple(
            f"part {i}, {len(part.vertices)} vertices: {text}"
            for i, part in enumerate(self.parts)
            for text in part.noise.warnings
        )

    def __repr__(self) -> str:
        main = self.mixture[0][0] if self.mixture else "nothing to do"
        return f"<Denoised: σ = {self.sigma:.3g}, mostly {main}>"
