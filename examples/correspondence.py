"""A functional map: colours go from a creature to its bent copy, which has other vertices.

Twenty pairs of vertices that are only about right start it; ZoomOut sharpens it.

python examples/correspondence.py correspondence.png
"""

import sys

import numpy as np

import beltrami as bt


def main(path: str, n_vertices: int = 1500) -> tuple[float, float]:
    """Draw the picture; return the mean errors of the start and of the refined map."""
    mesh = bt.shapes.blob(n_vertices)
    other = bt.shapes.blob(n_vertices + n_vertices // 4)
    here, there = (np.hstack([m.vertices, 0.2 * m.vertex_normals]) for m in (mesh, other))
    truth = np.array([np.square(here - y).sum(axis=1).argmin() for y in there])
    x, y, z = other.vertices.T
    r = 1 / 0.6 + z  # the x-axis becomes a circle of the curvature 0.6
    copy = other.with_vertices(
        np.column_stack([r * np.sin(0.6 * x), y, r * np.cos(0.6 * x) - 1 / 0.6])
    )
    source, target = (bt.fourier_basis(bt.laplacian(m), 80) for m in (mesh, copy))

    start = bt.functional_map(source, target, landmarks=_landmarks(mesh, other, truth), k=30)
    fine = bt.zoomout(start)

    colours = 0.62 + 0.32 * np.sin(6 * mesh.vertices + mesh.vertex_normals)
    bt.render(
        [mesh, copy, copy],
        [colours, colours[start.point_map], colours[fine.point_map]],
        path,
        caption=["a creature", "bent: colours by 20 noisy landmarks", "and refined by ZoomOut"],
        up="z",
        view=(25, 20),
        size=(520, 250),
        zoom=1.9,
        columns=3,
    )
    return tuple(_error(mesh, found.point_map, truth) for found in (start, fine))


def _landmarks(mesh: bt.Mesh, other: bt.Mesh, truth: np.ndarray) -> np.ndarray:
    """Twenty target vertices far from each other, with source vertices moved by about 0.1."""
    rng = np.random.default_rng(0)
    chosen = [0]
    for _ in range(19):
        gaps = [np.linalg.norm(other.vertices - other.vertices[c], axis=1) for c in chosen]
        chosen.append(int(np.min(gaps, axis=0).argmax()))
    moved = [
        rng.choice(np.flatnonzero(bt.geodesic_distance(mesh, truth[c], method="edges") < 0.15))
        for c in chosen
    ]
    return np.column_stack([moved, chosen])


def _error(mesh: bt.Mesh, found: np.ndarray, truth: np.ndarray) -> float:
    """Mean distance along the surface from the truth, over a sample, in roots of the area."""
    heat = bt.HeatMethod(mesh)
    sample = np.random.default_rng(1).choice(len(truth), 60, replace=False)
    errors = [heat.distance(int(truth[i]))[found[i]] for i in sample]
    return float(np.mean(errors) / np.sqrt(mesh.area))


if __name__ == "__main__":
    before, after = main(sys.argv[1])
    print(f"mean error in roots of the area: {before:.4f} at the start, {after:.4f} refined")
