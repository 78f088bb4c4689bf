"""What travels in a page: a mesh, its eigenpairs, functions, a map, a noisy and a mended copy."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from beltrami._arrays import Floats
from beltrami.diffusion.denoise import denoise
from beltrami.display.colormaps import COLORMAPS, color_table
from beltrami.display.page_codes import Guesses, Sections, face_residuals, guesses_of, quantized
from beltrami.display.page_maps import made_map, own_coordinates, own_map
from beltrami.display.page_order import Order, order_of
from beltrami.display.page_picture import PagePicture
from beltrami.errors import BeltramiError
from beltrami.mesh.geometry import in_space
from beltrami.mesh.mesh import Mesh
from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.basis import FourierBasis
from beltrami.spectrum.fourier_basis import fourier_basis

COLOURS = 127  # levels on each side of 0, at least, of an eigenvector: what colours show
_FINEST = 8191  # levels at most, so that residuals fit into two bytes
_ERROR = 0.01  # of the mean edge: what rounding one eigenvector may move the shape by
_PLACE = 0.005  # of the mean edge: the steps of positions
_SEED = 1


@dataclass(frozen=True)
class Wanted:
    """What ``page`` was asked for; its parameters say what each field means."""

    modes: int
    laplacians: tuple[str, ...]
    plane: bool
    noise: float
    up: str
    unit: str
    textured: bool = False
    picture: PagePicture | None = None


@dataclass(frozen=True, eq=False)
class Contents:
    """A page before it is written.

    Attributes
    ----------
    header
        All that is small, for JSON; the names of sections are those of ``sections``.
    sections
        All that is large.
    notes
        What is not in it, and why.
    """

    header: dict[str, Any]
    sections: Sections
    notes: tuple[str, ...]


def page_contents(
    mesh: Mesh,
    functions: Mapping[str, Floats],
    wanted: Wanted,
    tell: Callable[[], None],
) -> Contents:
    """Compute what the page needs; ``tell`` is called after each part of the work."""
    positions, faces = in_space(mesh.vertices, mesh.faces)
    order = order_of(faces, len(positions))
    sections = Sections()
    guesses = guesses_of(order.faces, len(positions))
    edge = float(mesh.edge_lengths.mean())
    x = positions[order.vertices]
    sections.add("faces", face_residuals(order.faces))
    origin = x.min(axis=0)
    places = quantized(x - origin, np.full(3, _PLACE * edge))
    sections.add("positions", guesses.residuals(places))
    numbers = np.diff(order.vertices, prepend=0)[:, None]
    sections.add("numbers", numbers)
    header: dict[str, Any] = {
        "n": len(positions),
        "m": len(faces),
        "origin": origin.tolist(),
        "step": _PLACE * edge,
        "edge": edge,
        "up": wanted.up,
        "unit": wanted.unit,
        "planar": mesh.dimension == 2,
        "colours": {name: _hexadecimal(name) for name in COLORMAPS},
        "functions": [{"name": name} for name in functions],
        "spectra": [],
    }
    _add_functions(sections, header, guesses, functions, order)
    tell()
    for kind in wanted.laplacians:
        _add_spectrum(sections, header, guesses, mesh, kind, functions, order, wanted.modes)
        tell()
    header |= _maps(sections, mesh, order, wanted)
    tell()
    header["comparison"] = _comparison(sections, mesh, order, wanted, edge)
    tell()
    parts = (("the map to the plane", "plane"), ("the comparison of noise", "comparison"))
    notes = [
        f"without {what}: {header[key]['reason']}" for what, key in parts if "reason" in header[key]
    ]
    notes += _add_picture(sections, header, wanted.picture)
    header["sections"] = sections.entries
    return Contents(header, sections, tuple(notes))


def _add_functions(
    sections: Sections,
    header: dict[str, Any],
    guesses: Guesses,
    functions: Mapping[str, Floats],
    order: Order,
) -> None:
    """Append functions on the vertices, on 255 levels each."""
    values = np.stack(list(functions.values()), axis=1)[order.vertices]
    low, high = values.min(axis=0), values.max(axis=0)
    steps = (high / 2 - low / 2) / COLOURS
    for entry, least, most, step in zip(header["functions"], low, high, steps, strict=True):
        entry |= {"low": float(least), "high": float(most), "step": float(step)}
    sections.add("functions", guesses.residuals(quantized(values - low, steps)))


def _add_spectrum(
    sections: Sections,
    header: dict[str, Any],
    guesses: Guesses,
    mesh: Mesh,
    kind: str,
    functions: Mapping[str, Floats],
    order: Order,
    modes: int,
) -> None:
    """Append eigenpairs of one Laplacian, and the coefficients of the shape and the functions."""
    pair = laplacian(mesh, kind)
    basis = fourier_basis(pair, min(modes, pair.n))
    positions = in_space(mesh.vertices, mesh.faces)[0]
    centre = pair.mean(positions)
    shape = basis.forward(positions - centre)
    steps = _steps(basis, shape, float(mesh.edge_lengths.mean()))
    named = "eigenvectors: " + kind
    levels = quantized(basis.eigenvectors[order.vertices], steps)
    sections.add(named, guesses.residuals(levels))
    header["spectra"].append(
        {
            "kind": kind,
            "mass": pair.mass_kind,
            "section": named,
            "eigenvalues": _short(np.maximum(basis.eigenvalues, 0)),
            "steps": steps.tolist(),
            "centre": centre.tolist(),
            "shape": [_short(column) for column in shape.T],
            "decay": _short(_together(basis, positions - centre)),
            "total": float(pair.masses.sum()),
            "functions": [
                {
                    "coefficients": _short(basis.forward(f)),
                    "outside": float(basis.error_decay(f)[-1]),
                }
                for f in functions.values()
            ],
        }
    )


def _steps(basis: FourierBasis, shape: Floats, edge: float) -> Floats:
    """(k,) steps of the eigenvectors: fine enough for colours, and for their part of the shape."""
    largest = np.abs(basis.eigenvectors).max(axis=0)
    part = np.abs(shape).max(axis=1) * largest
    levels = np.clip(part / (2 * _ERROR * edge), COLOURS, _FINEST)
    return np.asarray(largest / np.floor(levels))


def _together(basis: FourierBasis, positions: Floats) -> Floats:
    """(k + 1,) errors of the shape of m terms, the three coordinates together."""
    return np.asarray(np.sqrt((basis.error_decay(positions) ** 2).sum(axis=1)))


def _maps(sections: Sections, mesh: Mesh, order: Order, wanted: Wanted) -> dict[str, Any]:
    """Append the map that is made, and the coordinates of the mesh if a texture is to lie on it."""
    made = made_map(sections, mesh, order) if wanted.plane else {"reason": "it was not asked for."}
    uv = own_coordinates(mesh) if wanted.textured else None
    own = None if uv is None else own_map(sections, mesh, order, uv)
    return {"plane": made, "own": own, "textured": wanted.textured}


def _add_picture(
    sections: Sections, header: dict[str, Any], picture: PagePicture | None
) -> list[str]:
    """Append the picture that lies on a map; return what there is to say of it."""
    header["picture"] = None
    if picture is None:
        return []
    if header["own"] is None and "reason" in header["plane"]:
        return ["without the texture: there is no map to lay it on."]
    sections.add_bytes("picture", picture.data)
    width, height = picture.size
    header["picture"] = {"kind": picture.kind, "width": width, "height": height}
    return [f"the texture {picture.note}."] if picture.note else []


def _comparison(
    sections: Sections, mesh: Mesh, order: Order, wanted: Wanted, edge: float
) -> dict[str, Any]:
    """Append a copy with noise along the normals, and what ``denoise`` makes of it."""
    if wanted.noise == 0:
        return {"reason": "it was not asked for."}
    if mesh.dimension == 2:
        return {"reason": "the mesh lies in the plane, and noise would leave it."}
    sigma = wanted.noise * edge
    try:
        normals = mesh.vertex_normals
        moved = np.random.default_rng(_SEED).normal(0.0, sigma, mesh.n_vertices)
        noisy = mesh.with_vertices(mesh.vertices + normals * moved[:, None])
        mended = denoise(noisy)
    except BeltramiError as error:
        return {"reason": str(error)}
    step = _ERROR * edge
    for name, copy in (("noisy", noisy), ("denoised", mended.mesh)):
        away = (copy.vertices - mesh.vertices)[order.vertices]
        sections.add(name, quantized(away, np.full(3, step)))
    errors = {
        name: float(np.sqrt(((copy.vertices - mesh.vertices) ** 2).sum(axis=1).mean()))
        for name, copy in (("noisy", noisy), ("denoised", mended.mesh))
    }
    return {
        "step": step,
        "sigma": sigma,
        "found": mended.sigma,
        "mixture": [name for name, _ in mended.mixture[:2]],
        "warnings": list(mended.warnings),
        "errors": errors,
    }


def _hexadecimal(name: str) -> str:
    """Return 256 colours of a map, from its lowest value to its highest, as rrggbb."""
    table = color_table(name)
    chosen = table[np.linspace(0, len(table) - 1, 256).round().astype(int)]
    return np.rint(255 * chosen).astype(np.uint8).tobytes().hex()


def _short(values: Floats) -> list[float]:
    """Return numbers with nine digits."""
    return [float(f"{value:.9g}") for value in values.tolist()]
