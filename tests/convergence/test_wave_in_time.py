"""The schemes of the wave are of second order in the step; the printed start is of first (E58)."""

import numpy as np
import pytest

from beltrami.diffusion.wave import wave
from beltrami.operators.laplacian import laplacian
from meshes_of_the_errata import MESHES

STEPS = np.array([20, 40, 80, 160])
TIME = 0.3


def bump(mesh, at):
    return np.exp(-15 * ((mesh.vertices - at) ** 2).sum(axis=1))


def order(errors):
    return np.polyfit(np.log(1 / STEPS), np.log(errors), 1)[0]


def last(*arguments, **options):
    *_, (_, frame) = wave(*arguments, **options)
    return frame


@pytest.mark.chapter("Q3.8", "U26", "U33")
@pytest.mark.parametrize("method", ["leapfrog", "implicit"])
@pytest.mark.parametrize("mass", ["voronoi", "consistent"])
@pytest.mark.parametrize("hold", [False, True])
def test_second_order(method, mass, hold):
    mesh = MESHES["cur"]()
    pair = laplacian(mesh, "combinatorial", mass) if method == "leapfrog" else laplacian(mesh)
    f, g = bump(mesh, mesh.vertices[40]), -2 * bump(mesh, mesh.vertices[90])
    held = (np.arange(pair.n) < 32) & hold
    time = 40 / np.sqrt(pair.spectral_bound())
    exact = last(pair, f, g, [time], "spectral", hold=held)
    errors = [
        pair.norm(last(pair, f, g, [time], method, step=time / k, hold=held) - exact)
        for k in 2 * STEPS
    ]
    assert order(errors) == pytest.approx(2, abs=0.1)


@pytest.mark.chapter("U26")
@pytest.mark.parametrize(("name", "weights"), [("closed", "combinatorial"), ("bad", "cotangent")])
def test_the_printed_start_is_of_first_order(name, weights):
    mesh = MESHES[name]()
    pair = laplacian(mesh, weights, "degree")
    f, g = bump(mesh, mesh.vertices[40]), bump(mesh, mesh.vertices[90])
    exact = last(pair, f, g, [4.0], "spectral")

    def recursion(steps, printed):
        delta = 4 / steps
        before, now = f, f + delta * g
        if not printed:
            now = now - delta**2 / 2 * pair.apply(f)
        for _ in range(steps - 1):
            before, now = now, 2 * now - before - delta**2 * pair.apply(now)
        return now

    ours = [last(pair, f, g, [4.0], step=4 / k) for k in STEPS]
    for k, frame in zip(STEPS, ours, strict=True):
        assert np.allclose(frame, recursion(k, printed=False), atol=1e-12)
    assert order([pair.norm(frame - exact) for frame in ours]) == pytest.approx(2, abs=0.05)
    printed = [pair.norm(recursion(k, printed=True) - exact) for k in STEPS]
    assert order(printed) == pytest.approx(1, abs=0.1)
