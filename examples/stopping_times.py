"""Figures 3.3 and 3.5, and when to stop: smoothing, denoising, the best time and the noise.

python examples/stopping_times.py FOLDER
"""

import sys
from pathlib import Path

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import beltrami as bt

ROUNDS = (0, 5, 20, 80, 320, 1280)
LEVEL = 0.3  # of the noise, in mean edge lengths
BESIDE = {
    "up": "z", "view": (25, 20), "zoom": 2.05, "focus": (-0.06, -0.05, 0.06), "camera": "common",
    "size": (520, 250), "columns": 3,
}  # fmt: skip


def smoothed(mesh, rounds=ROUNDS):
    """Return the mesh after so many rounds of averaging, and the Dirichlet energies.

    Chapter items: F3.3.
    """
    pair = bt.laplacian(mesh, "combinatorial")
    states = [mesh.with_vertices(bt.smooth(pair, mesh.vertices, k)) for k in rounds]
    return states, [pair.dirichlet_energy(state.vertices) for state in states]


def with_noise(mesh, level=LEVEL, seed=0):
    """Move the vertices along the normals, by white noise of a level in mean edge lengths."""
    noise = np.random.default_rng(seed).normal(size=(mesh.n_vertices, 1))
    return mesh.with_vertices(
        mesh.vertices + level * mesh.edge_lengths.mean() * noise * mesh.vertex_normals
    )


def errors_of_times(truth, noisy, times):
    """Return the states of heat from the noisy positions, and their errors in mean edges.

    Chapter items: F3.5.
    """
    pair = bt.laplacian(noisy, "combinatorial")
    states = [noisy.with_vertices(bt.heat(pair, noisy.vertices, t, steps=2)) for t in times]
    edge = truth.edge_lengths.mean()
    away = [np.linalg.norm(state.vertices - truth.vertices, axis=1) for state in states]
    return states, np.array([np.sqrt((one**2).mean()) / edge for one in away])


def best_times(eigenvalues, coefficients, share, sigmas):
    r"""Return for each σ the time at which the expected error of heat is least.

    It is :math:`\sum (1 - e^{-\lambda t})^2 \hat f^2 + \sigma^2 a \sum e^{-2\lambda t}`, a the area
    that belongs to one vertex: the share of the noise in each coefficient.

    Chapter items: P44.
    """
    times = np.geomspace(1e-3, 1, 400)
    remains = np.exp(-np.outer(times, eigenvalues))
    lost = ((1 - remains) ** 2) @ coefficients**2
    noise = share * (remains**2).sum(axis=1)
    return np.array([times[(lost + sigma**2 * noise).argmin()] for sigma in sigmas])


def exponents(sphere):
    """Return the σ, the best times and the slopes for smooth, rough and jumping functions."""
    basis = bt.fourier_basis(bt.laplacian(sphere), sphere.n_vertices - 1)
    values = np.maximum(basis.eigenvalues, 0)
    rough = np.divide(1, values, out=np.zeros_like(values), where=values > 1)
    z = sphere.vertices[:, 2]
    functions = {
        "smooth: σ^(2/3)": (basis.forward(z**2 + z), np.geomspace(0.02, 3, 12)),
        "one derivative: σ": (rough, np.geomspace(0.1, 2, 12)),
        "a jump: σ^(4/3)": (basis.forward(np.sign(z - 0.1)), np.geomspace(0.7, 4, 12)),
    }
    share = sphere.area / sphere.n_vertices
    found = {}
    for name, (coefficients, sigmas) in functions.items():
        times = best_times(values, coefficients, share, sigmas)
        slope = np.polyfit(np.log(sigmas), np.log(times), 1)[0]
        found[name] = (sigmas, times, slope)
    return found


def chart(curves, labels, path, marks=()):
    """Draw curves on logarithmic axes; ``marks`` are points."""
    figure = Figure(figsize=(7, 4.4), dpi=100, layout="constrained")
    canvas = FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    for name, (x, y) in curves.items():
        axes.plot(x, y, "o-", ms=4, label=name)
    for x, y in marks:
        axes.plot([x], [y], "k*", ms=14)
    axes.set(xscale="log", yscale="log", xlabel=labels[0], ylabel=labels[1])
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False)
    canvas.print_png(str(path))


def main(folder):
    """Draw all; return the energies, the errors, the blind error and the slopes."""
    place = Path(folder)
    truth = bt.shapes.blob(6000)
    states, energies = smoothed(truth)
    names = ["the mesh", *(f"{k} rounds of averaging" for k in ROUNDS[1:])]
    bt.render(states, None, place / "smoothing.png", caption=names, **BESIDE)

    noisy = with_noise(truth)
    times = np.geomspace(0.1, 100, 13)
    states, errors = errors_of_times(truth, noisy, times)
    best = int(errors.argmin())
    blind = bt.denoise(noisy)
    away = np.linalg.norm(blind.mesh.vertices - truth.vertices, axis=1)
    error = float(np.sqrt((away**2).mean()) / truth.edge_lengths.mean())
    shown = [truth, noisy, states[best // 2], states[best], states[-4], blind.mesh]
    names = ["the mesh", f"with noise: error {LEVEL}"]
    names += [
        f"heat, t = {times[i]:.2g}{said}: {errors[i]:.2f}"
        for i, said in ((best // 2, ""), (best, ", best"), (-4, ""))
    ]
    names.append(f"denoise, told nothing: {error:.2f}")
    bt.render(shown, None, place / "denoising.png", caption=names, **BESIDE)
    curves = {
        "heat, the star at its best time": (times, errors),
        "denoise, which is told neither time nor noise": (times[[0, -1]], [error, error]),
    }
    labels = ("time t (1: a round of averaging)", "error (mean edge lengths)")
    chart(curves, labels, place / "errors.png", [(times[best], errors[best])])

    found = exponents(bt.shapes.icosphere(4))
    lines = {f"{name}, found {slope:.2f}": (x, y) for name, (x, y, slope) in found.items()}
    chart(lines, ("noise σ", "best time"), place / "stopping_times.png")
    return energies, errors, error, {name: slope for name, (_, _, slope) in found.items()}


if __name__ == "__main__":
    energies, errors, error, slopes = main(sys.argv[1])
    print("energies", *(f"{energy:.4g}" for energy in energies))
    print("errors of heat", *(f"{one:.3f}" for one in errors), "of denoise", f"{error:.3f}")
    print("exponents", *(f"{name}: {slope:.2f};" for name, slope in slopes.items()))
