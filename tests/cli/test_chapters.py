import numpy as np
import pytest
from PIL import Image

from beltrami.cli.chapters.averaging import averaging
from beltrami.cli.chapters.chapter import Stage
from beltrami.cli.chapters.compression import compression
from beltrami.cli.chapters.denoising import denoising
from beltrami.cli.chapters.files import files
from beltrami.cli.chapters.geodesics import geodesics
from beltrami.cli.chapters.grid import grid as flat_grid
from beltrami.cli.chapters.heat import heat
from beltrami.cli.chapters.interactive import interactive
from beltrami.cli.chapters.maps import maps
from beltrami.cli.chapters.operators import operators
from beltrami.cli.chapters.spectrum import spectrum
from beltrami.cli.chapters.surface import surface
from beltrami.cli.chapters.waves import waves
from beltrami.compression.compress import vertex_order
from beltrami.compression.decompress import decompress
from beltrami.diffusion.bumps import gaussian_bumps
from beltrami.diffusion.denoise import denoise
from beltrami.diffusion.wave import wave
from beltrami.io.registry import read_mesh
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import grid, icosphere
from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.load_basis import load_basis
from beltrami.spectrum.nodal_domains import nodal_domains

TETRAHEDRON_FACES = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]]
MESHES = {
    "closed": icosphere(2),
    "open": grid(6, 5),
    "planar": Mesh([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1, 2], [0, 2, 3]]),
    "triangle": Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]),
    "fan": Mesh(
        [[0, 0, 0], [0, 0, 1], [1, 0, 0], [-1, 1, 0], [-1, -1, 0]],
        [[0, 1, 2], [0, 1, 3], [0, 1, 4]],
    ),
    "two parts": Mesh(
        np.concatenate([np.eye(4, 3), np.eye(4, 3) + 5]),
        np.concatenate([TETRAHEDRON_FACES, np.add(TETRAHEDRON_FACES, 4)]),
    ),
}
CHAPTERS = (
    interactive, surface, operators, averaging, flat_grid, heat, denoising, waves, spectrum,
    compression, maps, geodesics, files,
)  # fmt: skip


def stage(mesh, folder):
    return Stage("mesh.ply", mesh, folder, "y", None)


@pytest.mark.parametrize("mesh", MESHES.values(), ids=MESHES)
@pytest.mark.parametrize("act", CHAPTERS, ids=lambda act: act.__name__)
def test_each_chapter_plays_on_each_mesh(act, mesh, tmp_path):
    chapter = act(stage(mesh, tmp_path))
    assert all(len(row) == len(chapter.rows[0]) for row in chapter.rows)
    assert not {"nan", "inf", "None"} & {cell for row in chapter.rows for cell in row}
    named = {figure.name for figure in chapter.figures} | {name for name, _ in chapter.files}
    assert named == {path.name for path in tmp_path.iterdir()}


def test_compression_tells_what_the_files_hold(tmp_path):
    chapter = compression(stage(MESHES["closed"], tmp_path))
    sizes = [int(row[1]) for row in chapter.rows[1:]]
    assert sizes == sorted(sizes)
    errors = [float(row[3]) for row in chapter.rows[1:]]
    assert errors == sorted(errors, reverse=True)
    back = decompress(tmp_path / "mesh.btm")
    off = back.vertices - MESHES["closed"].vertices[vertex_order(MESHES["closed"])]
    assert np.linalg.norm(off, axis=1).max() <= 1e-4 * np.linalg.norm([2, 2, 2])


def test_heat_tells_the_numbers_of_its_states(tmp_path):
    chapter = heat(stage(MESHES["closed"], tmp_path))
    assert [row[3] for row in chapter.rows[1:]] == ["1.000000000000"] * 4
    state = read_mesh(tmp_path / "heat.ply").vertex_data["heat"]
    assert chapter.rows[3][2] == f"{state.max():.4g}"


def test_waves_tell_what_leapfrog_gives_and_keep_their_mean(tmp_path):
    chapter = waves(stage(icosphere(3), tmp_path))
    mesh, pair = icosphere(3), laplacian(icosphere(3))
    bump = int(np.linalg.norm(mesh.vertices - mesh.vertices.mean(axis=0), axis=1).argmax())
    hollow = int(np.linalg.norm(mesh.vertices - mesh.vertices[bump], axis=1).argmax())
    start = gaussian_bumps(mesh, [bump, hollow], 0.05 * mesh.area**0.5, [1.0, -1.0])
    last = 0.5 * mesh.area**0.5
    states = [state for _, state in wave(pair, start, None, np.linspace(0, last, 6))]
    for row, state in zip(chapter.rows[1:], states, strict=True):
        assert row[1] == f"{state.min():.4g}"
        assert float(row[3]) == pytest.approx(pair.masses @ start, abs=1e-6)
    with Image.open(tmp_path / "waves.webp") as film:
        assert film.n_frames == 16


@pytest.mark.parametrize("factor", [1, 1e-6])
def test_waves_on_slivers_take_few_steps(tmp_path, factor):
    plane = grid(9, 9, dimension=3)
    mesh = plane.with_vertices(plane.vertices * [1, factor, 1])  # bound of the steps: a millionth
    text = " ".join(waves(stage(mesh, tmp_path)).text)
    assert ("They were taken" in text) == (factor == 1)
    assert ("implicit" in text) == (factor != 1)


@pytest.mark.chapter("P43")
def test_denoising_is_better_than_heat_at_its_best_time(tmp_path):
    mesh = icosphere(4)
    chapter = denoising(stage(mesh, tmp_path))
    rows = {row[0]: (float(row[1]), float(row[2][:-1])) for row in chapter.rows[1:]}
    before, heated, after = rows["with noise"], rows["heat, best time"], rows["denoise"]
    assert before[0] == pytest.approx(0.2, rel=0.05)
    assert after[0] < 0.5 * heated[0] < 0.5 * before[0]
    assert after[1] < 0.5 * heated[1] < 0.5 * before[1]
    noisy, clean = (read_mesh(tmp_path / name) for name in ("noisy.ply", "denoised.ply"))
    assert rows["with noise"][0] == pytest.approx(
        np.sqrt(((noisy.vertices - mesh.vertices) ** 2).sum(axis=1).mean())
        / mesh.edge_lengths.mean(),
        abs=1e-3,
    )
    assert np.array_equal(denoise(noisy).mesh.vertices, clean.vertices)


def test_the_volume_of_an_open_mesh_is_not_told(tmp_path):
    rows = dict(row[:2] for row in surface(stage(MESHES["open"], tmp_path)).rows)
    assert rows["volume"] == "undefined"
    rows = dict(row[:2] for row in surface(stage(MESHES["closed"], tmp_path)).rows)
    assert rows["volume"] == f"{MESHES['closed'].volume:.4g}"


@pytest.mark.chapter("F3.7")
def test_eigenfunctions_have_no_more_regions_than_courant_allows(tmp_path):
    mesh = icosphere(3)
    chapter = spectrum(stage(mesh, tmp_path))
    basis = load_basis(tmp_path / "basis.npz", laplacian(mesh))
    shown = [int(row[0]) for row in chapter.rows[1:]]
    assert shown == [1, 2, 4, 8, 16, 32, 64, 128]
    for i, row in zip(shown, chapter.rows[1:], strict=True):
        assert row[1] == f"{basis.eigenvalues[i]:.4g}"
        last = np.flatnonzero(basis.eigenvalues < basis.eigenvalues[i] * 1.01)[-1]
        assert 2 <= nodal_domains(mesh, basis.eigenvectors[:, i]).count <= last + 1
    with Image.open(tmp_path / "eigenfunctions.png") as picture:
        pixels = np.asarray(picture.convert("RGB"), dtype=int)
    assert (pixels[..., 0] - pixels[..., 2]).max() > 100  # red
    assert (pixels[..., 2] - pixels[..., 0]).max() > 100  # blue
    assert (pixels.max(axis=2) < 40).any()  # the lines of zero


def test_half_the_cotangent_energy_is_the_area(tmp_path):
    rows = {row[0]: row for row in operators(stage(MESHES["closed"], tmp_path)).rows}
    assert rows["cotangent"][-1] == f"{MESHES['closed'].area:.4g}"


def test_files_come_back(tmp_path):
    rows = {row[0]: row for row in files(stage(MESHES["closed"], tmp_path)).rows}
    for suffix in (".obj", ".off", ".ply"):
        assert rows[suffix][2:4] == ("320", "0.0e+00")
    assert 0 < float(rows[".stl"][3]) < 1e-7


def test_the_fourier_transform_and_small_steps_agree_on_the_grid(tmp_path):
    rows = flat_grid(stage(MESHES["closed"], tmp_path)).rows[1:]
    for _, largest, off, moved in rows:
        assert 0 < float(off) < 0.15 * float(largest)
        assert abs(float(moved)) < 1e-15


def test_distances_through_space_are_shorter(tmp_path):
    rows = {row[0]: row for row in geodesics(stage(MESHES["closed"], tmp_path)).rows}
    space, heat_, edges = (float(rows[k][1]) for k in list(rows)[1:])
    assert space == pytest.approx(2, rel=1e-3)
    assert heat_ == pytest.approx(np.pi, rel=0.05)
    assert edges > heat_


def test_the_rounding_of_a_tilted_plane_is_not_drawn(tmp_path):
    plane = grid(9, 9, dimension=3).vertices @ np.linalg.qr([[1, 2, 3], [4, 5, 7], [7, 8, 1]])[0]
    operators(stage(grid(9, 9, dimension=3).with_vertices(plane), tmp_path))
    with Image.open(tmp_path / "curvature.png") as picture:
        drawn = np.asarray(picture.convert("RGB"))[30:440].astype(int)  # without the bars
    assert np.ptp(drawn, axis=2).max() < 30  # grey, neither red nor blue (58 if it were)


def test_gauss_and_bonnet_are_told(tmp_path):
    text = " ".join(operators(stage(MESHES["closed"], tmp_path)).text)
    assert "2π times 2.000000000: the Euler characteristic is 2" in text
