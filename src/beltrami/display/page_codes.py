"""Numbers as small residuals, which deflate packs: the other half is in ``web/codes.js``.

An integer at a vertex is guessed from those at the vertices before it: the mean, rounded down, of
a + b - c over the faces (a, b, v) whose neighbour across the side (a, b) has a third vertex c
before v too (Touma and Gotsman 1998). Functions that vary slowly leave 2 bits for each value.
Huffman's code alone packs those better, and much faster, than a search for repetitions;
planes of bytes that are nearly all 0 want runs.
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array

from beltrami._arrays import Floats, Integers
from beltrami.display.page_order import pair_faces
from beltrami.errors import MeshError

_MOST_PLANES = 4


@dataclass(frozen=True, eq=False)
class Guesses:
    """How the value at each vertex is guessed from those before it.

    Attributes
    ----------
    sums : (n, n) csr_array of int
        Its product with the values, divided by ``counts`` and rounded down, is the guess.
    counts : (n,) int
        At least 1.
    """

    sums: csr_array
    counts: Integers

    def residuals(self, values: Integers) -> Integers:
        """Return (n, c) what the guesses miss of the values (n, c)."""
        guess = np.asarray(self.sums @ values) // self.counts[:, None]
        return np.asarray(values - guess, np.int64)


def guesses_of(faces: Integers, n: int) -> Guesses:
    """Make the guesses: parallelograms, else the mean of neighbours, else the vertex before."""
    pairs = pair_faces(faces, n)
    rows, columns, signs = [], [], []
    counts = np.zeros(n, np.int64)
    for new, old in ((pairs.c, pairs.d), (pairs.d, pairs.c)):
        known = (new > pairs.b) & (new > old)
        v = new[known]
        counts += np.bincount(v, minlength=n)
        rows += [v, v, v]
        columns += [pairs.a[known], pairs.b[known], old[known]]
        signs += [np.ones(len(v)), np.ones(len(v)), -np.ones(len(v))]
    ends = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    edges = np.unique(np.sort(ends, axis=1), axis=0)
    edges = edges[(counts[edges[:, 1]] == 0) & (edges[:, 0] != edges[:, 1])]
    counts += np.bincount(edges[:, 1], minlength=n)
    alone = np.flatnonzero(counts == 0)
    alone = alone[alone > 0]
    rows += [edges[:, 1], alone]
    columns += [edges[:, 0], alone - 1]
    signs += [np.ones(len(edges)), np.ones(len(alone))]
    where = np.concatenate(rows), np.concatenate(columns)
    sums = coo_array((np.concatenate(signs).astype(np.int64), where), shape=(n, n)).tocsr()
    return Guesses(csr_array(sums), np.maximum(counts, 1))


def quantized(values: Floats, steps: Floats) -> Integers:
    """Return (n, c) whole numbers of steps, one step for each column; 0 where it is 0."""
    return np.asarray(np.rint(values / np.where(steps > 0, steps, 1.0)), np.int64)


def planes_of(residuals: Integers) -> tuple[bytes, int]:
    r"""Fold signed integers into 0, -1, 1, -2 ... and list their bytes: all first ones, then on.

    Columns follow each other, so that numbers of one kind are together.

    Examples
    --------
    >>> planes_of(np.array([[0, -1], [1, 200]]))
    (b'\x00\x02\x01\x90\x00\x00\x00\x01', 2)
    """
    flat = np.ascontiguousarray(residuals.T).ravel().astype(np.int64)
    folded = np.where(flat >= 0, 2 * flat, -2 * flat - 1).astype("<u8")
    count = max(1, (int(folded.max(initial=0)).bit_length() + 7) // 8)
    split: NDArray[np.uint8] = folded.view(np.uint8).reshape(-1, 8)[:, :count]
    return split.T.tobytes(), count


@dataclass(frozen=True)
class Sections:
    """The binary part of a page: bytes one after the other, and a list that says what they are."""

    entries: list[dict[str, Any]] = field(default_factory=list)
    parts: list[bytes] = field(default_factory=list)

    def add(self, name: str, residuals: Integers) -> None:
        """Append a table of residuals, (rows, columns).

        Raises
        ------
        MeshError
            If there are more than four planes: the page computes with 32 bits.
        """
        data, planes = planes_of(residuals)
        if planes > _MOST_PLANES:
            raise MeshError(
                f"{name} of a page differ by more than 2^31 steps",
                remedy="Leave out parts that are far away, or take less noise.",
            )
        rows, columns = residuals.shape
        self.entries.append({"name": name, "rows": rows, "columns": columns, "planes": planes})
        self.parts.append(data)

    def add_bytes(self, name: str, data: bytes) -> None:
        """Append bytes that mean something to others, such as a picture."""
        self.entries.append({"name": name, "rows": len(data), "columns": 1, "planes": 1})
        self.parts.append(data)

    def packed(self) -> bytes:
        """Return all bytes, deflated (RFC 1951, without a header)."""
        planes = [
            part[i * size : (i + 1) * size]
            for entry, part in zip(self.entries, self.parts, strict=True)
            for i, size in enumerate([entry["rows"] * entry["columns"]] * entry["planes"])
        ]
        return b"".join(map(_deflated, planes)) + zlib.compressobj(wbits=-15).flush()


def _deflated(data: bytes) -> bytes:
    """Deflate with the strategy that packs best; such pieces may follow each other."""
    tries = []
    for strategy in (zlib.Z_HUFFMAN_ONLY, zlib.Z_RLE, zlib.Z_FILTERED):
        packer = zlib.compressobj(6, zlib.DEFLATED, -zlib.MAX_WBITS, 9, strategy)
        tries.append(packer.compress(data) + packer.flush(zlib.Z_SYNC_FLUSH))
    return min(tries, key=len)


def face_residuals(faces: Integers) -> Integers:
    """(m, 3) small numbers for faces in the order of ``order_of``.

    The first is 0 where the first corner is a new vertex, else how far it is behind the next
    new one; the others are differences to the corner before.
    """
    first = faces[:, 0]
    seen = np.maximum.accumulate(np.concatenate([[-1], first]))[:-1]
    return np.stack([seen + 1 - first, first - faces[:, 1], faces[:, 1] - faces[:, 2]], axis=1)
