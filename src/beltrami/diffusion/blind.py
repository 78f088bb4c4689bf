"""The choice for a mesh of which nothing is known: measure its noise, choose, and look again."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from beltrami._arrays import Integers
from beltrami.diffusion.candidates import EVENING, Bench
from beltrami.diffusion.choice import NOTHING, Choice
from beltrami.diffusion.noise import NoiseLevel
from beltrami.diffusion.seen import SMALL, Seen
from beltrami.diffusion.spikes import Spikes, find_spikes
from beltrami.mesh.mesh import Mesh

FEW = 40  # vertices of a component, below which nobody can tell noise from shape
_TOO_FEW = (
    f"components of less than {FEW} vertices are left as they are: nobody can tell their noise "
    "from their shape (say with noise= how much there is)"
)


@dataclass(frozen=True, eq=False)
class Blind:
    """What was found and chosen.

    Attributes
    ----------
    noise
        Of the mesh as it is.
    choice, bench, mesh
        What is to be applied, and to which mesh: the same without the spikes.
    spikes
        The vertices that were taken for such.
    risk
        Mean square error that is expected.
    """

    noise: NoiseLevel
    choice: Choice
    bench: Bench
    mesh: Mesh
    spikes: Integers
    risk: float


def blind_choice(mesh: Mesh, noise: float | None, size: int, *, linear: bool = False) -> Blind:
    """Measure the noise, and choose on a sample of about ``size`` faces; safely, if it is odd.

    Spikes are put where their neighbours say before, and do not count.
    """
    seen = Seen.of(mesh, noise, size, linear=linear)
    none = np.zeros(0, np.int64)
    if noise is None and seen.largest < FEW:
        told = replace(seen.found, warnings=(_TOO_FEW,))
        return Blind(told, NOTHING, seen.bench, mesh, none, 0.0)
    # noise that has a colour is nearly Gaussian: to take it for spikes would leave most of it
    odd = seen.found.has_outliers and seen.colour is None and seen.largest >= SMALL
    if odd and noise is None and not linear:
        spikes = find_spikes(mesh)
        if spikes is not None:
            return _without(spikes, seen, size)
    found, choice = seen.choice()
    return Blind(found, choice, seen.bench, mesh, none, choice.risk)


def _without(spikes: Spikes, before: Seen, size: int) -> Blind:
    """Choose for the mesh without them; what is left of its kurtosis is small beside them."""
    bench = before.bench.moved(spikes.mesh, EVENING)
    seen = Seen.of(spikes.mesh, None, size, linear=False, bench=bench, spikes=spikes.found)
    told, choice = seen.choice()
    count, share = int(spikes.found.sum()), float(spikes.found.mean())
    text = f"{count} vertices were taken for spikes, and put where their neighbours say"
    others = told.explained().warnings
    noise = replace(before.found, warnings=(*before.found.warnings, text, *others))
    of_filling = max(spikes.error**2 - choice.sigma**2, choice.risk)
    risk = (1 - share) * choice.risk + share * of_filling
    return Blind(noise, choice, seen.bench, spikes.mesh, np.flatnonzero(spikes.found), risk)
