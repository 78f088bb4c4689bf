"""A page read back with numpy: what ``display/web`` does in the browser, in a few lines."""

import base64
import json
import re
import zlib
from itertools import pairwise

import numpy as np

from beltrami.mesh.mesh import Mesh

_SAFE = bytes.maketrans(b",.:/", b"<>&`")


def read_page(text):
    """Return the header, and the bytes of each section as (rows, columns) integers."""
    header = json.loads(re.search(r'id="header">(.*?)</script>', text, re.DOTALL)[1])
    found = re.search(r'id="data" data-length="(\d+)">(.*?)</script>', text, re.DOTALL)
    packed = base64.b85decode(found[2].encode().translate(_SAFE))[: int(found[1])]
    data = np.frombuffer(zlib.decompress(packed, -15), np.uint8)
    sections, start = {}, 0
    for entry in header["sections"]:
        shape = entry["planes"], entry["columns"], entry["rows"]
        size = int(np.prod(shape))
        planes = data[start : start + size].reshape(shape).astype(np.int64)
        folded = (planes << (8 * np.arange(shape[0]))[:, None, None]).sum(axis=0).T
        sections[entry["name"]] = np.where(folded % 2 == 0, folded // 2, -(folded // 2) - 1)
        start += size
    assert start == len(data)
    return header, sections


def faces_from(residuals):
    """Undo ``face_residuals``."""
    seen, faces = -1, []
    for first, second, third in residuals.tolist():
        a = seen + 1 - first
        faces.append((a, a - second, a - second - third))
        seen = max(seen, a)
    return np.array(faces)


def values_from(residuals, faces):
    """Undo ``Guesses.residuals``, from the definition: one vertex after the other."""
    n = len(residuals)
    sides = {}  # of each edge: the corners that face it
    for corner in range(3):
        for face in faces.tolist():
            edge = tuple(sorted((face[(corner + 1) % 3], face[(corner + 2) % 3])))
            sides.setdefault(edge, []).append(face[corner])
    parallelograms = {v: [] for v in range(n)}
    neighbours = {v: [] for v in range(n)}
    for (a, b), corners in sides.items():
        neighbours[b].append(a)
        for c, d in pairwise(corners):
            if c > max(b, d):
                parallelograms[c].append((a, b, d))
            if d > max(b, c):
                parallelograms[d].append((a, b, c))
    values = np.zeros_like(residuals)
    for v in range(n):
        guesses = [values[a] + values[b] - values[d] for a, b, d in parallelograms[v]]
        guesses = guesses or [values[a] for a in neighbours[v]] or ([values[v - 1]] if v else [])
        mean = np.sum(guesses, axis=0) // len(guesses) if guesses else 0
        values[v] = residuals[v] + mean
    return values


def moebius(k):
    """A band of 2k vertices with one side."""
    angle = 2 * np.pi * np.arange(k) / k
    rows = [
        np.stack([r * np.cos(angle), r * np.sin(angle), s * np.sin(angle / 2)], axis=1)
        for s in (-0.4, 0.4)
        for r in [1 + s * np.cos(angle / 2)]
    ]
    i = np.arange(k - 1)
    faces = np.concatenate(
        [
            np.stack([i, i + 1, k + i], axis=1),
            np.stack([i + 1, k + i + 1, k + i], axis=1),
            [[k - 1, k, 2 * k - 1], [k, 0, 2 * k - 1]],
        ]
    )
    return Mesh(np.concatenate(rows), faces)
