"""Both schemes are of first order in the step, with errors of opposite sign (E75)."""

import numpy as np
import pytest
from scipy.linalg import expm

import dense_oracles as oracle
from beltrami.diffusion.heat import heat
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import MESHES

pytestmark = pytest.mark.chapter("T16")

STEPS = np.array([20, 40, 80, 160])


@pytest.mark.chapter("P40")
@pytest.mark.parametrize(("name", "weights"), [("closed", "combinatorial"), ("bad", "cotangent")])
def test_first_order_with_opposite_signs(name, weights):
    mesh = MESHES[name]()
    pair = laplacian(mesh, weights, "degree")
    f = oracle.rough_functions(mesh, 1)[:, 0]
    exact = expm(-2 * np.linalg.solve(pair.mass.toarray(), pair.stiffness.toarray())) @ f
    last = []
    for method in ("explicit", "implicit"):
        errors = [heat(pair, f, 2.0, method, int(k)) - exact for k in STEPS]
        slope = np.polyfit(np.log(2 / STEPS), np.log([pair.norm(e) for e in errors]), 1)[0]
        assert slope == pytest.approx(1, abs=0.08)
        last.append(errors[-1])
    cosine = pair.inner(*last) / pair.norm(last[0]) / pair.norm(last[1])
    assert cosine < -0.999
    middle = pair.norm(last[0] + last[1]) / 2  # so their mean is better than either
    assert middle < 0.05 * pair.norm(last[0])


@pytest.mark.parametrize("mass", ["voronoi", "consistent"])
def test_implicit_steps_with_areas(mass):
    mesh = MESHES["cur"]()
    pair = laplacian(mesh, mass=mass)
    f = oracle.rough_functions(mesh, 1)[:, 0]
    exact = expm(-0.02 * np.linalg.solve(pair.mass.toarray(), pair.stiffness.toarray())) @ f
    errors = [pair.norm(heat(pair, f, 0.02, steps=int(k)) - exact) for k in STEPS]
    slope = np.polyfit(np.log(1 / STEPS), np.log(errors), 1)[0]
    assert slope == pytest.approx(1, abs=0.08)


@pytest.mark.parametrize("mass", ["degree", "voronoi", "consistent"])
@pytest.mark.parametrize("damped", [0, 2])
@pytest.mark.parametrize("hold", [False, True])
def test_crank_and_nicolson_are_of_second_order(mass, damped, hold):
    """With damped steps too, with a source and with held values."""
    mesh = MESHES["cur"]()
    pair = laplacian(mesh, mass=mass)
    x, y, _ = mesh.vertices.T
    f, s = np.exp(-20 * ((x - 0.4) ** 2 + (y - 0.6) ** 2)), x * y
    held = (np.arange(pair.n) < 5) & hold
    time = 2.0 if mass == "degree" else 0.02
    exact = heat(pair, f, time, "exact", source=s, hold=held)

    def slope(method, **options):
        errors = [
            pair.norm(heat(pair, f, time, method, int(k), source=s, hold=held, **options) - exact)
            for k in STEPS
        ]
        return np.polyfit(np.log(1 / STEPS), np.log(errors), 1)[0]

    assert slope("crank_nicolson", damped_steps=damped) == pytest.approx(2, abs=0.1)
    assert slope("implicit") == pytest.approx(1, abs=0.1)
