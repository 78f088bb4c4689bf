"""How a mesh bends: convex or concave, along its edges or across, and what that tells of noise."""

import numpy as np
import pytest
from scipy.stats import spearmanr

from beltrami.diffusion.averaging_series import filter_rows
from beltrami.diffusion.bends import Bends, _ranks, unlike_noise
from beltrami.diffusion.denoise import denoise
from beltrami.diffusion.linear_filters import equal_rows
from beltrami.diffusion.noise import STRONG
from beltrami.mesh import shapes
from beltrami.mesh.mesh import Mesh
from dictionary_of_sides import sides_of
from made_once import creature

BALL = shapes.icosphere(4)
SERIES = np.array([1.0, 1.0])  # Id + W̃


def smooth(mesh, white):
    """Noise (n, 1) of an even size from white noise: each value is the mean over two rings."""
    rows = equal_rows(mesh)
    for _ in range(3):
        white = filter_rows(rows, white, SERIES / 2)
    return white / 0.35


def bumpy(mesh, height, seed=0):
    white = np.random.default_rng(seed).standard_normal((mesh.n_vertices, 1))
    way = height * mesh.edge_lengths.mean() * smooth(mesh, white)
    return mesh.with_vertices(mesh.vertices + way * mesh.vertex_normals)


def pairs(mesh):
    """The corners of each pair of faces that share an edge: its ends, and the other two."""
    corner, sides = mesh.faces.ravel().tolist(), sides_of(mesh.faces).values()
    two = [both for both in sides if len(both) == 2]
    return [(i, j, corner[h], corner[g]) for (h, i, j), (g, *_) in two]


def angles(x, quads):
    """Of the normals of the faces (i, j, k), (j, i, other); positive where the edge is convex."""
    i, j, k, other = x[np.array(quads).T]
    n, m = np.cross(j - i, k - i), np.cross(i - j, other - j)
    size = np.linalg.norm(n, axis=1) * np.linalg.norm(m, axis=1)
    angle = np.arccos(np.clip((n * m).sum(axis=1) / size, -1, 1))
    return np.where((n * (other - i)).sum(axis=1) < 0, angle, -angle)


def pleated(seed=2, height=0.2, rounds=1):
    """A square whose quads are flat: pleats along both sides, whose heights are added."""
    square, random = shapes.grid(50, 50, dimension=3), np.random.default_rng(seed)
    sum_of_both = np.zeros(square.n_vertices)
    for axis in (0, 1):
        line = random.standard_normal(60)
        for _ in range(rounds):
            line = (np.roll(line, 1) + 2 * line + np.roll(line, -1)) / 4
        sum_of_both += (line / line.std())[np.rint(50 * square.vertices[:, axis]).astype(int)]
    way = height * square.edge_lengths.mean() * sum_of_both
    return square.with_vertices(square.vertices + way[:, None] * square.vertex_normals)


def rms(mesh, truth):
    return np.sqrt(((mesh.vertices - truth.vertices) ** 2).sum(axis=1).mean())


class TestBends:
    def test_of_shapes_whose_bends_are_known(self):
        assert Bends.of(BALL).convex == 1
        assert Bends.of(shapes.cube(1)).convex == pytest.approx(12 / 18)  # six diagonals are flat
        inside_out = Mesh(BALL.vertices, BALL.faces[:, ::-1])
        assert Bends.of(inside_out).convex == -1

    def test_what_is_flat_bends_to_no_side(self):
        square = shapes.grid(15, 15, dimension=3)
        assert Bends.of(square) == Bends(0, 0)
        turn = np.linalg.qr(np.random.default_rng(0).standard_normal((3, 3)))[0]
        assert Bends.of(square.with_vertices(square.vertices @ turn)).convex == 0  # but rounding
        # pleats that are added are flat in each quad: a third of the edges, and on no side
        assert Bends.of(pleated()).along < -0.6

    def test_nothing_is_beside_a_single_face(self):
        assert Bends.of(Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])) == Bends(0, 0)

    @pytest.mark.parametrize("seed", range(3))
    def test_as_ten_lines_of_numpy(self, seed):
        mesh = bumpy(creature(600), 0.3, seed)
        quads = np.array(pairs(mesh))
        i, j, k, other = mesh.vertices[quads.T]
        ratio = np.linalg.norm(i - j, axis=1) / np.linalg.norm(k - other, axis=1)
        angle = angles(mesh.vertices, quads)
        found = Bends.of(mesh)
        assert found.convex == pytest.approx(np.sign(angle).mean())
        assert found.along == pytest.approx(spearmanr(np.abs(angle), ratio).statistic)

    def test_equal_ranks_are_shared(self):
        assert _ranks(np.array([7.0, 1.0, 7.0, 9.0])).tolist() == [0, -1.5, 0, 1.5]
        square = shapes.grid(9, 9, dimension=3)
        height = np.random.default_rng(0).integers(0, 2, square.n_vertices)
        mesh = square.with_vertices(square.vertices + 0.125 * height[:, None] * [0, 0, 1.0])
        i, j, k, other = mesh.vertices[np.array(pairs(mesh)).T]
        ratio = np.linalg.norm(i - j, axis=1) / np.linalg.norm(k - other, axis=1)
        angle = np.abs(angles(mesh.vertices, pairs(mesh)))
        expected = spearmanr(angle.round(12), ratio.round(12)).statistic
        assert Bends.of(mesh).along == pytest.approx(expected, abs=0.02)

    def test_faces_that_disagree_are_compared_as_if_they_agreed(self):
        mesh = bumpy(BALL, 0.3)
        faces = mesh.faces.copy()
        faces[5] = faces[5, ::-1]
        # its own three edges are seen from its other side: concave for convex
        found, one = Bends.of(Mesh(mesh.vertices, faces)), Bends.of(mesh)
        assert found.along == pytest.approx(one.along)
        assert abs(found.convex - one.convex) <= 6 / mesh.n_edges

    def test_faces_without_an_area_bend_to_no_side(self):
        """A side that was opened to a face of no width."""
        mesh = bumpy(creature(600), 0.3)
        i, j, k = mesh.faces[0].tolist()
        n = mesh.n_vertices
        faces = np.vstack([mesh.faces[1:], [[n, j, k], [n, k, i], [i, j, n]]])
        more, one = (
            Bends.of(Mesh(np.vstack([mesh.vertices, mesh.vertices[i]]), faces)),
            Bends.of(mesh),
        )
        assert more.convex == pytest.approx(one.convex, abs=3 / mesh.n_edges)
        assert more.along == pytest.approx(one.along, abs=0.01)

    @pytest.mark.parametrize("unit", [1e-9, 1e9])
    def test_the_unit_does_not_matter(self, unit):
        mesh = bumpy(BALL, 0.3)
        one, other = Bends.of(mesh), Bends.of(mesh.with_vertices(unit * mesh.vertices))
        assert other.convex == one.convex
        assert other.along == pytest.approx(one.along)


class TestShapeOrNoise:
    """``clean`` is the smooth shape, and noise is alike."""

    @staticmethod
    def noise(mesh, height):
        return lambda white: height * mesh.edge_lengths.mean() * smooth(mesh, white)

    @pytest.mark.parametrize("seed", range(5))
    @pytest.mark.parametrize("height", [0.1, 0.3])
    def test_noise_is_none(self, seed, height):
        for clean in (BALL, shapes.torus(60, 40), creature(1600)):
            mesh = bumpy(clean, height, seed)
            assert unlike_noise(mesh, clean, self.noise(clean, height)) <= 1

    def test_flat_quads_are_shape(self):
        square = shapes.grid(50, 50, dimension=3)
        assert unlike_noise(pleated(), square, self.noise(square, 0.3)) > 1

    @pytest.mark.parametrize("side", [1, -1])
    def test_bumps_to_one_side_are_shape(self, side):
        square = shapes.grid(50, 50, dimension=3)
        white = np.random.default_rng(0).standard_normal((square.n_vertices, 1))
        way = side * 0.2 * square.edge_lengths.mean() * np.exp(smooth(square, white))
        mesh = square.with_vertices(square.vertices + way * square.vertex_normals)
        assert unlike_noise(mesh, square, self.noise(square, 0.3)) > 1

    def test_only_what_lies_along_the_edges_more_than_noise_is(self):
        """Pleats for noise: bumps without them are no shape for that."""
        square = shapes.grid(50, 50, dimension=3)
        pleats = (pleated().vertices - square.vertices)[:, 2:]
        assert unlike_noise(bumpy(square, 0.3), square, lambda white: pleats) <= 1

    def test_nothing_bends(self):
        flat = shapes.grid(40, 40, dimension=3)
        assert unlike_noise(flat, flat, np.zeros_like) == 0

    def test_the_more_noise_the_less_unlike(self):
        square = shapes.grid(50, 50, dimension=3)
        mesh, edge = pleated(), square.edge_lengths.mean()

        def unlike(level):
            white = np.random.default_rng(1).standard_normal((square.n_vertices, 1))
            there = mesh.with_vertices(mesh.vertices + level * edge * white * [0, 0, 1])
            spread = edge * np.hypot(0.2, level)
            return unlike_noise(there, square, lambda white: spread * white)

        found = [unlike(level) for level in (0, 0.1, 0.2, 0.4, 1.6)]
        assert found == sorted(found, reverse=True)
        assert found[0] > 5
        assert found[-1] < 0.7

    @pytest.mark.parametrize("n", [5, 8, 12])
    def test_on_few_vertices_noise_is_none_either(self, n):
        """Their bends are off by chance, which is measured."""
        mesh = shapes.torus(2 * n, n)
        edge, found = mesh.edge_lengths.mean(), []
        for seed in range(20):
            white = np.random.default_rng(seed).standard_normal((mesh.n_vertices, 1))
            there = mesh.with_vertices(mesh.vertices + 0.2 * edge * white * mesh.vertex_normals)
            found.append(unlike_noise(there, mesh, lambda white: 0.2 * edge * white))
        assert np.mean(np.array(found) > 1) <= 0.1


def warts(mesh, steepness, height):
    """Tall ones and small ones, all over."""
    white = np.random.default_rng(0).standard_normal((mesh.n_vertices, 1))
    way = np.exp(steepness * smooth(mesh, white))
    way *= height * mesh.edge_lengths.mean() / way.std()
    return mesh.with_vertices(mesh.vertices + way * mesh.vertex_normals)


def gear():
    """A cylinder of eighty sides with four teeth, all of whose vertices are on creases."""
    bar = shapes.cylinder(80, 2, caps=True)
    x, y, z = bar.vertices.T
    tooth = np.where(np.hypot(x, y) > 0.5, np.sign(np.sin(20 * np.arctan2(y, x) + 0.3)), 0)
    return bar.with_vertices(np.column_stack([x, y, z]) * np.array([1, 1, 0])
                             * (1 + 0.15 * tooth)[:, None] + np.outer(z, [0, 0, 1]))  # fmt: skip


def cogs():
    """A cylinder of eighty sides, every second of whose edges is nearer to the axis."""
    bar = shapes.cylinder(80, 2, caps=True)
    x, y, z = bar.vertices.T
    side = np.rint(np.arctan2(y, x) / (np.pi / 40)).astype(int) % 2
    wide = np.where(np.hypot(x, y) > 0.5, np.where(side == 0, 1.1, 0.9), 1)
    return bar.with_vertices(np.column_stack([x * wide, y * wide, z]))


class TestDenoise:
    def test_pleats_of_flat_quads_are_no_noise(self):
        """They are as even, and as strong in the middle, as averaged noise."""
        mesh = pleated()
        seen = denoise(mesh)
        assert not seen.warnings
        assert rms(seen.mesh, mesh) < 0.02 * mesh.edge_lengths.mean()

    @pytest.mark.parametrize(
        ("shape", "most"), [(gear(), 0.002), (shapes.cube(4), 0.003), (shapes.icosphere(2), 0.002)]
    )
    def test_clean_shapes_of_few_vertices_stay(self, shape, most):
        found = denoise(shape)
        assert not found.warnings
        assert rms(found.mesh, shape) < most * shape.edge_lengths.mean()

    def test_noise_that_is_not_little_is_not_doubted(self):
        """On a gear with noise the first result has lost shape, and bends unlike noise for that."""
        shape = gear()
        edge = shape.edge_lengths.mean()
        noise = 0.3 * edge * np.random.default_rng(0).standard_normal((shape.n_vertices, 1))
        found = denoise(shape.with_vertices(shape.vertices + noise * shape.vertex_normals))
        assert found.sigma == pytest.approx(0.3 * edge, rel=0.1)

    @pytest.mark.parametrize("height", [0.6, 1])
    def test_sharp_pleats_are_no_strong_noise(self, height):
        mesh = pleated(3, height, rounds=0)
        found = denoise(mesh)
        assert found.noise.relative > STRONG
        assert not found.warnings
        assert rms(found.mesh, mesh) < 0.03 * mesh.edge_lengths.mean()

    def test_long_thin_faces_are_not_folded_by_noise(self):
        mesh = cogs()
        found = denoise(mesh)
        assert found.noise.sigma > 0.3 * mesh.edge_lengths.mean()
        assert not found.warnings
        assert rms(found.mesh, mesh) < 0.01 * mesh.edge_lengths.mean()

    @pytest.mark.parametrize(("shape", "steepness"), [(BALL, 1.5), (shapes.torus(60, 40), 2)])
    def test_warts_are_no_outliers_of_the_noise(self, shape, steepness):
        mesh = warts(shape, steepness, 0.2)
        found = denoise(mesh)
        assert not found.warnings
        assert not len(found.spikes)
        assert rms(found.mesh, mesh) < 0.05 * mesh.edge_lengths.mean()

    def test_faint_spikes_on_folds_are_outliers_of_the_noise(self):
        """More of them goes beside a first result than of spikes on smooth shapes."""
        ball = shapes.icosphere(5)
        x, y, z = ball.vertices.T
        way = 0.03 * (1.5 + z) * np.sin(24 * x) * np.sin(24 * y)
        truth = ball.with_vertices(ball.vertices * (1 + way)[:, None])
        random, n = np.random.default_rng(1), truth.n_vertices
        noise = 0.03 * random.standard_normal(n)
        noise += (random.random(n) < 0.01) * 0.3 * random.choice([-1, 1], n)
        way = truth.edge_lengths.mean() * noise[:, None] * truth.vertex_normals
        found = denoise(truth.with_vertices(truth.vertices + way))
        assert any("outliers" in text for text in found.warnings)

    @pytest.mark.parametrize(
        ("shape", "method"), [(shapes.torus(60, 40), "linear"), (shapes.icosphere(2), "auto")]
    )
    def test_outliers_that_are_not_looked_for_are_no_shape(self, shape, method):
        """On a smooth shape they bend unlike noise, and are noise all the same."""
        random, n = np.random.default_rng(1), shape.n_vertices
        noise = 0.02 * random.standard_normal(n)
        noise += (random.random(n) < 0.03) * 0.5 * random.choice([-1, 1], n)
        way = shape.edge_lengths.mean() * noise[:, None] * shape.vertex_normals
        mesh = shape.with_vertices(shape.vertices + way)
        found = denoise(mesh, method)
        assert found.noise.has_outliers
        assert rms(found.mesh, shape) < 0.4 * rms(mesh, shape)

    def test_bumps_alike_are(self):
        square = shapes.grid(50, 50, dimension=3)
        mesh = bumpy(square, 0.3)
        found = denoise(mesh)
        assert any("not white" in text for text in found.warnings)
        assert rms(found.mesh, square) < 0.3 * rms(mesh, square)

    @pytest.mark.parametrize("share", [0.005, 0.02])
    def test_a_few_spikes_upon_noise_with_a_colour(self, share):
        truth = creature(2500)
        random = np.random.default_rng(4)
        mesh = bumpy(truth, 0.3)
        spikes = (random.random(truth.n_vertices) < share) * truth.edge_lengths.mean()
        mesh = mesh.with_vertices(mesh.vertices + spikes[:, None] * truth.vertex_normals)
        found = denoise(mesh)
        assert any("not white" in text for text in found.warnings)
        assert not len(found.spikes)
        assert rms(found.mesh, truth) < 0.8 * rms(mesh, truth)
