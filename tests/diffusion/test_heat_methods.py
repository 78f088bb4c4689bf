"""What all methods of heat share: sources, held values, means, columns, one factorisation."""

import numpy as np
import pytest
from scipy.linalg import expm

import dense_oracles as oracle
from beltrami.diffusion import heat_steps
from beltrami.diffusion.heat import HEAT_METHODS, heat
from beltrami.errors import BeltramiError, DimensionError, NegativeWeightError, TruncationError
from beltrami.mesh.mesh import Mesh
from beltrami.mesh.shapes import icosphere
from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.basis import FourierBasis
from beltrami.spectrum.fourier_basis import fourier_basis
from meshes_of_the_errata import IRREGULAR, MESHES

EXACT = ("spectral", "exact")


def flow(pair, f, time, source, held):
    """Dense F' = M⁻¹ (b - K F) on the free vertices, by one exponential of a larger matrix."""
    L, B = pair.stiffness.toarray(), pair.mass.toarray()
    free = ~held
    load = (B @ source)[free] - L[free][:, held] @ f[held]
    A = -np.linalg.solve(B[free][:, free], L[free][:, free])
    c, q = f.shape[1], free.sum()
    big = np.zeros((q + c, q + c))
    big[:q, :q], big[:q, q:] = A, np.linalg.solve(B[free][:, free], load)
    step = expm(time * big)
    result = f.copy()
    result[free] = step[:q, :q] @ f[free] + step[:q, q:]
    return result


def steps_for(method):
    return {"steps": 400} if method in HEAT_METHODS[:3] else {}


@pytest.mark.chapter("D17", "P47")
@pytest.mark.parametrize("method", HEAT_METHODS)
@pytest.mark.parametrize("mass", ["degree", "voronoi", "consistent"])
@pytest.mark.parametrize("hold", [False, True])
def test_sources_and_held_values_against_a_dense_exponential(method, mass, hold):
    mesh = MESHES["bad"]()
    pair = laplacian(mesh, "cotangent", mass)
    f, s = oracle.rough_functions(mesh, 6)[:, :3], oracle.rough_functions(mesh, 6)[:, 3:]
    held = (np.arange(pair.n) % 7 == 3) & hold
    time = 100 / pair.spectral_bound()
    result = heat(pair, f, time, method, source=s, hold=held, **steps_for(method))
    expected = flow(pair, f, time, s, held)
    error = pair.norm(result - expected) / pair.norm(expected - f)
    limit = {"implicit": 0.02, "explicit": 0.02, "crank_nicolson": 3e-4}
    assert error < limit.get(method, 1e-10)
    assert np.array_equal(result[held], f[held])
    alone = heat(pair, f[:, 1], time, method, source=s[:, 1], hold=held, **steps_for(method))
    assert np.allclose(alone, result[:, 1], atol=1e-12 * np.abs(result).max())
    same = heat(pair, f, time, method, source=s[:, 1], hold=held, **steps_for(method))
    assert np.allclose(same[:, 1], result[:, 1], atol=1e-12 * np.abs(result).max())


@pytest.mark.chapter("D17", "T15")
@pytest.mark.parametrize("method", HEAT_METHODS)
@pytest.mark.parametrize("mass", ["degree", "voronoi", "consistent"])
@pytest.mark.parametrize("name", IRREGULAR)
def test_the_mean_is_kept_to_rounding_and_moved_by_that_of_the_source(name, mass, method):
    mesh = MESHES[name]()
    pair = laplacian(mesh, "cotangent", mass)
    f, s = oracle.rough_functions(mesh, 2).T + 3
    scale = pair.masses @ np.abs(f) / pair.masses.sum()
    for long in (1, 1e12):
        if long > 1 and method == "explicit":
            continue
        time = long * 10 / pair.spectral_bound()
        after = heat(pair, f, time, method)
        assert pair.mean(after) == pytest.approx(pair.mean(f), abs=2e-14 * scale)
        fed = heat(pair, f, time, method, source=s)
        drift = pair.mean(f) + time * pair.mean(s)
        assert pair.mean(fed) == pytest.approx(drift, abs=2e-14 * (scale + 3 * time))


@pytest.mark.parametrize("method", HEAT_METHODS)
@pytest.mark.parametrize("name", IRREGULAR)
def test_the_energy_falls_from_step_to_step(name, method):
    pair = laplacian(MESHES[name](), mass="degree")
    f = oracle.rough_functions(MESHES[name](), 1)[:, 0]
    energies = [pair.dirichlet_energy(f)]
    for k in range(1, 8):
        steps = {"steps": k} if method in HEAT_METHODS[:3] else {}
        energies.append(pair.dirichlet_energy(heat(pair, f, 0.3 * k, method, **steps)))
    assert (np.diff(energies) < 1e-14 * energies[0]).all()


def two_spheres():
    one = icosphere(1)
    x = np.concatenate([one.vertices, 2 * one.vertices + 9])
    return Mesh(x, np.concatenate([one.faces, one.faces + one.n_vertices]))


@pytest.mark.chapter("T15")
@pytest.mark.parametrize("method", ["implicit", "crank_nicolson", "spectral", "exact"])
def test_each_component_has_its_own_mean_and_its_own_limit(method):
    pair = laplacian(two_spheres())
    f = oracle.rough_functions(two_spheres(), 1)[:, 0]
    damped = {"damped_steps": 10} if method == "crank_nicolson" else {}
    far = heat(pair, f, 1e9, method, hold=[50], **damped)
    mean = pair.masses[:42] @ f[:42] / pair.masses[:42].sum()
    assert np.allclose(far[:42], mean, atol=1e-9)
    assert np.allclose(far[42:], f[50], atol=1e-6)


@pytest.mark.chapter("Q3.10")
@pytest.mark.parametrize("name", IRREGULAR)
def test_frequencies_decay_exponentially(name):
    """Equation 3.10, with the transform of definition 19 and the degree mass."""
    pair = laplacian(MESHES[name](), "cotangent", "degree")
    values, U = np.linalg.eigh(pair.normalized.toarray())
    transform = U.T * np.sqrt(pair.degrees)
    f = oracle.rough_functions(MESHES[name](), 1)[:, 0]

    def check(method, factor):
        after = transform @ heat(pair, f, 0.7, method)
        assert np.allclose(after, factor * (transform @ f), atol=1e-11)

    for method in EXACT:
        check(method, np.exp(-0.7 * values))
        for wrong in (np.exp(-0.35 * values), 1 / (1 + 0.7 * values), np.exp(0.7 * values)):
            with pytest.raises(AssertionError):
                check(method, wrong)


@pytest.mark.parametrize("method", ["implicit", "crank_nicolson"])
def test_one_factorisation_serves_all_steps_and_columns(method, monkeypatch):
    made = []
    true = heat_steps.factorize
    monkeypatch.setattr(
        heat_steps, "factorize", lambda *arguments: made.append(1) or true(*arguments)
    )
    pair = laplacian(MESHES["open"]())
    options = {"damped_steps": 3} if method == "crank_nicolson" else {}
    heat(pair, oracle.rough_functions(MESHES["open"](), 3), 0.1, method, 20, **options)
    assert len(made) == 1


def test_a_point_of_heat_rings_unless_the_first_steps_are_damped():
    """Large δλ: plain Crank and Nicolson turns the sign of what is rough and hardly damps it."""
    mesh = icosphere(4)
    pair = laplacian(mesh)
    point = np.zeros(pair.n)
    point[7] = 1 / pair.masses[7]
    time = 0.2
    exact = heat(pair, point, time, "exact")

    def error(damped):
        found = heat(pair, point, time, "crank_nicolson", 10, damped_steps=damped)
        return np.abs(found - exact).max() / exact.max()

    assert error(0) > 10
    assert error(2) < 0.05
    implicit = np.abs(heat(pair, point, time, steps=10) - exact).max() / exact.max()
    assert error(2) < implicit / 3


@pytest.mark.chapter("Q3.10")
def test_a_basis_is_exact_for_what_it_spans_and_tells_what_it_leaves_out():
    mesh = MESHES["cur"]()
    pair = laplacian(mesh)
    basis = fourier_basis(pair, 20)
    f = oracle.rough_functions(mesh, 2)
    inside = basis.inverse(basis.forward(f))
    exact = heat(pair, inside, 0.05, "exact")
    assert np.allclose(heat(pair, inside, 0.05, "spectral", basis=basis), exact, atol=1e-10)
    with pytest.raises(TruncationError, match="20 modes") as caught:
        heat(pair, f, 0.001, "spectral", basis=basis)
    true = heat(pair, f, 0.001, "exact")
    rough = heat(pair, f, 0.001, "spectral", basis=basis, tolerance=1)
    error = pair.norm(rough - true) / pair.norm(f - pair.mean(f))
    assert error <= caught.value.left_out
    rest = pair.norm(f - inside) / pair.norm(f - pair.mean(f))
    assert caught.value.left_out == pytest.approx(rest * np.exp(-0.001 * basis.eigenvalues[-1]))
    long = heat(pair, f, 0.2, "spectral", basis=basis)
    assert pair.norm(long - heat(pair, f, 0.2, "exact")) < 1e-3 * pair.norm(f)


def test_a_basis_and_a_source():
    """The state at rest is found without the basis, so that it leaves out less."""
    mesh = MESHES["closed"]()
    pair = laplacian(mesh)
    f, s = oracle.rough_functions(mesh, 2).T
    basis = fourier_basis(pair, 30)
    found = heat(pair, f, 2.0, "spectral", basis=basis, source=s, tolerance=1e-6)
    assert np.allclose(found, heat(pair, f, 2.0, "exact", source=s), atol=1e-9)


def test_a_basis_that_does_not_fit_is_refused():
    pair = laplacian(MESHES["closed"]())
    other = laplacian(MESHES["closed"](), mass="degree")
    f = np.zeros(pair.n)
    with pytest.raises(BeltramiError, match="another pair"):
        heat(pair, f, 1.0, "spectral", basis=fourier_basis(other, 10))
    stiffer = laplacian(MESHES["closed"](), "combinatorial", "voronoi")
    with pytest.raises(BeltramiError, match="another pair"):
        heat(pair, f, 1.0, "spectral", basis=fourier_basis(stiffer, 10))
    basis = fourier_basis(pair, 10)
    longer = FourierBasis(basis.eigenvalues, 1.1 * basis.eigenvectors, pair.mass, np.zeros(10))
    with pytest.raises(BeltramiError, match="another pair"):
        heat(pair, f, 1.0, "spectral", basis=longer)
    small = laplacian(icosphere(1))
    with pytest.raises(BeltramiError, match="42 vertices"):
        heat(pair, f, 1.0, "spectral", basis=fourier_basis(small, 10))
    with pytest.raises(BeltramiError, match="held vertices"):
        heat(pair, f, 1.0, "spectral", basis=basis, hold=[3])
    constant = fourier_basis(pair, 1)
    ones = heat(pair, np.ones(pair.n), 1.0, "spectral", basis=constant)
    assert np.allclose(ones, 1)
    large = laplacian(icosphere(4))
    with pytest.raises(BeltramiError, match="basis=fourier_basis"):
        heat(large, np.zeros(large.n), 1.0, "spectral")


def test_a_basis_of_functions_that_vanish_where_values_are_held():
    pair = laplacian(MESHES["open"]())
    held = np.arange(pair.n) < 32
    L, B = pair.stiffness.toarray()[32:, 32:], pair.masses[32:]
    values, vectors = np.linalg.eigh(L / np.sqrt(np.outer(B, B)))
    full = np.zeros((pair.n, 15))
    full[32:] = (vectors / np.sqrt(B)[:, None])[:, :15]
    basis = FourierBasis(values[:15], full, pair.mass, np.zeros(15))
    f = MESHES["open"]().vertices[:, 0] ** 2
    found = heat(pair, f, 0.05, "spectral", basis=basis, hold=held)
    expected = heat(pair, f, 0.05, "exact", hold=held)
    assert np.allclose(found, expected, atol=1e-4)


@pytest.mark.parametrize(
    ("method", "option"),
    [
        ("implicit", {"damped_steps": 1}),
        ("explicit", {"damped_steps": 0}),
        ("implicit", {"tolerance": 0.1}),
        ("exact", {"steps": 3}),
        ("spectral", {"steps": 3}),
        ("exact", {"basis": 0}),
    ],
)
def test_options_of_other_methods_are_refused(method, option):
    pair = laplacian(MESHES["open"]())
    (name,) = option
    with pytest.raises(BeltramiError, match=f"'{method}' has no {name}"):
        heat(pair, np.zeros(pair.n), 1.0, method, **option)


@pytest.mark.parametrize("damped", [-1, 1.5])
def test_damped_steps_are_counted(damped):
    pair = laplacian(MESHES["open"]())
    with pytest.raises(BeltramiError, match="damped_steps must be a whole number >= 0"):
        heat(pair, np.zeros(pair.n), 1.0, "crank_nicolson", damped_steps=damped)


def test_sources_are_checked():
    pair = laplacian(MESHES["open"]())
    for source in (np.zeros(3), np.zeros((pair.n, 2)), np.zeros((pair.n, 1))):
        with pytest.raises(DimensionError, match="the source"):
            heat(pair, np.zeros(pair.n), 1.0, source=source)


@pytest.mark.parametrize("method", EXACT)
def test_negative_weights_of_yours_are_no_energy(method):
    import scipy.sparse

    W = scipy.sparse.csr_array([[0, 2.0, 2], [2, 0, -1], [2, -1, 0]])
    pair = laplacian(W, mass="unit")
    with pytest.raises(NegativeWeightError, match="semi-definite") as caught:
        heat(pair, np.zeros(3), 1.0, method)
    assert caught.value.edges.tolist() == [[1, 2]]
    assert heat(pair, np.ones(3), 1.0).tolist() == pytest.approx([1, 1, 1])


@pytest.mark.parametrize("method", HEAT_METHODS)
@pytest.mark.parametrize("unit", [1e-9, 1e9])
def test_any_unit_of_length(method, unit):
    mesh = MESHES["cur"]()
    f, s = oracle.rough_functions(mesh, 2).T
    pair = laplacian(mesh)
    scaled = laplacian(mesh.with_vertices(unit * mesh.vertices))
    time = 4.5 / pair.spectral_bound()
    expected = heat(pair, f, time, method, source=s, hold=[3])
    found = heat(scaled, f, time * unit**2, method, source=s / unit**2, hold=[3])
    assert np.allclose(found, expected, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("method", HEAT_METHODS)
def test_no_columns_and_one_vertex(method):
    pair = laplacian(MESHES["open"]())
    assert heat(pair, np.zeros((pair.n, 0)), 0.001, method).shape == (pair.n, 0)
    import scipy.sparse

    alone = laplacian(scipy.sparse.csr_array((1, 1)), mass="unit")
    assert heat(alone, [2.0], 3.0, method).tolist() == [2]
    assert heat(alone, [2.0], 3.0, method, source=[0.5]).tolist() == pytest.approx([3.5])


def test_implicit_heat_far_away_stays_positive():
    """With positive weights, and tiny: so that its logarithm can be taken."""
    mesh = icosphere(4)
    point = np.zeros(mesh.n_vertices)
    point[7] = 1
    far = heat(laplacian(mesh, "combinatorial", "voronoi"), point, 1e-9, steps=1)
    assert 0 < far.min() < 1e-50
