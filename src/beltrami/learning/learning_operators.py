"""learning_operators: from a mesh to the arrays that networks on surfaces want."""

from __future__ import annotations

import os

from beltrami._arrays import whole
from beltrami._kinds import checked
from beltrami.errors import check_name
from beltrami.learning.cache import entry, keep, kept
from beltrami.learning.operators import LearningOperators
from beltrami.learning.tangent import tangent_frames, tangent_gradient
from beltrami.mesh.door import require_mesh
from beltrami.mesh.mesh import Mesh
from beltrami.operators.gradient import face_gradient
from beltrami.operators.laplacian import laplacian
from beltrami.operators.pair import INTRINSIC, MASSES, TUFTED
from beltrami.operators.weights import SYMMETRIC_WEIGHTS
from beltrami.spectrum.fourier_basis import fourier_basis

LEARNING_WEIGHTS = (*SYMMETRIC_WEIGHTS, INTRINSIC, TUFTED)
LEARNING_MASSES = tuple(kind for kind in MASSES if kind != "consistent")


@checked
def learning_operators(
    mesh: Mesh,
    k: int = 128,
    *,
    weights: str = "cotangent",
    mass: str = "voronoi",
    cache: str | os.PathLike[str] | None = None,
) -> LearningOperators:
    """Return masses, stiffness, gradients and k eigenpairs for DiffusionNet and its like.

    Parameters
    ----------
    mesh
        A sound mesh in R² or R³.
    k
        How many eigenpairs, at most n.
    weights, mass
        As in ``laplacian``; the mass is a diagonal one. ``"tufted"`` weights take meshes that are
        no manifolds best.
    cache
        A folder in which the operators are kept, under the SHA-256 of the positions, the faces
        and the parameters; it is made if need be. What is there already is read instead of
        computed, with the same bits. Several processes may use one folder. A damaged file is
        told by a RuntimeWarning, and made anew.

    Returns
    -------
    LearningOperators
        Float64, read-only; ``to("torch")`` makes tensors of them.

    Raises
    ------
    EmptyMeshError, NonFiniteError, DegenerateFaceError, UnreferencedVertexError
        If the mesh is not sound.
    MeshError
        If the normals around a vertex cancel, so that it has no tangent plane.
    DimensionError
        If the vertices have more than three coordinates.
    UnknownNameError
        If a name is misspelt; the error lists the right ones.
    OSError
        If the folder cannot be written.

    Notes
    -----
    The cost is that of ``fourier_basis``; a file has 8 n k + 400 n bytes. The eigenvectors of a
    multiple eigenvalue are one basis of many, and the frames turn when the mesh is turned: a
    network has to bear both. N. Sharp, S. Attaiki, K. Crane and M. Ovsjanikov 2022,
    "DiffusionNet: discretization agnostic learning on surfaces".

    Examples
    --------
    >>> from beltrami.mesh.shapes import icosphere
    >>> operators = learning_operators(icosphere(2), 9)
    >>> operators, operators.gradient_x.shape, operators.face_gradient.shape
    (<LearningOperators: 162 vertices, 9 eigenpairs>, (162, 162), (960, 162))
    """
    require_mesh(mesh, "learning operators")
    count = whole("k", k, 1)
    check_name("weights", weights, LEARNING_WEIGHTS)
    check_name("diagonal mass", mass, LEARNING_MASSES)
    place = None if cache is None else entry(cache, mesh, count, weights, mass)
    found = None if place is None else kept(place, mesh, count)
    if found is not None:
        return found
    made = _made(mesh, count, weights, mass)
    if place is not None:
        keep(place, made)
    return made


def _made(mesh: Mesh, k: int, weights: str, mass: str) -> LearningOperators:
    in_faces = face_gradient(mesh)  # first: it looks whether the mesh is sound
    pair = laplacian(mesh, weights, mass)
    frames = tangent_frames(mesh)
    basis = fourier_basis(pair, k)
    return LearningOperators(
        frames,
        pair.masses,
        pair.stiffness,
        basis.eigenvalues,
        basis.eigenvectors,
        *tangent_gradient(mesh, frames),
        in_faces,
    )
