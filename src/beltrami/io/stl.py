"""STL: triangles without shared vertices, text or binary, welded exactly."""

from __future__ import annotations

from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from beltrami._arrays import Floats
from beltrami._jit import kernel
from beltrami.errors import FileFormatError
from beltrami.io.faces import fan
from beltrami.io.numbers import next_line, read_number, skip_blanks
from beltrami.io.source import Source, mark_length, trimmed
from beltrami.io.weld import weld
from beltrami.mesh.mesh import Mesh

_HEADER = 84
_TRIANGLE = np.dtype([("normal", "<f4", (3,)), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_DONE, _NOT_FINITE, _NOT_KEYWORD, _TOO_FEW, _OPEN, _NO_LOOP = range(6)
_EXPECTED = {
    _NOT_FINITE: "a finite number (the coordinate of a vertex)",
    _NOT_KEYWORD: "solid, facet, outer, vertex, endloop, endfacet or endsolid",
    _TOO_FEW: "three vertices or more in a loop",
    _OPEN: "endloop and endsolid",
    _NO_LOOP: "'outer loop' before a vertex, and 'endloop' after it",
}
_WORDS = np.zeros((7, 9), np.uint8)  # each word after its length
for _row, _word in zip(
    _WORDS,
    (b"vertex", b"facet", b"outer", b"endloop", b"endfacet", b"solid", b"endsolid"),
    strict=True,
):
    _row[0] = len(_word)
    _row[1 : 1 + len(_word)] = np.frombuffer(_word, np.uint8)


def read_stl(source: Source) -> Mesh:
    r"""Read an STL file; corners with exactly equal coordinates become one vertex.

    The vertices stand in the order in which they first appear. A file is binary if its size is
    what its count of triangles says, whatever its header begins with. Normals and attributes
    are left out.

    Raises
    ------
    FileFormatError
        With the line or the byte, for what is no such file; also without triangles.

    Examples
    --------
    >>> import numpy as np
    >>> text = (b"solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
    ...         b"vertex 0 1 0\nendloop\nendfacet\nendsolid\n")
    >>> read_stl(Source("triangle.stl", np.frombuffer(text, np.uint8))).faces.tolist()
    [[0, 1, 2]]
    """
    size = len(source.data)
    count = int(source.data[80:84].view("<u4")[0]) if size >= _HEADER else -1
    expected = _HEADER + _TRIANGLE.itemsize * count
    if count >= 0 and size == expected:
        corners, sizes = _read_binary(source, count), np.full(count, 3)
    elif source.data[mark_length(source.data) :][:512].tobytes().lstrip()[:5].lower() == b"solid":
        corners, sizes = _read_text(source)
    elif count < 0:
        raise source.at_byte(
            size, f"expected 'solid' or a header of {_HEADER} bytes, found a file of {size}"
        )
    else:
        raise source.at_byte(
            80,
            f"expected {expected} bytes for the {count} triangles that the header declares, found "
            f"a file of {size}",
        )
    if len(sizes) == 0:
        raise FileFormatError(source.path, "expected faces, found none in the whole file")
    vertices, labels = weld(corners)
    faces = labels.reshape(-1, 3) if len(labels) == 3 * len(sizes) else fan(labels, sizes)
    return Mesh(vertices, faces)


def _read_binary(source: Source, count: int) -> Floats:
    rows = np.frombuffer(source.data, _TRIANGLE, count, _HEADER)
    with np.errstate(invalid="ignore"):  # NaN may be of the signalling kind
        corners = rows["corners"].astype(np.float64).reshape(-1, 3)
    finite = np.isfinite(corners)
    if not finite.all():
        row = int(np.flatnonzero(~finite.all(axis=1))[0]) // 3
        raise source.at_byte(
            _HEADER + _TRIANGLE.itemsize * row,
            f"expected finite coordinates, found NaN or infinity in triangle {row} (from 0)",
        )
    return corners


def _read_text(source: Source) -> tuple[Floats, NDArray[np.int64]]:
    rows = len(source.data) // 12 + 1  # "vertex 0 0 0" is the shortest line of a vertex
    corners, sizes = np.empty((rows, 3)), np.empty(rows, np.int64)
    start = mark_length(source.data)
    position, k, m, status = _scan(source.data[start:], corners, sizes, _WORDS)
    if status != _DONE:
        raise source.unexpected(start + position, _EXPECTED[status])
    return trimmed(corners, k), trimmed(sizes, m)


def write_stl(file: IO[bytes], mesh: Mesh, vertices: Floats) -> None:
    """Write a binary STL file: coordinates are rounded to 32 bits, vertex data are left out.

    Examples
    --------
    >>> import io
    >>> from beltrami.mesh.mesh import Mesh
    >>> mesh = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    >>> file = io.BytesIO()
    >>> write_stl(file, mesh, mesh.vertices)
    >>> len(file.getvalue())
    134
    """
    corners = vertices[mesh.faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.sqrt(np.einsum("fc,fc->f", normals, normals))[:, None]
    rows = np.zeros(mesh.n_faces, _TRIANGLE)
    rows["normal"] = np.divide(normals, length, out=np.zeros_like(normals), where=length > 0)
    rows["corners"] = corners
    file.write(b"binary STL".ljust(80) + np.uint32(mesh.n_faces).astype("<u4").tobytes())
    file.write(rows.tobytes())


@kernel
def _word_at(b: Any, p: int, words: Any) -> Any:
    """Return which word stands at p, in any case, and where it ends; -1 for none of them."""
    for k in range(words.shape[0]):
        length = np.int64(words[k, 0])
        q = p + length
        if q > b.size or (q < b.size and b[q] > 32):
            continue
        same = True
        for i in range(length):
            same = same and (b[p + i] | 32) == words[k, 1 + i]
        if same:
            return k, q
    return -1, p


@kernel
def _scan(b: Any, corners: Any, sizes: Any, words: Any) -> Any:
    """Read all loops: (position, corners, polygons, status)."""
    end = b.size
    p = k = m = first = 0
    inside = closed = False
    while True:
        p = skip_blanks(b, p, end)
        if p >= end:
            return p, k, m, (_DONE if closed and not inside else _OPEN)
        if b[p] == 10:
            p += 1
            continue
        word, q = _word_at(b, p, words)
        if word < 0:
            return p, k, m, _NOT_KEYWORD
        if (word == 0) != inside and (word == 0 or word != 3):
            return p, k, m, _NO_LOOP
        if word == 0:
            for c in range(3):
                p = skip_blanks(b, q, end)
                corners[k, c], q = read_number(b, p, end)
                if q == p or corners[k, c] - corners[k, c] != 0.0:
                    return p, k, m, _NOT_FINITE
            k += 1
        elif word == 2:
            inside, first = True, k
        elif word == 3:
            if k - first < 3 or not inside:
                return p, k, m, _TOO_FEW
            sizes[m] = k - first
            m += 1
            inside = False
        elif word >= 5:
            closed = word == 6
        p = next_line(b, q, end)
