"""The edges of faces by a dictionary: the plain version of what pairs them."""

from __future__ import annotations


def sides_of(faces):
    """Each edge (i < j), in lexicographic order, with its sides (h, start, end) ascending.

    Side h = 3 f + c is the one opposite corner c of face f, which runs from start to end. Faces
    that name a vertex twice have none.
    """
    found = {}
    for f, face in enumerate(faces.tolist()):
        if len(set(face)) == 3:
            for c in range(3):
                start, end = face[(c + 1) % 3], face[(c + 2) % 3]
                edge = min(start, end), max(start, end)
                found.setdefault(edge, []).append((3 * f + c, start, end))
    return dict(sorted(found.items()))
