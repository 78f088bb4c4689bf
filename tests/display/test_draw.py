import numpy as np
import pytest

from beltrami.display.camera import Camera
from beltrami.display.draw import corner_light, draw_panel
from beltrami.display.framing import FILL, fit_camera
from beltrami.display.light import DirectionalLight, light_intensity
from beltrami.display.scene import INK, Panel, Style
from beltrami.display.values import choose_limits
from beltrami.mesh.mesh import Mesh

BARE = {"ambient": 0.0, "fill": 0.0, "color": "white", "background": "black", "antialias": 1}


@pytest.mark.chapter("F3.1")
def test_the_silhouette_of_a_sphere_is_a_disk_of_the_radius_foretold(sphere):
    size = (300, 200)
    style = Style(size, background="black", antialias=1)
    image = draw_panel(Panel(sphere, fit_camera(sphere, (40, 25))), style)
    x, y = np.meshgrid(np.arange(300) + 0.5 - 150, np.arange(200) + 0.5 - 100)
    radius = np.hypot(x, y)
    seen = image.any(axis=2)
    assert seen[radius < FILL * 100 - 0.5].all()
    assert not seen[radius > FILL * 100].any()


@pytest.mark.chapter("P13")
@pytest.mark.parametrize("lamp", [(0.3, 0.5, 1.0), (-1.0, 0.2, 0.1)])
def test_without_ambient_and_fill_the_picture_is_the_intensity_of_the_chapter(sphere, lamp):
    light = DirectionalLight(lamp)
    camera = fit_camera(sphere, (0, 0))
    style = Style((200, 200), light=light, **BARE)
    image = draw_panel(Panel(sphere, camera), style)
    front = sphere.vertices[:, 2] > 0.6
    x, y, _ = camera.project(sphere.vertices[front], (200, 200)).T
    shown = image[y.astype(int), x.astype(int)]
    assert (shown == shown[:, :1]).all()
    # the middle of the pixel is up to 0.7 pixels from the vertex: the light changes by that much
    error = shown[:, 0] / 255 - light_intensity(sphere, light)[front]
    assert np.abs(error).max() < 0.7 / (FILL * 100) / 0.4
    assert np.abs(error).mean() < 0.004


def test_no_pixel_is_lighter_or_darker_than_the_vertices(square):
    light = DirectionalLight((0, 0, 1))
    lift = np.array([0.2, 0, 0, 0])
    tilted = Mesh(square.vertices + np.outer(lift, [0, 0, 1]), square.faces)
    intensity = light_intensity(tilted, light)
    style = Style((100, 100), light=light, **BARE)
    image = draw_panel(Panel(tilted, fit_camera(tilted, (0, 0))), style)
    assert image.max() == round(255 * intensity.max())
    assert image[image > 0].min() == round(255 * intensity.min())


def test_light_of_the_corners_is_made_of_sky_side_and_main(sphere):
    camera = fit_camera(sphere)
    light = DirectionalLight((0, 1, 0))
    main = light_intensity(sphere, light)[sphere.faces]
    only = corner_light(sphere, camera, Style(light=light, ambient=0, fill=0), False)[0]
    assert np.array_equal(only, main)
    sky = corner_light(sphere, camera, Style(light=light, ambient=0.4, fill=0), False)[0]
    up = (sphere.vertex_normals @ camera.axes[1])[sphere.faces]
    assert np.allclose(sky, np.minimum(0.4 * (3 + up) / 4 + 0.6 * main, 1))
    more = corner_light(sphere, camera, Style(light=light, ambient=0, fill=0.3), False)[0]
    assert (more >= main).all()
    assert more.max() <= 1
    assert (more > main).mean() > 0.3


def test_nothing_is_black_by_default(sphere):
    front, back = corner_light(sphere, fit_camera(sphere), Style(), False)
    assert min(front.min(), back.min()) > 0.15
    assert front.max() > 0.95


def test_the_inside_is_lit_through_the_opposite_normals(square):
    light = DirectionalLight((0, 0, -1))
    style = Style(light=light, ambient=0, fill=0)
    front, back = corner_light(square, fit_camera(square), style, False)
    assert (front == 0).all()
    assert np.allclose(back, 1)


def test_flat_shading_is_constant_on_faces(coarse_sphere):
    light = DirectionalLight((0.2, 0.4, 1))
    style = Style(shading="flat", light=light, ambient=0, fill=0)
    front, _ = corner_light(coarse_sphere, fit_camera(coarse_sphere), style, False)
    expected = light_intensity(coarse_sphere, light, "flat")
    assert np.array_equal(front, np.repeat(expected[:, None], 3, axis=1))


def test_a_vertex_without_normal_takes_that_of_the_face():
    # two faces back to back: the normals at their vertices cancel
    sheet = Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 1]])
    assert not sheet.vertex_normals.any()
    style = Style(light=DirectionalLight((0, 0, 1)), ambient=0, fill=0)
    front, back = corner_light(sheet, fit_camera(sheet), style, False)
    assert np.allclose(front, [[1] * 3, [0] * 3])
    assert np.allclose(back, [[0] * 3, [1] * 3])


def test_planar_meshes_have_the_colour_asked_for():
    flat = Mesh([[-1, -1], [1, -1], [0, 1]], [[0, 1, 2]])
    image = draw_panel(Panel(flat, fit_camera(flat)), Style((50, 50), color=(0.2, 0.4, 0.6)))
    assert image[25, 25].tolist() == [51, 102, 153]


def shown(mesh, **options):
    style = Style((60, 60), antialias=1, background="black", **options)
    return draw_panel(Panel(mesh, fit_camera(mesh, (0, 0))), style)[30, 20]


def test_the_inside_is_told_from_the_outside(square):
    turned = Mesh(square.vertices, square.faces[:, ::-1])
    outside, inside = shown(square).astype(int), shown(turned).astype(int)
    assert outside[0] > outside[2]  # clay
    assert inside[2] > inside[0]  # slate
    assert shown(turned, back="same").tolist() == outside.tolist()
    assert shown(turned, back="hide").tolist() == [0, 0, 0]
    assert shown(square, back="hide").tolist() == outside.tolist()


def functional(mesh, f, size=(200, 200), levels=(), view=(0, 0), **options):
    values = np.asarray(f, float)
    limits, table = choose_limits(values, options.pop("limits", None), None)
    panel = Panel(mesh, fit_camera(mesh, view), values[:, None], limits, table, levels)
    return draw_panel(panel, Style(size, **options)), panel


@pytest.mark.chapter("P52")
def test_the_level_line_lies_where_the_function_changes_sign(sphere):
    f = sphere.vertices[:, 0] - 0.3 * sphere.vertices[:, 1]
    plain, panel = functional(sphere, f, antialias=1)
    lined, _ = functional(sphere, f, levels=(0.0,), antialias=1)
    y, x = np.nonzero((plain != lined).any(axis=2))
    assert len(x) > 150
    # on the unit sphere, the plane x = 0.3 y; its image from the front, near enough to the axis
    points = np.stack([0.3 * np.linspace(-0.9, 0.9, 2000), np.linspace(-0.9, 0.9, 2000)], axis=1)
    depth = np.sqrt(1 - (points**2).sum(axis=1))
    curve = panel.camera.project(np.column_stack([points, depth]), (200, 200))[:, :2]
    pixels = np.stack([x + 0.5, y + 0.5], axis=1)[np.abs(y - 99.5) < 75]
    distance = np.linalg.norm(pixels[:, None] - curve[None], axis=2).min(axis=1)
    assert distance.max() < 1.6  # half the width, half a pixel, and the mesh is no sphere
    dark = lined[np.abs(np.arange(200) - 99.5) < 75].min(axis=(1, 2))
    assert dark.max() < 100  # the line has no gap


@pytest.mark.chapter("F3.1")
def test_level_lines_behind_the_surface_are_hidden(sphere):
    # the level z = -0.5 is a circle on the far side
    plain, _ = functional(sphere, sphere.vertices[:, 2])
    lined, _ = functional(sphere, sphere.vertices[:, 2], levels=(-0.5,))
    assert np.array_equal(plain, lined)
    front, _ = functional(sphere, sphere.vertices[:, 2], levels=(0.5,))
    assert not np.array_equal(plain, front)


def test_the_colour_of_a_pixel_is_that_of_the_function(square):
    # f = x on a square that faces the light of an ambient world
    light = DirectionalLight((0, 0, 1))
    image, panel = functional(
        square, square.vertices[:, 0], light=light, ambient=0.0, fill=0.0, antialias=1
    )
    x = np.arange(50, 150)
    span = panel.camera.project([[1, 0, 0]], (200, 200))[0, 0] - 100
    value = (x + 0.5 - 100) / span
    places = np.linspace(-1, 1, len(panel.table))
    expected = np.stack([np.interp(value, places, c) for c in panel.table.T], axis=1)
    assert np.abs(image[100, x] - 255 * expected).max() <= 0.6


def test_limits_clip(square):
    light = {"light": DirectionalLight((0, 0, 1)), "ambient": 0.0, "fill": 0.0, "antialias": 1}
    wide, _ = functional(square, square.vertices[:, 0] * 9, limits=(-1, 1), **light)
    ends = np.rint(255 * choose_limits(np.array([-1.0, 1]), None, None)[1][[0, -1]])
    assert wide[100, 60].tolist() == ends[0].tolist()
    assert wide[100, 140].tolist() == ends[1].tolist()
    # and f is not bent: its zero and the end of the map are where they should be
    span = (np.flatnonzero((wide[100] == ends[1]).all(axis=1))[0] - 99.5) / 66.5
    assert abs(span - 1 / 9) < 0.02


@pytest.mark.parametrize("value", [0.0, 7.0, -1e300, 5e-324])
def test_constant_functions_have_one_colour(square, value):
    image, _ = functional(square, np.full(4, value), antialias=1, background="black")
    assert len(np.unique(image[image.any(axis=2)], axis=0)) == 1


def test_huge_functions_do_not_overflow(square):
    f = np.array([-1.7e308, 1.7e308, 1.7e308, -1.7e308])
    small, _ = functional(square, f / 1.7e308)
    assert np.array_equal(functional(square, f)[0], small)


def test_limits_far_below_the_values_do_not_overflow(square):
    f = 1e10 * square.vertices[:, 0]
    tiny, _ = functional(square, f, limits=(-1e-300, 1e-300))
    near, _ = functional(square, f, limits=(-1e-3, 1e-3))
    assert np.array_equal(tiny, near)


def test_colours_of_vertices(square):
    values = np.tile([[0.2, 0.4, 0.6]], (4, 1))
    style = Style((40, 40), light=DirectionalLight((0, 0, 1)), ambient=0, fill=0, antialias=1)
    image = draw_panel(Panel(square, fit_camera(square, (0, 0)), values), style)
    assert image[20, 20].tolist() == [51, 102, 153]


def test_sides_are_dark_and_the_rest_is_not(square):
    camera = fit_camera(square, (0, 0))
    plain = draw_panel(Panel(square, camera), Style((200, 200), antialias=1))
    wired = draw_panel(Panel(square, camera), Style((200, 200), antialias=1, wireframe=True))
    changed = (plain != wired).any(axis=2)
    corners = camera.project(square.vertices, (200, 200))[:, :2]
    y, x = np.nonzero(changed)
    middles = np.stack([x + 0.5, y + 0.5], axis=1)
    distances = []
    for i, j in [(0, 1), (1, 2), (2, 3), (3, 0), (0, 2)]:
        along = (corners[j] - corners[i]) / np.linalg.norm(corners[j] - corners[i])
        away = middles - corners[i]
        distances.append(np.abs(away[:, 0] * along[1] - away[:, 1] * along[0]))
    assert np.min(distances, axis=0).max() < 1
    assert all((d < 1).any() for d in distances)
    assert wired[changed].min() < 255 * max(INK) + 60


def test_an_inconsistent_and_a_non_manifold_mesh_are_drawn(coarse_sphere):
    rng = np.random.default_rng(77_401_883_265)
    faces = coarse_sphere.faces.copy()
    flipped = rng.random(len(faces)) < 0.3
    faces[flipped] = faces[flipped, ::-1]
    broken = Mesh(coarse_sphere.vertices, np.concatenate([faces, faces[:9], faces[5:8, ::-1]]))
    style = Style((80, 80), background="black", antialias=1)
    image = draw_panel(Panel(broken, fit_camera(broken)), style)
    whole = draw_panel(Panel(coarse_sphere, fit_camera(coarse_sphere)), style)
    assert np.array_equal(image.any(axis=2), whole.any(axis=2))


def test_faces_without_area_change_nothing(square):
    more = Mesh(square.vertices, np.concatenate([square.faces, [[0, 0, 1], [2, 2, 2]]]))
    pictures = [draw_panel(Panel(m, fit_camera(m)), Style((60, 60))) for m in (square, more)]
    assert np.array_equal(*pictures)


def test_a_mesh_that_is_one_point_is_an_empty_picture():
    point = Mesh(np.ones((3, 3)), [[0, 1, 2]])
    image = draw_panel(Panel(point, fit_camera(point)), Style((20, 20)))
    assert (image == 255).all()


@pytest.mark.parametrize("scale", [2.0**-100, 2.0**100])
def test_the_unit_of_length_does_not_matter(coarse_sphere, scale):
    f = coarse_sphere.vertices[:, 0]
    big = coarse_sphere.with_vertices(coarse_sphere.vertices * scale)
    assert np.array_equal(
        functional(coarse_sphere, f, (60, 60), (0.0,))[0], functional(big, f, (60, 60), (0.0,))[0]
    )


def test_a_camera_inside_sees_the_inside(coarse_sphere):
    camera = Camera((0, 0, 0), (0, 0, -1), (0, 1, 0), 100)
    image = draw_panel(Panel(coarse_sphere, camera), Style((50, 50))).astype(int)
    assert (image[..., 2] > image[..., 0]).all()  # slate everywhere, no hole
