"""The torus: genus 1, and flat on average."""

from __future__ import annotations

import numpy as np

from beltrami.errors import MeshError
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes.lattice import lattice_faces
from beltrami.mesh.shapes.parameters import positive, whole


def torus(nu: int = 48, nv: int = 24, major: float = 1.0, minor: float = 0.25) -> Mesh:
    """Mesh ((R + r cos v) cos u, (R + r cos v) sin u, r sin v), of genus 1.

    Parameters
    ----------
    nu, nv
        How many vertices around the axis and around the tube, 3 or more: n = nu nv, m = 2 nu nv.
    major, minor
        The radii R of the circle inside the tube and r of the tube, r < R. The area tends to
        4 pi^2 R r and the volume to 2 pi^2 R r^2.

    Returns
    -------
    Mesh
        Closed; vertex i + j nu is at u = 2 pi i / nu, v = 2 pi j / nv; the axis is z.

    Raises
    ------
    MeshError
        If a parameter is out of range.

    Examples
    --------
    >>> torus(3, 3).n_vertices, torus(3, 3).n_faces
    (9, 18)
    """
    nu, nv = whole("nu", nu, least=3), whole("nv", nv, least=3)
    major, minor = positive("major", major), positive("minor", minor)
    if minor >= major:
        raise MeshError(
            f"minor is {minor:g} and major {major:g}: the torus would cross itself",
            remedy="Make minor smaller than major.",
        )
    u = np.tile(2 * np.pi * np.arange(nu) / nu, nv)
    v = np.repeat(2 * np.pi * np.arange(nv) / nv, nu)
    across = major + minor * np.cos(v)
    vertices = np.stack([across * np.cos(u), across * np.sin(u), minor * np.sin(v)], axis=1)
    return Mesh(vertices, lattice_faces(nv, nu, ring=(True, True)))
