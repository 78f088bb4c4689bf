"""parameterize: a certified bijection of whatever comes in, or a clear error."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from beltrami.errors import (
    BoundaryCurveError,
    DegenerateFaceError,
    DimensionError,
    EmptyMeshError,
    FoldedMapError,
    MeshError,
    NonFiniteError,
    NotADiskError,
    NotOrientableError,
    UnknownNameError,
    UnreferencedVertexError,
)
from beltrami.io.registry import read_mesh, write_mesh
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.repair import repair
from beltrami.mesh.shapes import blob, cylinder, disk, icosphere, tetrahedron, torus
from beltrami.mesh.tree_cotree import cut_to_disk
from beltrami.parameterization.atlas import atlas
from beltrami.parameterization.certificate import certify
from beltrami.parameterization.flatten import flatten
from beltrami.parameterization.parameterize import parameterize
from made_once import MadeOnce, creature
from meshes_of_the_errata import bad, cur, flipped
from strategies import arrays, hull, moebius, ring_torus, sheet


def tube(around, along):
    """A closed tube with one triangle of its end removed: far from any disk."""
    mesh = cylinder(around, along, height=along * 2 * np.pi / around, caps=True)
    return Mesh(mesh.vertices, mesh.faces[:-1])


SURFACES = MadeOnce(
    {
        "disk": disk(4),
        "curved sheet": cur(),
        "not Delaunay": bad(),
        "sphere": icosphere(2),
        "tetrahedron": tetrahedron(),
        "torus": torus(16, 12),
        "cylinder": cylinder(16, 5),
        "one triangle": Mesh(np.eye(3), [[0, 1, 2]]),
        "sphere less a triangle": Mesh(icosphere(3).vertices, icosphere(3).faces[1:]),
        "blob": lambda: creature(1500),
    }
)


@pytest.mark.chapter("T21", "U38", "P69")
@pytest.mark.parametrize("name", SURFACES)
def test_any_surface_is_mapped_without_a_fold(name):
    mesh = SURFACES[name]
    psi = parameterize(mesh)
    assert psi.is_bijective
    assert len(psi.flipped) == 0
    assert certify(psi.mesh.topology, psi.uv).is_bijective
    np.testing.assert_array_equal(psi.vertex_map[psi.mesh.faces], mesh.faces)
    rim = psi.uv[psi.mesh.topology.boundary_loops[0]]
    np.testing.assert_allclose(np.linalg.norm(rim, axis=1), 1, atol=1e-15)
    assert psi.distortion.symmetric_dirichlet >= 1


@given(arrays(hull, ring_torus, sheet), st.sampled_from(["circle", 3]))
@settings(max_examples=40)
def test_meshes_nobody_thought_of(pair, boundary):
    x, faces = pair
    used, local = np.unique(faces, return_inverse=True)
    mesh = Mesh(x[used], local.reshape(-1, 3))
    try:
        psi = parameterize(mesh, boundary=boundary)
    except BoundaryCurveError:
        assert boundary != "circle"
    except DegenerateFaceError:
        pass
    else:
        assert psi.is_bijective


def test_auto_is_better_than_one_solve():
    for mesh in (SURFACES["sphere less a triangle"], SURFACES["blob"], cur()):
        once = parameterize(mesh, "tutte", "clamped").distortion.symmetric_dirichlet
        mean_value = parameterize(mesh, "tutte").distortion.symmetric_dirichlet
        assert parameterize(mesh).distortion.symmetric_dirichlet < min(once, mean_value)


def test_components_lie_apart_in_the_proportion_of_their_areas():
    one, other = icosphere(2), torus(12, 8)
    x = np.concatenate([one.vertices * 3, other.vertices])
    mesh = Mesh(x, np.concatenate([one.faces, other.faces + one.n_vertices]))
    psi = parameterize(mesh)
    assert psi.is_bijective
    labels = mesh.components()
    image = psi.flat.face_areas
    density = np.bincount(labels, image) / np.bincount(labels, mesh.face_areas)
    assert density[0] == pytest.approx(density[1], rel=1e-12)
    # put at the same place they are no bijection: it is the layout that makes it one
    moved = psi.uv.copy()
    own = np.unique(psi.mesh.faces[labels == 1])
    moved[own] -= moved[own].mean(axis=0) - moved[psi.mesh.faces[0]].mean(axis=0)
    assert not certify(psi.mesh.topology, moved).is_bijective


def test_other_weights_are_tried_where_the_map_is_bad():
    """A tube so long that cotangents alone fold, and other positive weights do not."""
    mesh = tube(12, 240)
    assert len(parameterize(mesh, weights="clamped", cut=False, strict=False).flipped) > 0
    psi = parameterize(mesh, cut=False)
    assert psi.is_bijective
    assert "Schnyder" not in psi.method
    alone = parameterize(mesh, weights="mean_value", cut=False).distortion.symmetric_dirichlet
    assert psi.distortion.symmetric_dirichlet <= alone


def test_where_the_map_of_a_coarser_mesh_is_singular_there_is_another_way():
    """Of 7,226 vertices, so that a coarser mesh comes first; its weights leave doubles."""
    psi = parameterize(tube(12, 600), cut=False)
    assert psi.is_bijective
    assert "Schnyder" in psi.method


def test_a_seam_saves_what_rounding_folds():
    """One Tutte solve of a long tube folds: areas shrink beyond the range of doubles."""
    mesh = tube(6, 200)
    once = parameterize(mesh, "tutte", "clamped", strict=False)
    assert len(once.flipped) > 100
    assert not once.is_bijective
    with pytest.raises(FoldedMapError) as caught:
        parameterize(mesh, "tutte", "clamped")
    np.testing.assert_array_equal(caught.value.faces, once.flipped)
    psi = parameterize(mesh)
    assert psi.is_bijective
    assert len(psi.cut_edges) > 150


def test_seams_lower_the_distortion():
    mesh = SURFACES["sphere less a triangle"]
    plain, cut = parameterize(mesh), parameterize(mesh, seams=1)
    assert len(plain.cut_edges) == 0
    assert len(cut.cut_edges) > 3
    assert cut.is_bijective
    assert cut.distortion.symmetric_dirichlet < 0.6 * plain.distortion.symmetric_dirichlet


@pytest.mark.chapter("P74")
@pytest.mark.parametrize("seed", [1, 3, 8])
def test_negative_weights_fold_and_are_not_hidden(seed):
    """E90: cotangents of a stretched sheet; all other weights are positive, and do not fold."""
    mesh = flipped(seed, 40, 10)
    psi = parameterize(mesh, "tutte", "cotangent", strict=False)
    assert len(psi.flipped)
    assert "NOT a bijection" in repr(psi)
    with pytest.raises(FoldedMapError) as caught:
        parameterize(mesh, "tutte", "cotangent")
    np.testing.assert_array_equal(caught.value.faces, psi.flipped)
    for weights in ("combinatorial", "distance", "mean_value", "clamped"):
        assert parameterize(mesh, "tutte", weights).is_bijective
    assert parameterize(mesh).is_bijective
    assert parameterize(mesh, weights="mean_value").is_bijective


@pytest.mark.chapter("P71")
def test_texture_coordinates_reach_a_file_and_stay_certified(tmp_path):
    mesh = torus(12, 8)
    psi = parameterize(mesh)
    write_mesh(tmp_path / "torus.obj", psi.textured)
    back = read_mesh(tmp_path / "torus.obj")
    np.testing.assert_array_equal(back.faces, mesh.faces)  # no vertex was doubled
    np.testing.assert_array_equal(back.corner_uv, psi.uv[psi.mesh.faces])


@pytest.mark.chapter("P71")
def test_functions_go_along():
    mesh = icosphere(2)
    f = mesh.vertices[:, 2]
    psi = parameterize(mesh.with_data(f=f))
    np.testing.assert_array_equal(psi.flat.vertex_data["f"], f[psi.vertex_map])
    np.testing.assert_array_equal(psi.flat.vertices, psi.uv)


@pytest.mark.parametrize(("unit", "bound"), [(1e-9, 1e-9), (2.0**-40, 0), (1e9, 1e-9)])
def test_the_unit_of_length_does_not_matter(unit, bound):
    """Not at all, if it is a power of 4: then no coordinate is rounded, nor what is made of it."""
    mesh = blob(1500)
    psi, scaled = parameterize(mesh), parameterize(mesh.with_vertices(mesh.vertices * unit))
    np.testing.assert_allclose(scaled.uv, psi.uv, rtol=0, atol=bound)
    assert scaled.distortion.symmetric_dirichlet == pytest.approx(
        psi.distortion.symmetric_dirichlet, rel=1e-6
    )


def test_nothing_given_is_changed():
    mesh = torus(8, 6)
    x, faces = mesh.vertices.copy(), mesh.faces.copy()
    psi = parameterize(mesh)
    np.testing.assert_array_equal(mesh.vertices, x)
    np.testing.assert_array_equal(mesh.faces, faces)
    assert not psi.uv.flags.writeable


def test_bad_input():
    sphere = icosphere(1)
    with pytest.raises(NotADiskError) as caught:
        parameterize(sphere, cut=False)
    assert len(caught.value.edges)
    assert parameterize(disk(2), cut=False).is_bijective
    with pytest.raises(NotOrientableError):
        parameterize(Mesh(*moebius(np.random.default_rng(0), 8)))
    with pytest.raises(EmptyMeshError):
        parameterize(Mesh(np.zeros((0, 3)), np.zeros((0, 3), int)))
    with pytest.raises(UnreferencedVertexError):
        parameterize(Mesh(np.eye(4, 3), [[0, 1, 2]]))
    with pytest.raises(DegenerateFaceError):
        parameterize(Mesh([[0, 0], [1, 1], [2, 2]], [[0, 1, 2]]))
    with pytest.raises(NonFiniteError):
        parameterize(Mesh([[0, 0], [1, np.inf], [2, 2]], [[0, 1, 2]]))
    with pytest.raises(UnknownNameError, match="tutte"):
        parameterize(sphere, "tuttle")
    with pytest.raises(UnknownNameError):
        parameterize(sphere, weights="uniform")
    with pytest.raises(UnknownNameError):
        parameterize(sphere, boundary="circel")
    with pytest.raises(BoundaryCurveError):
        parameterize(disk(2), boundary=[[0, 0], [1, 0], [0.4, 0.4], [0, 1]])
    for function in (parameterize, flatten, cut_to_disk):
        with pytest.raises(DimensionError, match="a Mesh is needed"):
            function((sphere.vertices, sphere.faces))
    for seams in (-1, 1.5, "two", True):
        with pytest.raises(MeshError, match="seams"):
            parameterize(sphere, seams=seams)
        with pytest.raises(MeshError, match="seams"):
            atlas(sphere, seams=seams)
    with pytest.raises(UnknownNameError, match="spacing"):
        parameterize(sphere, "spectral_conformal", spacing="even")


def test_seams_that_do_not_pay_change_nothing():
    """Maps are compared roughly, but the one that is kept is relaxed to the last."""
    ball = icosphere(3)
    cap = Mesh(ball.vertices, ball.faces[(ball.vertices[ball.faces][:, :, 2] > 0.6).all(axis=1)])
    cap = repair(cap, remove_unreferenced=True).mesh
    plain, tried = parameterize(cap, "free"), parameterize(cap, "free", seams=1)
    assert len(tried.cut_edges) == 0
    energy = plain.distortion.symmetric_dirichlet
    assert tried.distortion.symmetric_dirichlet == pytest.approx(energy, rel=1e-3)
