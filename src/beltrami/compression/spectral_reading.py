"""Coefficients to positions again; a beginning of them to a coarser shape."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Floats, Integers
from beltrami._progress import Progress
from beltrami.compression.block_basis import BlockBasis
from beltrami.compression.blocks import Blocks, cut_into_blocks
from beltrami.compression.coefficients import code_coefficients, new_memory
from beltrami.compression.corrections import decode_corrections
from beltrami.compression.geometry import MOST_COORDINATES
from beltrami.compression.numbers import surroundings
from beltrami.compression.range_coder import new_decoder, readable
from beltrami.compression.smoothing import smoothed
from beltrami.compression.spectral import sum_up
from beltrami.compression.spectral_head import SpectralHead, read_spectral_head
from beltrami.compression.transform import length_of
from beltrami.compression.varint import Reader

_AHEAD = 4  # bytes that a reader of all of them is ahead


def decode_spectrum(
    reader: Reader,
    faces: Integers,
    n: int,
    progress: Progress | None = None,
    is_cut: bool = False,
    most: int = MOST_COORDINATES,
) -> Floats:
    """Read positions (n, d <= most); of bytes that were cut off, what they say of them.

    Chapter items: P58, P66, P68.
    """
    head = read_spectral_head(reader, n, most)
    near = surroundings(faces, n)
    blocks = cut_into_blocks(near, n, head.most)
    length, here = reader.varint(), len(reader.data) - reader.position
    fewer = is_cut and length > here
    data = reader.take(here if fewer else length)
    numbers = _read_numbers(data, blocks, head, fewer, reader)
    basis, x = BlockBasis(near), np.zeros((n, len(head.grid.origin)))
    for first, last in blocks.each(progress):
        own, vertices = numbers[first:last], blocks.vertices[first:last]
        sum_up(basis.vectors(vertices, length_of(own)), own, vertices, x, basis)
    if not fewer and basis.digest() != head.digest:
        raise reader.fault("the basis that the faces give is not the one of the file")
    return _placed(smoothed(x, near, head.choice), head, reader, is_cut)


def _read_numbers(
    data: bytes, blocks: Blocks, head: SpectralHead, is_cut: bool, reader: Reader
) -> Integers:
    """Read the coefficients; of bytes that were cut off those that no later byte can change."""
    k, d = len(blocks.starts) - 1, len(head.grid.origin)
    numbers, known = np.zeros((len(blocks.vertices), d), np.int64), np.zeros(k, np.int64)
    buffer, slack = readable(data), 0 if is_cut else _AHEAD
    state, lengths, memory = new_decoder(buffer), np.zeros(k, np.int64), new_memory(k, d)
    done = code_coefficients(
        numbers, blocks.starts, lengths, head.terms, slack, memory, state, buffer, known
    )
    if not done and not is_cut:
        raise reader.fault("fewer coefficients than it declares")
    if head.terms and not known.all():
        raise reader.fault("cut off before the first coefficient of each block of vertices")
    for (first, last), count in zip(blocks.each(), known.tolist(), strict=True):
        numbers[first + count : last] = 0
    return numbers


def _placed(x: Floats, head: SpectralHead, reader: Reader, is_cut: bool) -> Floats:
    """Return the positions, with the corrections that follow."""
    n, d = x.shape
    with np.errstate(over="ignore", invalid="ignore"):
        placed = head.grid.points(x)
        if not is_cut:
            vertices, numbers = decode_corrections(reader, head.corrections, n, d)
            placed[vertices] += head.correction_step * numbers
    if not np.isfinite(placed).all():
        raise reader.fault("positions beyond the largest number")
    return placed
