"""What the spectrum tells of a shape: heat that stays, at three times, and its parts.

python examples/descriptors.py descriptors.png
"""

import sys

import numpy as np

import beltrami as bt

PALETTE = np.array(
    [[0.90, 0.62, 0.00], [0.34, 0.71, 0.91], [0.00, 0.62, 0.45], [0.94, 0.89, 0.26],
     [0.00, 0.45, 0.70], [0.84, 0.37, 0.00], [0.80, 0.47, 0.65], [0.60, 0.60, 0.60]]
)  # fmt: skip


def main(path: str, n_vertices: int = 1900) -> int:
    """Draw the picture; return the number of segments."""
    mesh = bt.shapes.blob(n_vertices)
    basis = bt.fourier_basis(bt.laplacian(mesh), 60)
    heat = bt.heat_kernel_signature(basis, count=5)
    shown = [heat.values[:, i] / heat.values[:, i].max() for i in (0, 2, 4)]
    parts = bt.segment(basis, 8, edges=mesh.edges)
    captions = [f"heat that stays for the time {heat.at[i]:.2g}" for i in (0, 2, 4)]
    bt.render(
        [mesh] * 4,
        [*shown, PALETTE[parts.labels]],
        path,
        caption=[*captions, f"{parts.count} segments"],
        up="z",
        view=(25, 20),
        size=(620, 280),
        zoom=1.95,
        focus=(-0.06, -0.05, 0.06),
        columns=2,
        colorbar=False,
        level_set=None,
    )
    return parts.count


if __name__ == "__main__":
    print(f"segments: {main(sys.argv[1])}")
