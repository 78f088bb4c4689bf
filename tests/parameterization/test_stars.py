"""Stars: their energy is that of the distortion, and one vertex at a time it falls."""

import numpy as np
import pytest

from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import grid
from beltrami.parameterization.certificate import certify
from beltrami.parameterization.distortion import distortion
from beltrami.parameterization.isometric_energy import isometric_energy
from beltrami.parameterization.stars import at_rest, corner_lists, star_energy, star_sum, stars
from meshes_of_the_errata import open_


def bent(seed=0):
    """Return a grid that is bent in space, and a rough map of it without a fold."""
    flat = grid(9, 7)
    x, y = flat.vertices[:, :2].T
    mesh = Mesh(np.column_stack([x, y, 0.4 * x * y + 0.2 * x**2]), flat.faces)
    noise = np.random.default_rng(seed).uniform(-0.04, 0.04, (mesh.n_vertices, 2))
    noise[mesh.topology.on_boundary] = 0
    return mesh, flat.vertices[:, :2] + noise


def star(mesh, x, v):
    """Return the sides and the faces at rest of the star of a vertex."""
    sides, rest = [], []
    for face in mesh.faces[(mesh.faces == v).any(axis=1)]:
        _, a, b = np.roll(face, -int(np.flatnonzero(face == v)[0]))
        sides.append([*x[a], *x[b]])
        rest.append(np.empty(4))
        at_rest(mesh.vertices, v, a, b, rest[-1])
    return np.array(sides), np.array(rest)


def energy(mesh, x):
    s = distortion(mesh, x).singular_values
    return float(mesh.face_areas @ (s**2 + s**-2.0).sum(axis=1))


def test_the_energy_is_that_of_the_singular_values():
    mesh, x = bent()
    for v in np.flatnonzero(~mesh.topology.on_boundary)[:6]:
        sides, rest = star(mesh, x, v)
        around = Mesh(mesh.vertices, mesh.faces[(mesh.faces == v).any(axis=1)])
        found = star_energy(sides, rest, len(sides), *x[v])[0]
        assert found == pytest.approx(energy(around, x), rel=1e-12)


def test_the_derivatives_are_those_of_differences():
    mesh, x = bent()
    v = int(np.flatnonzero(~mesh.topology.on_boundary)[5])
    sides, rest = star(mesh, x, v)
    h = 1e-5

    def at(px, py):
        return np.array(star_energy(sides, rest, len(sides), x[v, 0] + px, x[v, 1] + py))

    _, gx, gy, hxx, hxy, hyy = at(0, 0)
    along, up = (at(h, 0) - at(-h, 0)) / (2 * h), (at(0, h) - at(0, -h)) / (2 * h)
    assert [gx, gy] == pytest.approx([along[0], up[0]], rel=1e-6)
    assert [hxx, hxy, hyy] == pytest.approx([along[1], along[2], up[2]], rel=1e-5)
    assert up[1] == pytest.approx(hxy, rel=1e-5)


def test_what_folds_or_has_no_size_costs_everything():
    mesh, x = bent()
    v = int(np.flatnonzero(~mesh.topology.on_boundary)[5])
    sides, rest = star(mesh, x, v)
    assert star_energy(sides, rest, len(sides), 9.0, 9.0)[0] == np.inf
    assert star_energy(sides, 0 * rest, len(sides), *x[v])[0] == np.inf
    assert star_energy(1e-200 * sides, rest, len(sides), *(1e-200 * x[v]))[0] == np.inf


def test_sweeps_lower_the_energy_and_fold_nothing():
    mesh, x = bent()
    around = stars(mesh)
    before = x.copy()
    energies = [energy(mesh, around.swept(x, 1.0, count)) for count in (0, 1, 2, 8)]
    assert sorted(energies, reverse=True) == energies
    assert energies[0] > 1.02 * energies[-1]
    np.testing.assert_array_equal(x, before)
    moved = around.swept(x, 1.0, 8)
    assert certify(mesh, moved).is_bijective
    rim = mesh.topology.on_boundary
    np.testing.assert_array_equal(moved[rim], x[rim])
    assert (moved[~rim] != x[~rim]).any(axis=1).all()


def test_in_the_end_no_single_vertex_can_do_better():
    mesh, x = bent()
    x = stars(mesh).swept(x, 1.0, 60)
    for v in np.flatnonzero(~mesh.topology.on_boundary):
        sides, rest = star(mesh, x, v)
        here, gx, gy, hxx, hxy, hyy = star_energy(sides, rest, len(sides), *x[v])
        step = np.linalg.solve([[hxx, hxy], [hxy, hyy]], [gx, gy])
        assert step @ [gx, gy] < 2e-3 * here


def test_only_what_is_free_moves():
    mesh, x = bent()
    free = np.zeros(mesh.n_vertices, bool)
    free[:30] = True
    moved = stars(mesh, free).swept(x, 1.0, 1)
    changed = (moved != x).any(axis=1)
    np.testing.assert_array_equal(changed, free & ~mesh.topology.on_boundary)


@pytest.mark.parametrize("unit", [1e-9, 1e9])
def test_the_unit_does_not_matter(unit):
    mesh, x = bent()
    other = Mesh(unit * mesh.vertices, mesh.faces)
    truth = stars(mesh).swept(x, 1.0, 2)
    np.testing.assert_allclose(stars(other).swept(x, unit, 2), truth, atol=1e-9)
    np.testing.assert_allclose(stars(mesh).swept(x / 3, 3.0, 2), truth / 3, atol=1e-9)


def test_many_faces_around_a_vertex_are_all_seen():
    turn = np.linspace(0, 2 * np.pi, 150, endpoint=False)
    rim = np.column_stack([np.cos(turn), np.sin(turn)])
    k = np.arange(150)
    faces = np.column_stack([np.full(150, 150), k, (k + 1) % 150])
    mesh = Mesh(np.concatenate([rim, [[0.0, 0.0]]]), faces)
    x = np.concatenate([rim, [[0.3, -0.2]]])
    moved = stars(mesh).swept(x, 1.0, 20)
    assert np.abs(moved[150]).max() < 1e-2


def test_corner_lists_hold_each_corner_once():
    mesh = open_()
    first, after = corner_lists(mesh.faces, mesh.n_vertices)
    for v in range(mesh.n_vertices):
        found, c = [], first[v]
        while c >= 0:
            found.append(c)
            c = after[c]
        assert sorted(found) == np.flatnonzero(mesh.faces.ravel() == v).tolist()


def test_the_star_energy_is_the_part_of_the_whole_that_changes():
    mesh, x = bent()
    v = int(np.flatnonzero(~mesh.topology.on_boundary)[7])
    sides, rest = star(mesh, x, v)
    y = x.copy()
    y[v] += [0.01, -0.005]
    here, there = (star_energy(sides, rest, len(sides), *z[v])[0] for z in (x, y))
    grown, shrunk = (isometric_energy(mesh).sums(z) for z in (x, y))
    assert (there - here) / mesh.area == pytest.approx(sum(shrunk) - sum(grown), rel=1e-9)


def test_only_those_chosen_move():
    mesh, x = bent()
    chosen = np.zeros(mesh.n_vertices, bool)
    chosen[np.flatnonzero(~mesh.topology.on_boundary)[:5]] = True
    chosen[mesh.boundary_loops[0][:2]] = True  # these may not
    moved = (stars(mesh).swept(x, 1.0, 2, chosen) != x).any(axis=1)
    assert moved.sum() == 5
    assert (chosen | ~moved).all()


def test_the_sum_alone_is_the_same():
    mesh, x = bent()
    v = int(np.flatnonzero(~mesh.topology.on_boundary)[3])
    sides, rest = star(mesh, x, v)
    here = star_energy(sides, rest, len(sides), *x[v])[0]
    assert star_sum(sides, rest, len(sides), *x[v]) == pytest.approx(here, rel=1e-14)
    assert star_sum(sides, rest, len(sides), 9.0, 9.0) == np.inf
    assert star_sum(sides, 0 * rest, len(sides), *x[v]) == np.inf
