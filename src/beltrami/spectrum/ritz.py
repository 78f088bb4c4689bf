"""Ritz values of a Krylov space, and what they may not have seen of a kernel."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.linalg import eigh_tridiagonal

from beltrami._arrays import Floats
from beltrami.spectrum.interval import Interval, probes
from beltrami.spectrum.kernel import Kernel, Response, evaluate

_PLACES = 6  # where one more Ritz value is tried, besides the ends and the jumps


def ritz_pairs(alpha: Sequence[float], beta: Sequence[float]) -> tuple[Floats, Floats]:
    """Return the eigenvalues, and the eigenvectors in columns, of a tridiagonal matrix.

    Examples
    --------
    >>> values, vectors = ritz_pairs([1.0, 1.0], [1.0])
    >>> values.round(12).tolist(), (vectors**2).round(12).tolist()
    ([0.0, 2.0], [[0.5, 0.5], [0.5, 0.5]])
    """
    values, vectors = eigh_tridiagonal(np.array(alpha), np.array(beta))
    return np.asarray(values), np.asarray(vectors)


class Watch:
    """Estimates of the error of :math:`h(T) e_1`, while T grows."""

    def __init__(self, h: Response, interval: Interval) -> None:
        self.h = h
        self.interval = interval
        self.probes = np.sort(probes(interval))
        self.truth = evaluate(h, self.probes)
        self.size = float(np.abs(self.truth).max()) or 1.0
        self.older = np.zeros(0)
        self.ends = [interval.low, interval.high]
        step = 1e-9 * (interval.high - interval.low)
        for jump in h.jumps if isinstance(h, Kernel) else ():
            if interval.low <= jump <= interval.high:
                self.ends += [jump - step, jump + step]

    def coordinates(self, ritz: Floats, modes: Floats) -> Floats:
        """Return h(T) e_1; rounding may put Ritz values outside of the interval."""
        values = evaluate(self.h, np.clip(ritz, *self.interval))
        return np.asarray(modes @ (values * modes[0]))

    def error(self, alpha: Sequence[float], beta: Sequence[float], enough: float) -> float:
        """Estimate the error beside the largest |h|, from T and the β that leads out of it.

        The sum of the changes since the last call, and by one more Ritz value at any of the places
        that matter; those are not tried if the former alone is more than ``enough``.
        """
        ritz, modes = ritz_pairs(alpha, beta[:-1])
        newer = self.coordinates(ritz, modes)
        changes = [_distance(newer, self.older)]
        self.older = newer
        if changes[0] > enough * self.size:
            return changes[0] / self.size
        for place in (*self.ends, *self._unseen(ritz)):
            gaps = ritz - place
            if np.abs(gaps).min() <= 1e-13 * np.abs(ritz).max():
                continue  # there is a Ritz value already
            last = place + beta[-1] ** 2 * float((modes[-1] ** 2 / gaps).sum())
            more = ritz_pairs([*alpha, last], beta)
            changes.append(_distance(self.coordinates(*more), newer))
        return sum(changes) / self.size

    def _unseen(self, ritz: Floats) -> Floats:
        """Return where h is farthest from what the Ritz values show: the worst of a few gaps."""
        inside = np.clip(ritz, *self.interval)
        seen = np.interp(self.probes, inside, evaluate(self.h, inside))
        missed = np.abs(self.truth - seen)
        gaps = np.searchsorted(inside, self.probes)
        order = np.lexsort((-missed, gaps))
        first = order[np.diff(gaps[order], prepend=-1) > 0]  # the worst of each gap
        return np.asarray(self.probes[first[np.argsort(-missed[first])[:_PLACES]]])


def _distance(one: Floats, other: Floats) -> float:
    """Distance of two results, of which one may lie in a smaller space."""
    longest = max(len(one), len(other))
    padded = [np.pad(row, (0, longest - len(row))) for row in (one, other)]
    return float(np.linalg.norm(padded[0] - padded[1]))
