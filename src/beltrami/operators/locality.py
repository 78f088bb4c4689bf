"""Whether an operator is local (definition 8)."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.sparse import coo_array, issparse

from beltrami._arrays import rectangular
from beltrami.errors import DimensionError
from beltrami.mesh.door import topology_of
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.topology import Topology


def is_local(operator: Any, domain: Mesh | Topology) -> bool:
    """Whether a_ij = 0 unless i = j or (i, j) is an edge (definition 8).

    The diagonal is allowed, without which neither L nor D would be local (E13). Zeros that are
    stored do not count. Cost: that of sorting the entries.

    Chapter items: D7, D8, P17.

    Parameters
    ----------
    operator
        (n, n) matrix, sparse or dense.
    domain
        The mesh, or its topology.

    Raises
    ------
    DimensionError
        If the matrix is not (n, n).

    Examples
    --------
    >>> from beltrami.mesh.shapes import grid
    >>> from beltrami.operators.laplacian import laplacian
    >>> mesh = grid(5, 5)
    >>> L = laplacian(mesh).stiffness
    >>> is_local(L, mesh), is_local(L @ L, mesh)
    (True, False)
    """
    topology = topology_of(domain)
    n, edges = topology.n_vertices, topology.edges
    given: Any = operator if issparse(operator) else rectangular(operator)
    if given.shape != (n, n):
        raise DimensionError(f"an operator on {n} vertices is ({n}, {n}), not {given.shape}")
    matrix = coo_array(given)
    matrix.sum_duplicates()
    i, j = matrix.coords
    far = (i != j) & (matrix.data != 0)
    low, high = np.minimum(i, j)[far], np.maximum(i, j)[far]
    return bool(np.isin(low.astype(np.int64) * n + high, edges[:, 0] * n + edges[:, 1]).all())
