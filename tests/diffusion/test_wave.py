import tracemalloc
from itertools import pairwise

import numpy as np
import pytest
import scipy.sparse

import dense_oracles as oracle
from beltrami.diffusion import heat_steps
from beltrami.diffusion.wave import WAVE_METHODS, wave
from beltrami.errors import (
    BeltramiError,
    DimensionError,
    MeshError,
    NegativeWeightError,
    NonFiniteError,
    StepTooLongError,
    TruncationError,
    UnknownNameError,
)
from beltrami.mesh.shapes import icosphere
from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.fourier_basis import fourier_basis
from meshes_of_the_errata import IRREGULAR, MESHES, triangle

MASSES = ("degree", "voronoi", "consistent")


def frames(*arguments, **options):
    return np.array([frame for _, frame in wave(*arguments, **options)])


def start(name):
    f, g = oracle.rough_functions(MESHES[name](), 2).T
    return f + 1, g + 0.5


def division(pair, load):
    return np.linalg.solve(pair.mass.toarray(), load)


@pytest.mark.chapter("U26")
@pytest.mark.parametrize("mass", MASSES)
@pytest.mark.parametrize("columns", [None, 3])
def test_leapfrog_is_the_recursion_of_the_chapter(mass, columns):
    mesh = MESHES["bad"]()
    pair = laplacian(mesh, mass=mass)
    f, g = start("bad")
    if columns:
        f, g = oracle.rough_functions(mesh, 6)[:, :3], oracle.rough_functions(mesh, 6)[:, 3:]
    delta = 1.2 / np.sqrt(pair.spectral_bound())
    found = frames(pair, f, g, delta * np.arange(9), step=delta)
    second = f + delta * g - delta**2 / 2 * division(pair, pair.stiffness @ f)
    expected = [f, second]
    for _ in range(7):
        force = division(pair, pair.stiffness @ expected[-1])
        expected.append(2 * expected[-1] - expected[-2] - delta**2 * force)
    assert np.allclose(found, expected, atol=1e-10)


@pytest.mark.chapter("Q3.8")
@pytest.mark.parametrize("mass", MASSES)
def test_implicit_steps_against_a_dense_trapezoidal_rule(mass):
    pair = laplacian(MESHES["bad"](), mass=mass)
    f, g = start("bad")
    n, delta = pair.n, 5 / np.sqrt(pair.spectral_bound())
    A = division(pair, pair.stiffness.toarray())
    rule = np.block([[np.zeros((n, n)), np.eye(n)], [-A, np.zeros((n, n))]])
    step = np.linalg.solve(np.eye(2 * n) - delta / 2 * rule, np.eye(2 * n) + delta / 2 * rule)
    state = np.concatenate([f, g])
    found = frames(pair, f, g, delta * np.arange(6), "implicit", step=delta)
    for frame in found:
        assert np.allclose(frame, state[:n], atol=1e-9)
        state = step @ state


@pytest.mark.chapter("U26", "Q3.8")
@pytest.mark.parametrize("mass", MASSES)
@pytest.mark.parametrize("name", IRREGULAR)
@pytest.mark.parametrize("method", ["leapfrog", "implicit"])
def test_each_scheme_keeps_its_energy_to_rounding(name, mass, method):
    pair = laplacian(MESHES[name](), mass=mass)
    f, g = start(name)
    g -= pair.mean(g)  # far from zero, the energy of the frames would be rounded
    delta = (1.9 if method == "leapfrog" else 20) / np.sqrt(pair.spectral_bound())
    found = frames(pair, f, g, delta * np.arange(400), method, step=delta)

    def spread(potential):
        energies = [
            pair.norm((b - a) / delta) ** 2 / 2 + potential(a, b) / 2 for a, b in pairwise(found)
        ]
        return np.ptp(energies) / np.abs(energies).max()

    def product(a, b):
        return np.vdot(a, pair.stiffness @ b)

    # implicit: the middle of a step, with its mean velocity, has a constant energy as its ends do
    middle = {
        "leapfrog": product,
        "implicit": lambda a, b: product((a + b) / 2, (a + b) / 2),
    }
    assert spread(middle[method]) < 1e-11
    other = "implicit" if method == "leapfrog" else "leapfrog"
    assert spread(middle[other]) > 1e-4
    assert spread(lambda a, _: product(a, a)) > 1e-4


@pytest.mark.chapter("Q3.8", "U33")
@pytest.mark.parametrize("mass", MASSES)
@pytest.mark.parametrize("name", IRREGULAR)
def test_the_true_energy_is_kept_by_frequencies(name, mass):
    """N(F')² + <LF, F>, with the velocity from frames close together."""
    pair = laplacian(MESHES[name](), mass=mass)
    f, g = start(name)
    h = 1e-4 / np.sqrt(pair.spectral_bound())
    expected = pair.norm(g) ** 2 + pair.dirichlet_energy(f)
    for time in (0.3, 1.7):
        a, b, c = frames(pair, f, g, [time - h, time, time + h], "spectral")
        energy = pair.norm((c - a) / (2 * h)) ** 2 + pair.dirichlet_energy(b)
        assert energy == pytest.approx(expected, rel=1e-6)


@pytest.mark.chapter("U33", "Q3.8")
@pytest.mark.parametrize("method", WAVE_METHODS)
@pytest.mark.parametrize("mass", MASSES)
@pytest.mark.parametrize("name", IRREGULAR)
def test_the_mean_drifts_with_that_of_the_velocity(name, mass, method):
    pair = laplacian(MESHES[name](), mass=mass)
    f, g = start(name)
    times = 30 / np.sqrt(pair.spectral_bound()) * np.array([0, 0.5, 1, 2])
    for time, frame in wave(pair, f, g, times, method):
        expected = pair.mean(f) + time * pair.mean(g)
        assert pair.mean(frame) == pytest.approx(expected, abs=1e-12 * (1 + time))


@pytest.mark.chapter("U26")
@pytest.mark.parametrize("mass", MASSES)
def test_steps_from_the_bound_on_are_refused(mass):
    """On one face the bound is the eigenvalue itself, so nothing longer is stable."""
    pair = laplacian(triangle(15, 150), mass=mass)
    limit = 2 / np.sqrt(oracle.spectrum(pair.stiffness.toarray(), pair.mass.toarray())[-1])
    f = np.array([1.0, 0, 0])
    with pytest.raises(StepTooLongError) as caught:
        wave(pair, f, None, [1.0], step=limit * (1 + 1e-9))
    assert caught.value.longest == pytest.approx(limit, rel=1e-5)
    assert caught.value.longest < limit
    times = caught.value.longest * 0.98 * np.arange(3000)
    assert np.abs(frames(pair, f, None, times, step=caught.value.longest * 0.98)).max() < 10
    A = division(pair, pair.stiffness.toarray())
    delta = 1.02 * limit
    before, now = f, f - delta**2 / 2 * A @ f
    for _ in range(600):
        before, now = now, 2 * now - before - delta**2 * A @ now
    assert np.abs(now).max() > 1e9  # what it protects from


@pytest.mark.parametrize("method", ["leapfrog", "implicit"])
def test_times_are_met_exactly_wherever_they_lie(method):
    """Irregular times give the same wave as regular ones, to second order and no worse."""
    mesh = icosphere(3)
    pair = laplacian(mesh)
    z = mesh.vertices[:, 2]
    times = np.sort(np.random.default_rng(137).uniform(0, 8, size=60))
    times[10] = times[11]
    exact = frames(pair, z, None, times, "spectral")
    found = list(wave(pair, z, None, times, method, step=0.02))
    assert [time for time, _ in found] == times.tolist()
    assert np.allclose([frame for _, frame in found], exact, atol=1e-3)
    assert np.array_equal(found[10][1], found[11][1])
    assert np.array_equal(frames(pair, z, None, [0.0, 0.0], method)[1], z)


def test_a_part_of_a_step_does_not_disturb_the_scheme():
    pair = laplacian(MESHES["bad"]())
    f, g = start("bad")
    delta = 1.9 / np.sqrt(pair.spectral_bound())
    whole = delta * np.arange(0, 400, 4)
    between = np.sort(np.concatenate([whole, whole + 1.3 * delta, whole + 2.9 * delta]))
    calm = frames(pair, f, g, whole, step=delta)
    assert np.array_equal(frames(pair, f, g, between, step=delta)[::3], calm)


@pytest.mark.parametrize("method", WAVE_METHODS)
@pytest.mark.parametrize("mass", MASSES)
def test_held_values_stay_and_the_rest_swings_around_the_harmonic_function(method, mass):
    mesh = MESHES["cur"]()
    pair = laplacian(mesh, mass=mass)
    f, g = start("cur")
    held = np.arange(pair.n) < 32
    free = ~held
    L, B = pair.stiffness.toarray(), pair.mass.toarray()
    rest = f.copy()
    rest[free] = np.linalg.solve(L[free][:, free], -L[free][:, held] @ f[held])
    values, V = scipy.linalg.eigh(L[free][:, free], B[free][:, free])
    a, b = V.T @ B[free][:, free] @ (f - rest)[free], V.T @ B[free][:, free] @ g[free]
    times = 30 / np.sqrt(pair.spectral_bound()) * np.array([0, 0.4, 1])
    step = None if method == "spectral" else times[-1] / 2000
    for hold in (held, np.flatnonzero(held)):
        for time, frame in wave(pair, f, g, times, method, step=step, hold=hold):
            w = np.sqrt(values)
            expected = rest.copy()
            expected[free] += V @ (np.cos(w * time) * a + np.sin(w * time) / w * b)
            assert np.array_equal(frame[held], f[held])
            limit = 1e-8 if method == "spectral" else 1e-3
            assert pair.norm(frame - expected) < limit * pair.norm(f)


def test_a_thousand_frames_take_the_memory_of_a_few():
    pair = laplacian(icosphere(4))
    f = np.zeros(pair.n)
    f[3] = 1
    _ = frames(pair, f, None, [0.01])  # compile and import
    for method in ("leapfrog", "implicit"):
        tracemalloc.start()
        for _, frame in wave(pair, f, None, 0.001 * np.arange(1000), method):
            assert frame.shape == f.shape
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        assert peak < 100 * f.nbytes + 2_000_000  # a thousand frames would be 20 MB


def test_frames_are_yours():
    pair = laplacian(MESHES["open"]())
    f, g = start("open")
    for method in WAVE_METHODS:
        kept = frames(pair, f, g, [0, 0.01, 0.02], method)
        for k, (_, frame) in enumerate(wave(pair, f, g, [0, 0.01, 0.02], method)):
            assert np.array_equal(frame, kept[k])
            frame[:] = 7
        assert np.array_equal(f, start("open")[0])


@pytest.mark.parametrize("mass", MASSES)
def test_a_part_of_a_step_is_a_shorter_step(mass):
    pair = laplacian(MESHES["bad"](), mass=mass)
    f, g = start("bad")
    delta = 1.9 / np.sqrt(pair.spectral_bound())
    part = 0.7 * delta
    (found,) = frames(pair, f, g, [part], step=delta)
    expected = f + part * g - part**2 / 2 * division(pair, pair.stiffness @ f)
    assert np.allclose(found, expected, atol=1e-11)
    (found,) = frames(pair, f, g, [part], "implicit", step=delta)
    middle = np.linalg.solve(
        (pair.mass + part**2 / 4 * pair.stiffness).toarray(), pair.mass @ (f + part / 2 * g)
    )
    assert np.allclose(found, 2 * middle - f, atol=1e-11)


def test_the_mean_is_right_after_many_long_steps():
    """Where the mass is little beside δ²/4 of the stiffness, solves lose digits of it."""
    mesh = icosphere(3)
    pair = laplacian(mesh)
    f, g = oracle.rough_functions(mesh, 2).T
    step = 2000 / np.sqrt(pair.spectral_bound())
    ((time, frame),) = wave(pair, f, g, [500 * step], "implicit", step=step)
    assert pair.mean(frame) == pytest.approx(pair.mean(f) + time * pair.mean(g), rel=1e-13)


@pytest.mark.parametrize("method", ["leapfrog", "implicit"])
def test_a_wave_can_be_run_backwards(method):
    pair = laplacian(MESHES["obt"](), mass="degree")
    f, g = start("obt")
    delta = 0.5
    there = frames(pair, f, g, delta * np.arange(30), method, step=delta)
    # velocity at the end, from the two states around it: exact for the schemes themselves
    ahead = frames(pair, f, g, delta * np.arange(31), method, step=delta)[-1]
    if method == "leapfrog":
        velocity = (ahead - there[-2]) / (2 * delta)
        back = frames(pair, there[-1], -velocity, delta * np.arange(30), method, step=delta)
        assert np.allclose(back[::-1], there, atol=1e-9)
    else:
        A = division(pair, pair.stiffness.toarray())
        total = ahead - there[-1]
        velocity = total / delta + delta / 4 * A @ (ahead + there[-1])
        back = frames(pair, there[-1], -velocity, delta * np.arange(30), method, step=delta)
        assert np.allclose(back[::-1], there, atol=1e-9)


@pytest.mark.chapter("U33")
def test_a_basis_tells_what_it_leaves_out():
    mesh = MESHES["closed"]()
    pair = laplacian(mesh)
    basis = fourier_basis(pair, 25)
    f, g = basis.inverse(np.arange(25.0)), basis.inverse(np.ones(25))
    times = [0, 0.5, 3]
    smooth = frames(pair, f, g, times, "spectral", basis=basis)
    assert np.allclose(smooth, frames(pair, f, g, times, "spectral"), atol=1e-8)
    rough, speed = start("closed")
    with pytest.raises(TruncationError, match="25 modes") as caught:
        wave(pair, rough, speed, times, "spectral", basis=basis)
    found = frames(pair, rough, speed, times, "spectral", basis=basis, tolerance=10)
    exact = frames(pair, rough, speed, times, "spectral")
    scale = pair.norm(rough - pair.mean(rough)) + 3 * pair.norm(speed - pair.mean(speed))
    errors = [pair.norm(a - b) / scale for a, b in zip(found, exact, strict=True)]
    assert 0.2 * caught.value.left_out < max(errors) <= caught.value.left_out
    with pytest.raises(TruncationError) as caught:  # the rest of a velocity swings at √λ or faster
        wave(pair, 0 * rough, speed, [3], "spectral", basis=basis)
    speed -= pair.mean(speed)
    rest = pair.norm(speed - basis.inverse(basis.forward(speed))) / np.sqrt(basis.eigenvalues[-1])
    assert caught.value.left_out == pytest.approx(rest / (3 * pair.norm(speed)))


def test_one_factorisation_for_frames_at_equal_distances(monkeypatch):
    made = []
    true = heat_steps.factorize
    monkeypatch.setattr(
        heat_steps, "factorize", lambda *arguments: made.append(1) or true(*arguments)
    )
    pair = laplacian(MESHES["open"]())
    frames(pair, start("open")[0], None, np.linspace(0.3, 9.1, 50), "implicit", step=0.05)
    assert len(made) == 2  # until the first frame, and from then on
    made.clear()
    frames(pair, start("open")[0], None, np.linspace(0, 9.1, 50), "implicit", step=0.05)
    assert len(made) == 1


@pytest.mark.parametrize("method", WAVE_METHODS)
@pytest.mark.parametrize("unit", [1e-9, 1e9])
def test_any_unit_of_length(method, unit):
    mesh = MESHES["cur"]()
    f, g = start("cur")
    times = np.array([0, 0.013, 0.1])
    expected = frames(laplacian(mesh), f, g, times, method)
    scaled = laplacian(mesh.with_vertices(unit * mesh.vertices))
    found = frames(scaled, f, g / unit, unit * times, method)
    assert np.allclose(found, expected, rtol=1e-8, atol=1e-8)


@pytest.mark.parametrize("method", WAVE_METHODS)
def test_little_input(method):
    alone = laplacian(scipy.sparse.csr_array((1, 1)), mass="unit")
    assert frames(alone, [2.0], [3.0], [0, 5], method).tolist() == [[2], [17]]
    pair = laplacian(MESHES["open"]())
    f = start("open")[0]
    assert list(wave(pair, f, None, [], method)) == []
    assert frames(pair, np.zeros((pair.n, 0)), None, [0.1], method).shape == (1, pair.n, 0)
    ((time, _),) = wave(pair, f, None, 0.25, method)
    assert time == 0.25
    seen = []
    list(wave(pair, f, None, [0, 0.1], method, progress=lambda *step: seen.append(step)))
    assert seen == [(1, 2), (2, 2)]


def test_an_endless_number_of_steps_is_refused():
    pair = laplacian(icosphere(1))
    for time in (1e12, 1e200):
        with pytest.raises(BeltramiError, match="Use the implicit method"):
            wave(pair, np.zeros(pair.n), None, [time])


def test_what_is_refused_before_the_first_frame():
    pair = laplacian(MESHES["open"]())
    f = np.zeros(pair.n)
    with pytest.raises(UnknownNameError, match="Did you mean 'leapfrog'"):
        wave(pair, f, None, [1], "leapfrogs")
    for times in ([1, 0.5], [-1, 0], [np.nan], [np.inf], [[1, 2]]):
        with pytest.raises(BeltramiError, match="times must be"):
            wave(pair, f, None, times)
    for step in (0, -1, np.nan, np.inf):
        for method in ("leapfrog", "implicit"):
            with pytest.raises(BeltramiError, match="step must be positive"):
                wave(pair, f, None, [1], method, step=step)
    with pytest.raises(BeltramiError, match="'spectral' has no step"):
        wave(pair, f, None, [1], "spectral", step=1)
    with pytest.raises(BeltramiError, match="'leapfrog' has no basis"):
        wave(pair, f, None, [1], tolerance=0.1)
    with pytest.raises(DimensionError, match="the velocity"):
        wave(pair, f, f[:3], [1])
    with pytest.raises(NonFiniteError):
        wave(pair, f * np.nan, None, [1])
    with pytest.raises(MeshError, match="held vertices"):
        wave(pair, f, None, [1], hold=[pair.n])
    W = scipy.sparse.csr_array([[0, 2.0, 2], [2, 0, -1], [2, -1, 0]])
    with pytest.raises(NegativeWeightError, match="semi-definite"):
        wave(laplacian(W, mass="unit"), np.zeros(3), None, [1])
