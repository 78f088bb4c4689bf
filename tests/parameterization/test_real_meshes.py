"""Every real surface is mapped without a fold: as it is, cut, and as a sphere less a triangle."""

import os
from pathlib import Path

import numpy as np
import pytest

from beltrami.io.registry import read_mesh
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.repair import repair
from beltrami.parameterization.atlas import atlas
from beltrami.parameterization.parameterize import parameterize

pytestmark = pytest.mark.meshes

FOLDER = os.environ.get("BELTRAMI_MESHES")
DISKS = ("camel-head.off", "face.obj", "circle.obj")
OTHERS = (
    "fertility.off",
    "torus.obj",
    "spot_triangulated.obj",
    "spot_control_mesh.obj",
    "beetle.obj",
    "bun_zipper.ply",
    "halftunnel.off",
    "featuretype.STL",
    "Fandisk0.3/Original.obj",
    "Fandisk0.3/Noisy.obj",
    "nasty/teapot.obj",
    "nasty/hourglass_ico.obj",
    "nasty/fan3.obj",
    "nasty/two-boxes-bad-self-union.ply",
)
SPHERES = ("spot_triangulated.obj", "spot_control_mesh.obj", "Fandisk0.3/Noisy.obj")


def read(name):
    if not FOLDER:
        pytest.skip("BELTRAMI_MESHES names no folder of meshes")
    mesh = read_mesh(Path(FOLDER) / name)
    return repair(mesh, remove_unreferenced=True, remove_degenerate_faces=True).mesh


@pytest.mark.parametrize("name", DISKS)
def test_disks_are_mapped_as_they_are(name):
    psi = parameterize(read(name), cut=False)
    assert psi.is_bijective
    assert psi.distortion.symmetric_dirichlet < 2.5


@pytest.mark.parametrize("name", OTHERS)
def test_others_are_cut(name):
    mesh = read(name)
    psi = parameterize(mesh)
    assert psi.is_bijective
    np.testing.assert_array_equal(psi.vertex_map[psi.mesh.faces], mesh.faces)
    assert psi.distortion.symmetric_dirichlet < 65


@pytest.mark.parametrize("name", SPHERES)
def test_spheres_less_a_triangle(name):
    mesh = read(name)
    psi = parameterize(Mesh(mesh.vertices, mesh.faces[1:]))
    assert psi.is_bijective
    assert psi.distortion.symmetric_dirichlet < 16
    seamed = parameterize(Mesh(mesh.vertices, mesh.faces[1:]), seams=1)
    assert seamed.distortion.symmetric_dirichlet < 4


@pytest.mark.parametrize("name", ["torus.obj", "spot_triangulated.obj", "halftunnel.off"])
def test_free_boundaries(name):
    psi = parameterize(read(name), "free")
    assert psi.is_bijective
    assert psi.distortion.symmetric_dirichlet < 1.3


CHARTED = {  # the most charts that the bound of distortion may take
    "spot_triangulated.obj": 16,
    "Fandisk0.3/Original.obj": 10,
    "halftunnel.off": 8,
    "beetle.obj": 4,
    "circle.obj": 1,
    "nasty/teapot.obj": 40,
    "nasty/hourglass_ico.obj": 6,
    "nasty/fan3.obj": 3,
    "nasty/two-boxes-bad-self-union.ply": 20,
}


@pytest.mark.parametrize("name", CHARTED)
def test_atlases_of_real_surfaces(name):
    found = atlas(read(name), size=512)
    assert found.is_bijective
    assert found.count <= CHARTED[name]
    assert found.chart_distortion.max() <= 1.1 * 1.01
    assert found.fill > 0.35
