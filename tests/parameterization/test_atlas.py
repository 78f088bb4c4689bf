"""atlas: certified charts of any surface, alike in scale, in one square."""

import functools

import numpy as np
import pytest
from hypothesis import given, settings

from beltrami.errors import FoldedMapError, MeshError, NotOrientableError, UnknownNameError
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import cube, cylinder, grid, icosphere, tetrahedron, torus
from beltrami.parameterization.atlas import atlas
from beltrami.parameterization.certificate import certify
from beltrami.parameterization.distortion import distortion
from made_once import MadeOnce, creature
from strategies import arrays, hull, moebius, ring_torus, sheet
from surfaces_to_part import side_by_side, two_holes

SURFACES = MadeOnce(
    {
        "sphere": icosphere(2),
        "torus": torus(16, 12),
        "genus 2": two_holes(),
        "cube": cube(4),
        "cylinder": cylinder(16, 5),
        "square": grid(6, 6),
        "blob": lambda: creature(500),
        "tetrahedron": tetrahedron(),
        "two parts": side_by_side(icosphere(2), torus(12, 8)),
        "triangle": Mesh(np.eye(3), [[0, 1, 2]]),
    }
)


@functools.cache
def of(name, size=256):
    return atlas(SURFACES[name], size=size)


@pytest.mark.chapter("P69", "P71")
@pytest.mark.parametrize("name", SURFACES)
def test_any_surface_gets_a_certified_atlas(name):
    mesh = SURFACES[name]
    found = of(name)
    assert found.is_bijective
    cut = found.map
    assert certify(cut.mesh.topology, cut.uv).is_bijective
    np.testing.assert_array_equal(cut.vertex_map[cut.mesh.faces], mesh.faces)
    np.testing.assert_array_equal(cut.uv[cut.mesh.faces], found.uv)
    np.testing.assert_array_equal(found.mesh.corner_uv, found.uv)
    assert found.uv.min() >= 2 / 256
    assert found.uv.max() <= 1 - 2 / 256
    assert np.unique(found.labels).tolist() == list(range(found.count))
    assert found.chart_distortion.max() <= 1.1 * 1.01
    assert 0.2 < found.fill < 1


@pytest.mark.chapter("P71")
def test_charts_are_apart_and_faces_of_one_hang_together():
    found = of("blob")
    opened = found.map.mesh
    charts = opened.components()
    pairs = np.unique(np.stack([charts, found.labels], axis=1), axis=0)
    assert len(pairs) == found.count == charts.max() + 1


@pytest.mark.chapter("P71")
def test_texels_are_alike_in_all_charts():
    found = atlas(SURFACES["two parts"], size=512)
    np.testing.assert_allclose(found.density, found.density[0], rtol=1e-5)
    assert found.count > 2
    np.testing.assert_allclose(
        found.density[0] ** 2 * SURFACES["two parts"].area, found.fill * 512**2, rtol=1e-5
    )


@pytest.mark.chapter("P69")
def test_seams_are_the_edges_whose_sides_lie_apart():
    mesh = SURFACES["torus"]
    found = of("torus")
    place = {}
    cut = set()
    for f, face in enumerate(mesh.faces.tolist()):
        for c in range(3):
            i, j = face[c], face[(c + 1) % 3]
            ends = tuple(map(tuple, found.uv[f, [c, (c + 1) % 3]].tolist()))
            key, ends = (i, j) if i < j else (j, i), ends if i < j else ends[::-1]
            if place.setdefault(key, ends) != ends:
                cut.add(key)
    assert {tuple(edge) for edge in found.seams.tolist()} == cut


def test_coordinates_are_the_same_in_single_precision():
    found = of("sphere")
    np.testing.assert_array_equal(found.uv.astype(np.float32).astype(np.float64), found.uv)
    np.testing.assert_array_equal((1 - found.uv).astype(np.float32), 1 - found.uv)


@pytest.mark.parametrize("bound", [1.5, 1.03, 1.003])
def test_less_distortion_takes_more_charts(bound):
    ball = icosphere(3)
    few, many = atlas(ball, max_distortion=2.0), atlas(ball, max_distortion=bound)
    assert many.count >= few.count
    for chart in range(many.count):
        own = many.labels == chart
        number, local = np.unique(many.map.mesh.faces[own], return_inverse=True)
        part = Mesh(many.map.mesh.vertices[number], local.reshape(-1, 3))
        assert distortion(part, many.map.uv[number]).symmetric_dirichlet <= bound + 1e-4
    assert (many.count > 2) == (bound < 1.035)  # halves of a sphere have 1.035


def test_a_flat_square_is_one_chart_without_distortion():
    found = atlas(grid(6, 6))
    assert found.count == 1
    assert len(found.seams) == 0
    np.testing.assert_allclose(found.distortion.symmetric_dirichlet, 1, atol=1e-4)


def test_charts_may_have_the_holes_of_the_surface():
    mesh = grid(12, 12, dimension=3)
    kept = ~np.isin(mesh.faces, [30, 80, 100]).any(axis=1)
    used, local = np.unique(mesh.faces[kept], return_inverse=True)
    pierced = Mesh(mesh.vertices[used], local.reshape(-1, 3))
    whole = atlas(pierced, size=256)
    assert (whole.count, len(whole.seams)) == (1, 0)
    assert len(whole.map.mesh.boundary_loops) == 4
    assert whole.is_bijective
    np.testing.assert_allclose(whole.distortion.symmetric_dirichlet, 1, atol=1e-3)
    cut = atlas(pierced, size=256, holes="cut")
    assert cut.is_bijective
    assert len(cut.map.mesh.boundary_loops) == cut.count > 1


def test_parts_that_only_a_filled_hole_joins_are_charts_of_their_own():
    """A ring of two faces' width cut by its cells: no chart is in two pieces."""
    found = atlas(cylinder(24, 2, height=0.1), 5, size=256)
    opened = found.map.mesh
    pairs = np.unique(np.stack([opened.components("edges"), found.labels], axis=1), axis=0)
    assert len(pairs) == found.count
    assert found.is_bijective


def test_no_chart_comes_near_itself_but_at_a_seam():
    """What lies within the padding of a point of the boundary is near it on the surface, too."""
    mesh = torus(24, 16)
    found = atlas(mesh, size=128, padding=3)
    edges = found.map.mesh.topology.boundary_edges
    uv, x = (
        (1 - t) * values[edges[:, 0]] + t * values[edges[:, 1]]
        for t in (0.5,)
        for values in (found.map.uv, found.map.mesh.vertices)
    )
    near = np.linalg.norm(uv[:, None] - uv[None], axis=2) < 5 / 128
    far = np.linalg.norm(x[:, None] - x[None], axis=2) * found.density[0] > 30
    assert not (near & far).any()


def test_points_of_the_square_find_their_way_back():
    mesh = SURFACES["blob"]
    found = of("blob")
    rng = np.random.default_rng(3)
    faces = rng.integers(0, mesh.n_faces, 50)
    inside = rng.dirichlet([1, 1, 1], 50)
    points = np.einsum("qc,qci->qi", inside, found.uv[faces])
    at, where = found.map.original(points)
    np.testing.assert_array_equal(at, faces)
    np.testing.assert_allclose(where, inside, atol=1e-6)


@pytest.mark.parametrize("unit", [2.0**-30, 2.0**30])  # no rounding decides a tie
def test_the_unit_of_length_does_not_matter(unit):
    mesh = SURFACES["torus"]
    found = atlas(mesh.with_vertices(mesh.vertices * unit), size=256)
    usual = of("torus")
    np.testing.assert_array_equal(found.labels, usual.labels)
    np.testing.assert_allclose(found.fill, usual.fill, atol=0.02)


@given(arrays(hull, ring_torus, sheet))
@settings(max_examples=10)
def test_meshes_nobody_thought_of(pair):
    x, faces = pair
    used, local = np.unique(faces, return_inverse=True)
    mesh = Mesh(x[used], local.reshape(-1, 3))
    found = atlas(mesh, size=512, padding=1)
    assert found.is_bijective


def test_progress_tells_the_faces_that_are_mapped():
    told = []
    atlas(icosphere(2), 4, progress=lambda done, total: told.append((done, total)))
    assert told[0] == (0, 320)
    assert {total for _, total in told} == {320}
    assert [done for done, _ in told] == sorted(done for done, _ in told)


def test_bad_input_is_told():
    ball = icosphere(1)
    for bound in (1.0, 0.5, np.nan, "2", None):
        with pytest.raises(MeshError, match=r"max_distortion is .*number"):
            atlas(ball, max_distortion=bound)
    with pytest.raises(MeshError, match="size is 3"):
        atlas(ball, size=3)
    with pytest.raises(MeshError, match="padding is -1"):
        atlas(ball, padding=-1)
    with pytest.raises(MeshError, match="the number of charts is 0"):
        atlas(ball, 0)
    with pytest.raises(UnknownNameError):
        atlas(ball, method="fre")
    with pytest.raises(UnknownNameError):
        atlas(ball, cells="nearest")
    with pytest.raises(UnknownNameError):
        atlas(ball, holes="filled")
    with pytest.raises(MeshError, match="seams"):
        atlas(ball, seams=-1)
    x, faces = moebius(np.random.default_rng(0), 12)
    with pytest.raises(NotOrientableError):
        atlas(Mesh(x, faces))


def test_what_doubles_cannot_tell_apart_is_raised():
    """A speck of 1e-13 beside a square: its corners fall together, and that is said."""
    square = grid(2, 2, dimension=3)
    speck = Mesh(square.vertices * 1e-16, square.faces)
    with pytest.raises(FoldedMapError) as caught:
        atlas(side_by_side(speck, square))
    assert caught.value.faces.max() < speck.n_faces
    found = atlas(side_by_side(speck, square), strict=False)
    assert not found.is_bijective
    np.testing.assert_array_equal(found.certificate.flipped, caught.value.faces)
