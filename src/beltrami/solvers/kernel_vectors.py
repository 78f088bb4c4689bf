"""The kernel of a stiffness that is known beforehand: constants on each component."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_array

from beltrami._arrays import Floats

_ZERO = 1e-10  # a row sum beside the entries of the row


def kernel_vectors(L: csr_array, B: csr_array, root: Floats, most: int) -> Floats:
    """Return (n, c) B-orthonormal vectors, ``root`` on one component each, that L maps to zero.

    A component whose rows do not add to zero (a value is held there) has none. They come in the
    order of the first unknown of each, and no more than ``most`` of them.
    """
    from scipy.sparse.csgraph import connected_components  # heavy

    linked = L.copy()
    linked.eliminate_zeros()
    count, label = connected_components(linked, directed=False)
    image = np.abs(L @ root)
    scale = abs(L) @ root
    wrong = np.zeros(count, np.bool_)
    wrong[label[image > _ZERO * scale]] = True
    kept = np.flatnonzero(~wrong)
    kept = kept[np.argsort(np.unique(label, return_index=True)[1][kept], kind="stable")][:most]
    vectors = (label[:, None] == kept) * root[:, None]
    norm = np.sqrt((vectors * (B @ vectors)).sum(axis=0))
    return np.asarray(vectors / norm)
