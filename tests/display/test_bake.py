"""bake: textures that read like the function, at seams too."""

import numpy as np
import pytest

from beltrami.display.bake import bake, colorize
from beltrami.display.texture import look_up, make_texture
from beltrami.errors import DimensionError, MeshError, NonFiniteError
from beltrami.io.picture import as_picture
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import grid, icosphere, torus
from beltrami.parameterization.atlas import atlas


@pytest.fixture(scope="module")
def ring():
    return atlas(torus(24, 16), size=256)


def read(texels, uv):
    """Read a texture with linear interpolation between the middles of the texels."""
    size = len(texels)
    x, y = uv[:, 0] * size - 0.5, (1 - uv[:, 1]) * size - 0.5
    j = np.clip(np.floor(x).astype(int), 0, size - 2)
    i = np.clip(np.floor(y).astype(int), 0, size - 2)
    a, b = x - j, y - i
    above = (1 - a) * texels[i, j] + a * texels[i, j + 1]
    below = (1 - a) * texels[i + 1, j] + a * texels[i + 1, j + 1]
    return (1 - b) * above + b * below


def anywhere(mesh, uv, count=4000):
    """Points of the surface, on sides of faces too: function values and texture coordinates."""
    rng = np.random.default_rng(0)
    faces = rng.integers(0, mesh.n_faces, count)
    inside = rng.dirichlet([1, 1, 1], count)
    inside[: count // 2, 0] = 0
    inside /= inside.sum(axis=1, keepdims=True)
    return faces, inside, np.einsum("qc,qci->qi", inside, uv[faces])


@pytest.mark.chapter("P71")
def test_linear_functions_of_the_square_are_exact_up_to_the_rim():
    mesh = grid(5, 4)
    found = atlas(mesh, size=64)
    f = found.map.uv[np.argsort(found.map.vertex_map)] @ [2.0, -3.0] + 1
    _, _, at = anywhere(mesh, found.uv)
    np.testing.assert_allclose(read(bake(found, f), at), at @ [2, -3] + 1, atol=1e-6)


@pytest.mark.chapter("P71")
def test_the_texture_reads_like_the_function_at_the_seams(ring):
    mesh = ring.mesh
    f = np.sin(3 * mesh.vertices[:, 0]) + mesh.vertices[:, 2]
    faces, inside, at = anywhere(mesh, ring.uv)
    expected = np.einsum("qc,qc->q", inside, f[mesh.faces[faces]])
    texels = bake(ring, f)
    assert np.abs(read(texels, at) - expected).max() < 0.01 * np.ptp(f)


@pytest.mark.chapter("P71")
def test_both_sides_of_a_seam_read_alike(ring):
    mesh = ring.mesh
    f = mesh.vertices @ [1.0, 2, 3]
    texels = bake(ring, f)
    for i, j in ring.seams[:40]:
        faces = np.flatnonzero((mesh.faces == i).any(axis=1) & (mesh.faces == j).any(axis=1))
        values = []
        for face in faces:
            ends = [int(np.flatnonzero(mesh.faces[face] == v)[0]) for v in (i, j)]
            values.append(read(texels, ring.uv[face, ends].mean(axis=0)[None])[0])
        np.testing.assert_allclose(values, (f[i] + f[j]) / 2, atol=0.01 * np.ptp(f))


def test_colours_and_columns(ring):
    n = ring.mesh.n_vertices
    colors = np.full((n, 3), 255, np.uint8)
    np.testing.assert_allclose(bake(ring, colors, 32), 1, atol=1e-12)
    two = np.column_stack([np.arange(n), np.ones(n)]).astype(float)
    texels = bake(ring, two, 32)
    assert texels.shape == (32, 32, 2)
    np.testing.assert_array_equal(texels[..., 0], bake(ring, two[:, 0], 32))


def test_colours_stay_colours_outside_of_the_charts(ring):
    """Faces go on beyond their sides, there; the values of functions may, too."""
    steep = np.random.default_rng(1).integers(0, 2, (ring.mesh.n_vertices, 3)) * 255
    texels = bake(ring, steep.astype(np.uint8))
    assert (texels.min(), texels.max()) == (0, 1)
    as_picture(texels)
    free = bake(ring, steep / 255.0)
    assert free.max() > 1
    np.testing.assert_allclose(np.clip(free, 0, 1), texels, atol=1e-12)


@pytest.mark.parametrize("size", [1, 2, 7, 40])
def test_textures_with_fewer_texels_than_faces(ring, size):
    f = ring.mesh.vertices[:, 0]
    texels = bake(ring, f, size)
    assert texels.shape == (size, size)
    slack = np.ptp(f) * 2
    assert f.min() - slack <= texels.min() <= texels.max() <= f.max() + slack


def test_it_is_the_picture_that_render_draws(ring):
    """From the function over the texture to a look-up as render does it."""
    f = ring.mesh.vertices[:, 2]
    picture = colorize(bake(ring, f), [[0, 0, 0], [1, 1, 1]], (float(f.min()), float(f.max())))
    texture = make_texture(ring.mesh, picture)
    color = np.empty(3)
    for face in range(0, ring.mesh.n_faces, 37):
        u, v = ring.uv[face].mean(axis=0)
        look_up(texture.pixels, texture.levels, u, v, 0.0, 0.0, color)
        expected = (f[ring.mesh.faces[face]].mean() - f.min()) / np.ptp(f)
        assert abs(color[0] - expected) < 0.02


def test_colorize():
    image = colorize(np.array([[-1.0, 0.0, 2.0]]), [[0, 0, 0], [1, 1, 1]], (0.0, 1.0))
    assert image.dtype == np.uint8
    assert image[0, :, 0].tolist() == [0, 0, 255]
    assert (colorize(np.ones((2, 2))) == colorize(np.ones((2, 2)))[0, 0]).all()
    with pytest.raises(DimensionError):
        colorize(np.zeros(3))
    with pytest.raises(NonFiniteError):
        colorize([[np.nan]])


def test_bad_input_is_told(ring):
    for wrong in ([["a"]], [[1.0, 2.0], [3.0]]):
        with pytest.raises(DimensionError):
            colorize(wrong)
    ball = icosphere(1)
    with pytest.raises(MeshError, match="without texture coordinates"):
        bake(ball, np.zeros(ball.n_vertices))
    far = Mesh(ball.vertices, ball.faces, corner_uv=np.full((80, 3, 2), 1.5))
    with pytest.raises(MeshError, match=r"outside \[0, 1\]") as caught:
        bake(far, np.zeros(ball.n_vertices))
    assert len(caught.value.faces) == 80
    with pytest.raises(DimensionError):
        bake(ring, np.zeros(3))
    with pytest.raises(NonFiniteError):
        bake(ring, np.full(ring.mesh.n_vertices, np.nan))
    with pytest.raises(MeshError, match="size is 0"):
        bake(ring, np.zeros(ring.mesh.n_vertices), 0)
