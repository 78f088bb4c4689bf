"""flatten: two eigenvectors as coordinates (section 3.3.8), and how often they fold."""

from __future__ import annotations

import numpy as np

from beltrami._arrays import Floats, read_only
from beltrami.errors import check_name
from beltrami.mesh.cut import Cut
from beltrami.mesh.door import require_mesh
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.requirements import require_manifold, require_oriented
from beltrami.operators.laplacian import laplacian
from beltrami.operators.soundness import refuse_unreferenced, require_sound
from beltrami.parameterization.layout import part_of, side_by_side
from beltrami.parameterization.parameterization import Parameterization, certified
from beltrami.parameterization.predicates import orientation
from beltrami.spectrum.fourier_basis import fourier_basis

FORMS = ("areas", "degree", "printed")


def flatten(mesh: Mesh, form: str = "areas", weights: str = "cotangent") -> Parameterization:
    r"""Draw a surface with two eigenvectors as coordinates; boundaries are free (theorem 22).

    Of all pairs of functions with unit variance, mean zero and no correlation they have the least
    energy, :math:`\lambda_2 + \lambda_3`. The text minimises :math:`\|\tilde G\psi_1\|^2 +
    \|\tilde G\psi_2\|^2` with :math:`\langle\psi_i, 1\rangle = 0`, where :math:`D^{1/2}1` is
    needed (E92), and names :math:`u_1, u_2` as the solution, where it is :math:`u_2, u_3` (E93).

    It is not a bijection unless the surface is nearly flat and nearly round: the result says how
    many faces fold, and never raises on them. ``parameterize`` does not fold.

    Chapter items: U40, T22, P75, P76.

    Parameters
    ----------
    mesh
        An oriented manifold; it is not cut.
    form
        ``"areas"``: :math:`L\varphi = \lambda B\varphi` with the areas of the vertices; the best
        of the three. ``"degree"``: :math:`D^{-1/2}u_2, D^{-1/2}u_3` for the eigenvectors u of the
        normalised Laplacian. ``"printed"``: :math:`u_2, u_3` themselves, which carry a factor
        :math:`\sqrt{d_i}` that jumps from vertex to vertex (E94).
    weights
        As in ``laplacian``.

    Returns
    -------
    Parameterization
        Coordinates of mean 0 and variance 1 in the mass (the text's :math:`\|\psi\| = 1` is the
        variance 1/n), mirrored if that makes more faces counter-clockwise. Components lie side by
        side, each with its own eigenvectors.

    Raises
    ------
    NotManifoldError, NotOrientableError
        If the surface is not an oriented manifold, so that nothing could be said of folds.
    EmptyMeshError, NonFiniteError, DegenerateFaceError, UnreferencedVertexError
        If the mesh is not sound.

    Notes
    -----
    Where :math:`\lambda_3 = \lambda_4` the plane is not unique, as on a sphere. Across
    the boundary both functions have slope 0, so that thin faces there may fold even on a flat
    square. Cost: that of three eigenpairs.

    Examples
    --------
    >>> from beltrami.mesh.shapes import cylinder, grid
    >>> flatten(grid(8, 7)).is_bijective
    True
    >>> len(flatten(cylinder(12, 30, height=20)).flipped) > 0  # along the axis, twice
    True
    """
    check_name("form of flattening", form, FORMS)
    require_mesh(mesh, "flattening")
    require_sound(mesh)
    if not mesh.topology.referenced.all():
        refuse_unreferenced(mesh.topology)
    require_manifold(mesh.topology, "the surface is not a manifold")
    require_oriented(
        mesh.topology,
        "neighbouring faces disagree on which side is outside",
        "The surface has one side only, and folds are not defined.",
    )
    labels = mesh.components()
    uv = np.zeros((mesh.n_vertices, 2))
    for component in range(int(labels.max()) + 1):
        part, number = part_of(mesh, labels == component)
        uv[number] = _coordinates(part, form, weights)
    uv = side_by_side(mesh, uv, labels)
    whole = Cut(mesh, read_only(np.arange(mesh.n_vertices)), mesh.edges[:0])
    return certified(mesh, whole, uv, f"flattened, {form}, {weights} weights", strict=False)


def _coordinates(part: Mesh, form: str, weights: str) -> Floats:
    """Return the two eigenfunctions after the constant one, with unit variance."""
    pair = laplacian(part, weights, "barycentric" if form == "areas" else "degree")
    psi = fourier_basis(pair, 3).eigenvectors[:, 1:]
    if form == "printed":
        psi = psi * np.sqrt(pair.degrees)[:, None] * np.sqrt(part.n_vertices)
    else:
        psi = psi * np.sqrt(pair.mass.sum())
    a, b, c = psi[part.faces].transpose(1, 0, 2)
    return psi * [1, -1] if orientation(a, b, c).sum(dtype=np.int64) < 0 else psi
