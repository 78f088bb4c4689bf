"""Positions as coefficients of a basis that both sides make of the faces (section 3.3.6)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from beltrami._arrays import Floats, Integers
from beltrami._progress import Progress
from beltrami.compression.block_basis import BlockBasis
from beltrami.compression.blocks import Blocks, cut_into_blocks
from beltrami.compression.coefficients import code_coefficients, new_memory
from beltrami.compression.corrections import corrections_for, encode_corrections
from beltrami.compression.grid import PositionGrid
from beltrami.compression.neighbourhood import Neighbourhood
from beltrami.compression.numbers import surroundings
from beltrami.compression.range_coder import POSITION, finished, new_encoder
from beltrami.compression.smoothing import best_choice, smoothed
from beltrami.compression.spectral_head import MOST_IN_A_BLOCK, SpectralHead
from beltrami.compression.transform import DEAD_ZONE, add_up, analyse, length_of, rounded
from beltrami.compression.varint import to_varints


@dataclass
class Rounding:
    """Coefficients rounded to one step, and what they add up to.

    Parameters
    ----------
    grid
        Of the step; its origin is taken away first.
    numbers
        (n, d), block after block.
    x
        (n, d) the positions that they add up to, in steps from the origin.
    basis
        Knows the hash of the vectors that were needed.
    """

    grid: PositionGrid
    numbers: Integers
    x: Floats
    basis: BlockBasis


def encode_spectrum(
    x: Floats,
    faces: Integers,
    grids: Sequence[PositionGrid],
    effort: str,
    terms: int | None = None,
    max_error: float | None = None,
    progress: Progress | None = None,
) -> bytes:
    """Write positions (n, d); of several steps (of one origin) the one of the fewest bytes.

    With ``max_error`` vertices that are farther off are corrected.

    Chapter items: P60, P66, P67, P68.
    """
    near = surroundings(faces, len(x))
    blocks = cut_into_blocks(near, len(x), MOST_IN_A_BLOCK[effort])
    most = MOST_IN_A_BLOCK[effort] if terms is None else terms
    roundings = _roundings(x, grids, blocks, near, most, progress)
    return min((_written(x, one, blocks, near, effort, max_error) for one in roundings), key=len)


def _roundings(
    x: Floats,
    grids: Sequence[PositionGrid],
    blocks: Blocks,
    near: Neighbourhood,
    most: int,
    progress: Progress | None,
) -> list[Rounding]:
    """Round the coefficients to each step, and add them up; each basis is made once."""
    n, d = x.shape
    found = [
        Rounding(grid, np.zeros((n, d), np.int64), np.zeros((n, d)), BlockBasis(near))
        for grid in grids
    ]
    least = DEAD_ZONE * min(grid.step for grid in grids)
    local = x - grids[0].origin
    basis = BlockBasis(near)
    for first, last in blocks.each(progress):
        vertices = blocks.vertices[first:last]
        U, c = analyse(local, vertices, basis, least, most)
        for one in found:
            numbers = rounded(c / one.grid.step)
            one.numbers[first : first + len(c)] = numbers
            sum_up(U[:, : length_of(numbers)], numbers, vertices, one.x, one.basis)
    return found


def sum_up(U: Floats, numbers: Integers, vertices: Integers, x: Floats, basis: BlockBasis) -> None:
    """Write what the coefficients add up to, and let the hash depend on the vectors."""
    vectors = np.ascontiguousarray(U)
    basis.note(vectors)
    add_up(vectors, numbers.astype(np.float64), vertices, x)


def _written(
    x: Floats,
    rounding: Rounding,
    blocks: Blocks,
    near: Neighbourhood,
    effort: str,
    max_error: float | None,
) -> bytes:
    """Write one rounding, smoothed as it is best, and corrected where that is needed."""
    d = x.shape[1]
    grid, numbers = rounding.grid, rounding.numbers
    choice = best_choice((x - grid.origin) / grid.step, rounding.x, near)
    found = grid.points(smoothed(rounding.x, near, choice))
    vertices, offsets, step = np.zeros(0, np.int64), np.zeros((0, d), np.int64), 0.0
    if max_error is not None:
        vertices, offsets, step = corrections_for(x, found, max_error)
        found[vertices] += step * offsets
    lengths = np.array([length_of(numbers[a:b]) for a, b in blocks.each()], np.int64)
    terms = int(lengths.max(initial=0))
    bound = float(np.sqrt(((found - x) ** 2).sum(axis=1)).max(initial=0.0)) * (1 + 2.0**-40)
    digest = rounding.basis.digest()
    head = SpectralHead(grid, effort, choice, bound, terms, len(vertices), step, digest)
    coded = _coded(numbers, blocks, lengths, terms)
    data = head.to_bytes() + to_varints([len(coded)]) + coded
    return data + encode_corrections(vertices, offsets)


def _coded(numbers: Integers, blocks: Blocks, lengths: Integers, terms: int) -> bytes:
    """Code the numbers, frequency after frequency."""
    size, k = 4 * numbers.size + 1024, len(lengths)
    while True:
        state, buffer = new_encoder(), np.zeros(size, np.uint8)
        memory, known = new_memory(k, numbers.shape[1]), np.zeros(k, np.int64)
        code_coefficients(
            numbers.copy(), blocks.starts, lengths, terms, 0, memory, state, buffer, known
        )
        data = finished(state, buffer)
        if data is not None:
            return data
        size = int(state[POSITION]) + 1024
