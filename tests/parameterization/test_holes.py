"""Holes filled for the map: nothing is torn, and the map is a bijection all the same."""

import numpy as np
import pytest

from beltrami.errors import MeshError, NotADiskError, UnknownNameError
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import cylinder, disk, grid, icosphere, torus
from beltrami.parameterization.certificate import certify
from beltrami.parameterization.holes import fill_holes
from beltrami.parameterization.parameterize import parameterize
from meshes_of_the_errata import cur
from surfaces_to_part import side_by_side


def pierced(mesh, *vertices):
    """Take the faces around some vertices out."""
    kept = ~np.isin(mesh.faces, vertices).any(axis=1)
    used, local = np.unique(mesh.faces[kept], return_inverse=True)
    return Mesh(mesh.vertices[used], local.reshape(-1, 3))


FLAT = pierced(grid(12, 12, dimension=3), 30, 80, 100)
SURFACES = {
    "flat, three holes": FLAT,
    "cylinder": cylinder(12, 4),
    "sphere, three holes": pierced(icosphere(3), 0, 1, 2),
    "torus, two holes": pierced(torus(16, 12), 20, 100),
    "disk": disk(4, dimension=3),
    "closed": icosphere(2),
    "two parts": side_by_side(FLAT, cylinder(12, 4)),
}


@pytest.mark.chapter("P69", "U38")
@pytest.mark.parametrize("method", ["auto", "free"])
@pytest.mark.parametrize("name", SURFACES)
def test_maps_with_holes_are_bijections(name, method):
    mesh = SURFACES[name]
    psi = parameterize(mesh, method, holes="fill")
    assert psi.is_bijective
    assert certify(psi.mesh.topology, psi.uv).is_bijective
    np.testing.assert_array_equal(psi.vertex_map[psi.mesh.faces], mesh.faces)
    np.testing.assert_array_equal(psi.mesh.vertices, mesh.vertices[psi.vertex_map])
    if name not in ("torus, two holes", "closed"):
        assert len(psi.cut_edges) == 0
        assert len(psi.mesh.boundary_loops) == len(mesh.boundary_loops)
    else:  # what closes or has a handle is cut
        assert len(psi.cut_edges) > 0


@pytest.mark.parametrize("name", SURFACES)
def test_what_is_filled_has_one_boundary_at_most(name):
    mesh = SURFACES[name]
    filled = fill_holes(mesh).mesh
    components = filled.topology.n_components
    assert len(filled.boundary_loops) == (0 if name == "closed" else components)
    assert filled.is_oriented
    assert filled.is_manifold
    np.testing.assert_array_equal(filled.vertices[: mesh.n_vertices, :3], mesh.vertices)
    assert filled.face_areas.min() > 0


def test_the_longest_boundary_stays_open():
    cone = cylinder(12, 4)
    x = cone.vertices * (1 + cone.vertices[:, 2:]) ** np.array([1, 1, 0])  # wider above
    filled = fill_holes(Mesh(x, cone.faces)).mesh
    (rim,) = filled.boundary_loops
    assert np.ptp(x[rim, 2]) == 0
    assert x[rim[0], 2] == x[:, 2].max()


def test_a_slit_is_a_hole_too():
    """A hole without area: two copies of the edges of a path."""
    square = grid(6, 6, dimension=3)
    from beltrami.mesh.cut import cut_along

    inner = np.flatnonzero(np.isclose(square.vertices[:, 0], 0.5))[1:-1]
    chosen = np.isin(square.edges, inner).all(axis=1)
    slit = cut_along(square, chosen).mesh
    assert len(slit.boundary_loops) == 2
    psi = parameterize(slit, "free", holes="fill")
    assert psi.is_bijective
    assert psi.distortion.symmetric_dirichlet < 1.01


def test_less_is_torn_and_less_is_distorted():
    torn, whole = (parameterize(FLAT, "free", holes=h) for h in ("cut", "fill"))
    assert len(torn.cut_edges) > 0
    assert len(whole.cut_edges) == 0
    assert whole.distortion.symmetric_dirichlet < 1 + 1e-3
    ring = SURFACES["cylinder"]
    circle = [parameterize(ring, holes=h).distortion.symmetric_dirichlet for h in ("cut", "fill")]
    assert circle[1] < circle[0]


def test_what_needs_no_cut_needs_no_leave():
    assert parameterize(FLAT, holes="fill", cut=False).is_bijective
    with pytest.raises(NotADiskError):
        parameterize(FLAT, cut=False)


def test_bad_treatments_are_told():
    with pytest.raises(UnknownNameError, match="fill"):
        parameterize(FLAT, holes="fil")


def test_the_outer_boundary_is_the_one_that_was_asked_for():
    mesh = pierced(disk(5), 0)
    psi = parameterize(mesh, holes="fill")
    radii = [np.linalg.norm(psi.uv[loop], axis=1) for loop in psi.mesh.boundary_loops]
    np.testing.assert_allclose(radii[0], 1, atol=1e-15)
    assert radii[1].max() < 0.5
    free = parameterize(mesh, "free", holes="fill")  # flat already
    np.testing.assert_allclose(free.distortion.singular_values, 1, atol=1e-3)


def test_relaxation_lets_the_holes_move():
    """The fans are gone by then: they do not hold what they closed."""
    mesh = SURFACES["sphere, three holes"]
    solved = parameterize(mesh, "tutte", "clamped", holes="fill")
    psi = parameterize(mesh, holes="fill")
    assert psi.distortion.symmetric_dirichlet < 0.5 * solved.distortion.symmetric_dirichlet


def test_without_holes_nothing_changes():
    mesh = cur()
    np.testing.assert_array_equal(parameterize(mesh, holes="fill").uv, parameterize(mesh).uv)


def test_vertices_keep_their_numbers_and_their_functions():
    """Also where a cut runs into a filling, so that a vertex loses its first copy with it."""
    for mesh in SURFACES.values():
        mesh = mesh.with_data(number=np.arange(mesh.n_vertices, dtype=float))
        psi = parameterize(mesh, "tutte", holes="fill", strict=False)
        n = np.arange(mesh.n_vertices)
        np.testing.assert_array_equal(psi.vertex_map[: mesh.n_vertices], n)
        np.testing.assert_array_equal(psi.mesh.vertex_data["number"], psi.vertex_map)
        keys = mesh.edges @ [10**6, 1]
        assert np.isin(psi.cut_edges @ [10**6, 1], keys).all()


SHARES = {166: 0.03, 185: 0.25, 190: 0.25, 212: 0.1, 274: 0.1}  # of the faces that are left out


def riddled(seed):
    """A torus with many holes, so that cuts run into them and along them."""
    draw = np.random.default_rng(seed)
    ring = torus(int(draw.integers(6, 12)), int(draw.integers(5, 9)))
    faces = ring.faces[draw.random(ring.n_faces) > SHARES[seed]]
    used, local = np.unique(faces, return_inverse=True)
    return Mesh(ring.vertices[used], local.reshape(-1, 3))


@pytest.mark.parametrize("seed", [166, 190, 212, 274])
def test_pieces_that_only_a_filling_held_together_lie_apart(seed):
    mesh = riddled(seed)
    for method in ("auto", "free"):
        psi = parameterize(mesh, method, holes="fill")
        assert psi.is_bijective
        labels = psi.mesh.topology.components("edges")
        assert labels.max() == psi.mesh.components().max() > 0
        np.testing.assert_array_equal(psi.vertex_map[psi.mesh.faces], mesh.faces)
        np.testing.assert_array_equal(psi.vertex_map[: mesh.n_vertices], np.arange(mesh.n_vertices))


def test_no_hole_turns_inside_out_while_it_relaxes():
    """Here two edges of a hole would sweep over each other in one step, and cross nothing."""
    assert parameterize(riddled(185), holes="fill").is_bijective


def test_corners_are_vertices_of_the_surface_not_of_a_filling():
    mesh = SURFACES["torus, two holes"]
    n = mesh.n_vertices
    for vertex in (n, n + 1, n + 2):
        with pytest.raises(MeshError, match=f"corners outside 0..{n - 1} ") as caught:
            parameterize(mesh, boundary=3, bulge=0.02, corners=[0, 1, vertex], holes="fill")
        assert caught.value.vertices.tolist() == [vertex]
    ring = SURFACES["cylinder"]
    (outer,) = fill_holes(ring).mesh.boundary_loops
    psi = parameterize(ring, boundary=3, bulge=0.02, corners=outer[[0, 3, 7]], holes="fill")
    assert psi.is_bijective
    (inner,) = (loop for loop in ring.boundary_loops if loop[0] not in outer)
    with pytest.raises(MeshError, match="not on the boundary"):
        parameterize(ring, boundary=3, bulge=0.02, corners=inner[[0, 3, 7]], holes="fill")
