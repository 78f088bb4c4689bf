"""The picture of the README: one creature, and what is done with it.

python examples/readme_picture.py docs/images/blob.png
"""

import sys

import numpy as np
from PIL import Image

import beltrami as bt

SEEN = {
    "up": "z", "view": (25, 20), "zoom": 1.95, "focus": (-0.06, -0.05, 0.06), "camera": "common",
    "size": (400, 190), "columns": 3, "colorbar": False,
}  # fmt: skip
PALETTE = np.array(
    [[0.90, 0.62, 0.00], [0.34, 0.71, 0.91], [0.00, 0.62, 0.45], [0.94, 0.89, 0.26],
     [0.00, 0.45, 0.70], [0.84, 0.37, 0.00], [0.80, 0.47, 0.65], [0.60, 0.60, 0.60]]
)  # fmt: skip


def functions(mesh, pair, basis):
    """Draw three functions on the mesh: a mode, a wave that lifts it, and distances."""
    unit = mesh.area**0.5
    ends = [int((mesh.vertices @ np.array(at)).argmax()) for at in ([-1, 0, 0], [0.2, 0, 1])]
    start = bt.gaussian_bumps(mesh, ends, 0.04 * unit, [1, -1], balance=pair)
    ((_, wave),) = bt.wave(pair, start, None, [0.45 * unit], "implicit", step=0.01 * unit)
    limit = 0.7 * np.abs(wave).max()
    lifted = mesh.vertices + 0.04 * (wave / limit)[:, None] * mesh.vertex_normals
    distance = bt.geodesic_distance(mesh, ends[1])
    pictures = [
        bt.render(
            mesh, basis.eigenvectors[:, 59], caption="an eigenfunction and its zeros", **SEEN
        ),
        bt.render(
            mesh.with_vertices(lifted), wave, limits=(-limit, limit), level_set=None,
            caption="waves from two points", **SEEN,
        ),
        bt.render(
            mesh, distance, level_set=np.arange(0.12, distance.max(), 0.12),
            caption="distances along the surface", **SEEN,
        ),
    ]  # fmt: skip
    return np.concatenate(pictures, axis=1)


def shapes(mesh, basis):
    """Draw the mesh with noise, without it, and of few frequencies; return the errors as well."""
    noise = np.random.default_rng(0).normal(0, 0.4 * mesh.edge_lengths.mean(), mesh.n_vertices)
    noisy = mesh.with_vertices(mesh.vertices + noise[:, None] * mesh.vertex_normals)
    found = bt.denoise(noisy).mesh
    few = mesh.with_vertices(basis.truncate(mesh.vertices, 100))
    errors = [
        float(np.sqrt(((one.vertices - mesh.vertices) ** 2).sum(axis=1).mean()))
        for one in (noisy, found)
    ]
    captions = [
        "a noisy scan ...",
        "... denoised, without a parameter",
        "its first 100 frequencies",
    ]
    return bt.render([noisy, found, few], caption=captions, **SEEN), errors


def parts(mesh, basis):
    """Draw features made larger, segments, a checkerboard on charts; return whether none folds."""
    gain = 1 + 1.2 * (1 - np.exp(-0.02 * basis.eigenvalues))
    bold = mesh.with_vertices(basis.filter(mesh.vertices, gain, rest=gain[-1]))
    labels = bt.segment(basis, 8, edges=mesh.edges).labels
    charts = bt.atlas(mesh)
    pictures = [
        bt.render(bold, caption="its features, exaggerated", **SEEN),
        bt.render(mesh, PALETTE[labels], caption="its parts", **SEEN),
        bt.render(
            charts.mesh,
            texture="checkerboard",
            caption="charts in the plane, without a fold",
            **SEEN,
        ),
    ]
    return np.concatenate(pictures, axis=1), charts.certificate.is_bijective


def main(path: str, n_vertices: int = 12_000) -> tuple[float, bool]:
    """Draw the picture; return how many times nearer denoising is, and whether no chart folds."""
    mesh = bt.shapes.blob(n_vertices)
    pair = bt.laplacian(mesh)
    basis = bt.fourier_basis(pair, 200)
    second, (noisy, found) = shapes(mesh, basis)
    third, sound = parts(mesh, basis)
    picture = np.concatenate([functions(mesh, pair, basis), second, third])
    Image.fromarray(picture).save(path, optimize=True)
    return noisy / found, sound


if __name__ == "__main__":
    nearer, sound = main(sys.argv[1])
    print(f"nearer to the truth by the factor {nearer:.1f}; maps without a fold: {sound}")
