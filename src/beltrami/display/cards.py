"""Cards for notebooks: what an object is, in a few lines, beside a thumbnail.

The package root registers this file; objects call it through ``_carded``.
"""

from __future__ import annotations

import base64
from collections.abc import Iterable
from functools import singledispatch
from html import escape
from typing import TypeAlias

import numpy as np

from beltrami.diffusion.denoised import Denoised
from beltrami.display.sketches import as_png, sparsity_sketch, spectrum_sketch
from beltrami.display.srgb import Image
from beltrami.display.thumbnail import thumbnail
from beltrami.errors import MeshError
from beltrami.mesh.diagnose import Diagnosis
from beltrami.mesh.mesh import Mesh
from beltrami.operators.pair import Laplacian
from beltrami.parameterization.parameterization import Parameterization
from beltrami.parameterization.texture_atlas import TextureAtlas
from beltrami.spectrum.basis import FourierBasis

Rows: TypeAlias = list[tuple[str, str]]

_EXAMINED = 200_000  # faces up to which a card says what the topology is
_FAR_APART = np.log(4.0)  # areas that differ by this factor have the last colours of the map


def html(thing: object) -> str:
    """Return the card of an object: a table, and its picture if there is one."""
    drawn = picture(thing)
    image = ""
    if drawn is not None:
        code = base64.b64encode(as_png(drawn)).decode("ascii")
        height, width = drawn.shape[:2]
        image = (
            f'<img width="{width}" height="{height}" alt="{escape(_title(thing))}" '
            f'src="data:image/png;base64,{code}">'
        )
    return (
        '<div style="display:flex;flex-wrap:wrap;align-items:center;gap:1em">'
        f"{image}<div><strong>{escape(_title(thing))}</strong>"
        f'<table style="margin:0.3em 0">{_table(rows(thing))}</table></div></div>'
    )


def png(thing: object) -> bytes | None:
    """Return the picture of an object as the bytes of a PNG, or None."""
    drawn = picture(thing)
    return None if drawn is None else as_png(drawn)


def _title(thing: object) -> str:
    return type(thing).__name__


def _table(lines: Iterable[tuple[str, str]]) -> str:
    cell = '<td style="text-align:left;padding:0.1em 0.8em 0.1em 0">'
    return "".join(f"<tr>{cell}{escape(k)}</td>{cell}{escape(v)}</td></tr>" for k, v in lines)


# ------------------------------------------------------------------------------------- pictures


@singledispatch
def picture(thing: object) -> Image | None:
    """Return the picture of an object, (h, w, 4), or None."""
    raise TypeError(f"no card for {type(thing).__name__}")


@picture.register
def _(mesh: Mesh) -> Image | None:
    return thumbnail(mesh, _colours(mesh), wireframe=True)


@picture.register
def _(pair: Laplacian) -> Image | None:
    i, j = pair.edges.T
    diagonal = np.arange(pair.n)
    rows, columns = np.concatenate([i, j, diagonal]), np.concatenate([j, i, diagonal])
    return sparsity_sketch(rows, columns, pair.n)


@picture.register
def _(basis: FourierBasis) -> Image | None:
    return spectrum_sketch(basis.eigenvalues)


@picture.register
def _(psi: Parameterization) -> Image | None:
    """Draw the image in the plane; red where areas grow, blue where they shrink."""
    areas = np.clip(psi.distortion.area, 1e-9, 1e9)
    corners = psi.flat.faces.ravel()
    count = np.bincount(corners, minlength=psi.flat.n_vertices)
    grown = np.bincount(corners, np.repeat(np.log(areas), 3), psi.flat.n_vertices)
    f = grown / np.maximum(count, 1)
    return thumbnail(psi.flat, f, limits=(-_FAR_APART, _FAR_APART), wireframe=True)


@picture.register
def _(charts: TextureAtlas) -> Image | None:
    return picture(charts.map)


@picture.register
def _(found: Denoised) -> Image | None:
    return thumbnail(found.mesh)


@picture.register
def _(_found: Diagnosis) -> Image | None:
    return None


def _colours(mesh: Mesh) -> Image | None:
    """Return the data "color" of a mesh as bytes, if they are colours."""
    given = mesh.vertex_data.get("color")
    if given is None or given.ndim != 2 or given.shape[1] not in (3, 4):
        return None
    scale = 1.0 if given.dtype.kind in "iu" else 255.0
    finite = np.nan_to_num(np.asarray(given[:, :3], np.float64), posinf=0.0, neginf=0.0)
    return np.rint(np.clip(finite, 0, 255 / scale) * scale).astype(np.uint8)


# ----------------------------------------------------------------------------------------- rows


@singledispatch
def rows(thing: object) -> Rows:
    """Return what the card says: pairs of a name and a value."""
    raise TypeError(f"no card for {type(thing).__name__}")


@rows.register
def _(mesh: Mesh) -> Rows:
    found = [
        ("vertices", f"{mesh.n_vertices}, {mesh.dimension} coordinates each"),
        ("faces", f"{mesh.n_faces}"),
        ("surface", _surface(mesh)),
    ]
    finite = np.isfinite(mesh.vertices).all(axis=1)
    if finite.any():
        low, high = (bound(mesh.vertices[finite], axis=0) for bound in (np.min, np.max))
        with np.errstate(over="ignore"):
            found.append(("size", " × ".join(f"{side:.4g}" for side in high - low)))
    if not finite.all():
        found.append(("not finite", f"{(~finite).sum()} vertices: see bt.diagnose(mesh)"))
    if mesh.vertex_data:
        found.append(("data", ", ".join(mesh.vertex_data)))
    if mesh.corner_uv is not None:
        found.append(("uv", "in the corners of the faces"))
    return found


def _surface(mesh: Mesh) -> str:
    """Say what the topology is, if finding out takes no time."""
    topology = mesh.topology
    if not mesh.n_faces:
        return "none"
    if mesh.n_faces > _EXAMINED:
        return "large: bt.diagnose(mesh) examines it"
    if not topology.is_manifold:
        return "not manifold: see bt.diagnose(mesh)"
    loops = len(topology.boundary_loops)
    boundary = "closed" if topology.is_closed else f"boundary of {loops} loop{'s'[loops == 1 :]}"
    try:
        return f"{boundary}, genus {topology.genus}"
    except MeshError:
        return f"{boundary}, not orientable"


@rows.register
def _(pair: Laplacian) -> Rows:
    negative = int((pair.edge_weight < -1e-12).sum())
    return [
        ("matrices", f"{pair.n} × {pair.n}, {pair.stiffness.nnz} entries"),
        ("weights", f"{pair.weight_kind}, {negative} of {len(pair.edges)} negative"),
        ("mass", f"{pair.mass_kind}, {pair.masses.sum():.6g} in all"),
        ("", repr(pair).split(", ")[-1].rstrip(">").strip()),
    ]


@rows.register
def _(basis: FourierBasis) -> Rows:
    found = [("eigenpairs", f"{basis.k} of {basis.n}")]
    if basis.k:
        first, last = basis.eigenvalues[0], basis.eigenvalues[-1]
        found.append(("eigenvalues", f"{first:.4g} to {last:.4g}"))
        found.append(("largest residual", f"{basis.residuals.max():.2g}"))
    how = basis.computation
    seconds = sum(time for _, time in how.seconds)
    found.append(("found by", f"{how.method}, {how.precision}, {seconds:.2g} s"))
    return found


@rows.register
def _(psi: Parameterization) -> Rows:
    measured = psi.distortion
    return [
        ("vertices", f"{psi.mesh.n_vertices}, {len(psi.cut_edges)} edges cut"),
        ("method", psi.method),
        ("bijection", "yes, decided exactly" if psi.is_bijective else "NO"),
        ("flipped faces", f"{len(psi.flipped)}"),
        ("ratio of lengths", f"{measured.mean_conformal:.4g} in the mean; 1 keeps angles"),
        ("ratio of areas", f"{measured.mean_area:.4g} in the mean; 1 keeps areas"),
    ]


@rows.register
def _(charts: TextureAtlas) -> Rows:
    filled = f"{charts.fill:.0%} of the square, {charts.size} texels a side"
    return [("charts", f"{charts.count}, in {filled}"), *rows(charts.map)]


@rows.register
def _(found: Denoised) -> Rows:
    change = found.volume_change
    mostly = found.mixture[0][0] if found.mixture else "nothing to do"
    return [
        ("noise", f"σ = {found.sigma:.3g}, {found.noise.relative:.3g} of the mean edge"),
        ("filter", f"mostly {mostly}"),
        ("expected error", f"{found.predicted_error:.3g}"),
        ("volume", "open surface" if np.isnan(change) else f"{change:+.3%}"),
        *(("warning", text) for text in found.warnings),
    ]


@rows.register
def _(found: Diagnosis) -> Rows:
    facts = [line for line in found.report().splitlines() if not line.startswith("- ")]
    return [("", line) for line in facts] + [("✗", str(defect)) for defect in found.defects]
