"""Convolution on periodic grids: whether the method chosen is the faster one."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchmarks.cases import Case
from benchmarks.claims import Contender, Goal, Row
from benchmarks.packages import package

DIRECT, FFT = "beltrami, direct", "beltrami, by FFT"


def stencil(shape: tuple[int, ...], values: int) -> NDArray[np.float64]:
    """Write the points nearest to 0, so many, each with a value of its own."""
    kernel = np.zeros(shape)
    near = sorted(product(range(-4, 5), repeat=len(shape)), key=lambda k: sum(c * c for c in k))
    for number, k in enumerate(near[:values]):
        kernel[k] = 1 / (1 + number)
    return kernel


def difference(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    """Largest difference, relative to the largest value."""
    return float(np.abs(a - b).max() / np.abs(a).max())


def convolving(shape: tuple[int, ...], values: int) -> Callable[[Case], Sequence[Contender]]:
    """Bind a grid and a number of values of the kernel."""

    def contenders(case: Case) -> Sequence[Contender]:
        del case
        f = np.random.default_rng(27).normal(size=shape)
        kernel = stencil(shape, values)

        def repeated(work: Callable[[], Any]) -> Any:
            for _ in range(max(0, 2**20 // f.size - 1)):  # small grids: as many as fill a large one
                work()
            return work()

        def ours(method: str) -> Callable[[None], Any]:
            convolve = package("beltrami").convolve
            return lambda _: repeated(lambda: convolve(f, kernel, method))

        def scipy(_: None) -> Any:
            ndimage = package("scipy.ndimage")
            reach = tuple(slice(0, min(9, p)) for p in shape)
            centred = np.roll(kernel, [r.stop // 2 for r in reach], range(len(shape)))[reach]
            return repeated(lambda: ndimage.convolve(f, centred, mode="wrap"))

        return [
            Contender("beltrami", ours("auto"), ours=True),
            Contender(DIRECT, ours("direct"), ours=True),
            Contender(FFT, ours("fft"), ours=True),
            Contender("scipy.ndimage", scipy),
        ]

    return contenders


def row(name: str, shape: tuple[int, ...], values: int) -> Row:
    """Make the row of one grid: the choice is within 1.3 of both methods."""
    grid = " x ".join(map(str, shape))
    return Row(
        name=f"convolve-{name}",
        work=f"convolution on a periodic grid of {grid}, kernel of {values} values",
        contenders=convolving(shape, values),
        goals=(Goal(1.3, against=DIRECT), Goal(1.3, against=FFT)),
        difference=difference,
        size=0,
    )


CONVOLUTIONS = (
    row("tiny", (16, 16), 5),
    row("small", (64, 64), 9),
    row("prime", (257, 257), 25),
    row("cube", (64, 64, 64), 7),
    row("local", (1024, 1024), 5),
    row("wide", (1024, 1024), 25),
    row("line", (65_537,), 3),
)
