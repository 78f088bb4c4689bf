"""Shape-DNA against LaPy's, where it is installed."""

import numpy as np
import pytest

from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.fourier_basis import fourier_basis
from beltrami.spectrum.shape_dna import shape_dna
from meshes_of_the_errata import MESHES

shapedna = pytest.importorskip("lapy.shapedna")


@pytest.mark.parametrize("name", ["closed", "obt", "tor"])
def test_normalized_by_the_area(name):
    from lapy import TriaMesh

    mesh = MESHES[name]()
    triangles = TriaMesh(np.array(mesh.vertices), np.array(mesh.faces))
    values = shapedna.compute_shapedna(triangles, k=12)["Eigenvalues"]
    theirs = shapedna.normalize_ev(triangles, values)
    ours = shape_dna(fourier_basis(laplacian(mesh, mass="consistent"), 12))
    np.testing.assert_allclose(ours, theirs, rtol=1e-4, atol=1e-3)  # theirs: single precision
