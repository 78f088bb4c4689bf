"""Verbs that measure a mesh, and those of its Laplacian and of its spectrum."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from beltrami.batch.memory import (
    of_curvature,
    of_descriptors,
    of_integrals,
    of_pair,
    of_parameterization,
    of_spectrum,
)
from beltrami.batch.parameters import Choice, Flag, Number, Numbers, Parameter, Whole
from beltrami.batch.verb import Options, Scene, Told, Verb, Writer, table
from beltrami.batch.verbs_of_meshes import WEIGHTS
from beltrami.errors import BeltramiError
from beltrami.io.npz import write_arrays
from beltrami.operators.areas import AREA_KINDS
from beltrami.operators.curvature import curvature
from beltrami.operators.edge_areas import EDGE_AREA_KINDS
from beltrami.operators.integrals import PLACES, integrate
from beltrami.operators.pair import MASSES
from beltrami.operators.weights import SYMMETRIC_WEIGHTS
from beltrami.parameterization.boundary import SPACINGS
from beltrami.parameterization.parameterize import METHODS, parameterize
from beltrami.spectrum.basis import FourierBasis
from beltrami.spectrum.fourier_basis import fourier_basis
from beltrami.spectrum.heat_kernel import heat_kernel_signature
from beltrami.spectrum.shape_dna import NORMALIZATIONS, shape_dna
from beltrami.spectrum.signature import Signature
from beltrami.spectrum.wave_kernel import wave_kernel_signature

ARRAYS: Final = "arrays of a batch"  # the kind, in the header of the files
VERSION: Final = 1
_KINDS: Final = ("all", "hks", "wks", "shape-dna")
_PAIR: Final[Mapping[str, Parameter]] = {"weights": Choice(WEIGHTS), "mass": Choice(MASSES)}
_SAVE: Final[Mapping[str, Parameter]] = {"save": Flag(True)}


def _saved(options: Options, arrays: Mapping[str, NDArray[Any]]) -> tuple[str, Writer | None]:
    """Return the suffix and the writer of a file of arrays, if it is wanted."""
    if not options["save"] or not arrays:
        return "", None
    return ".npz", lambda path: write_arrays(path, ARRAYS, VERSION, arrays)


def _integrate(scene: Scene, options: Options) -> Told:
    mesh = scene.mesh
    of_all = np.column_stack([np.ones(mesh.n_vertices), mesh.vertices])
    area, *moments = integrate(mesh, of_all, **options).tolist()
    inside = mesh.is_closed and mesh.is_manifold and mesh.is_oriented and mesh.dimension == 3
    facts = {
        "area": area,
        "volume": mesh.volume if inside else None,
        "centroid": [moment / area for moment in moments],
    }
    return Told(scene, facts)


def _check_integrate(options: Options) -> None:
    kinds = tuple(AREA_KINDS) if options["how"] == "vertex" else EDGE_AREA_KINDS
    if options.get("areas", kinds[0]) not in kinds:
        raise BeltramiError(f"areas at the {options['how']} are one of {', '.join(kinds)}")


def _curvature(scene: Scene, options: Options) -> Told:
    found = curvature(scene.mesh)
    facts: dict[str, Any] = {
        "total": float(found.angle_defect.sum() + found.turning.sum()),
        "gauss_bonnet": 2 * np.pi * scene.mesh.euler_characteristic,
    }
    for name, values in (("gaussian", found.gaussian), ("mean", found.mean)):
        facts[f"{name}_smallest"] = float(values.min())
        facts[f"{name}_median"] = float(np.median(values))
        facts[f"{name}_largest"] = float(values.max())
        facts[f"{name}_integral"] = float(found.areas @ values)
    arrays = {name: getattr(found, name) for name in ("gaussian", "mean", "principal", "areas")}
    return Told(scene, facts, *_saved(options, arrays))


def _laplacian(scene: Scene, options: Options) -> Told:
    pair = scene.pair_of(options.get("weights"), options.get("mass"))
    facts = {
        "n_entries": int(pair.stiffness.nnz),
        "n_negative_weights": int((pair.edge_weight < 0).sum()),
        "smallest_weight": float(pair.edge_weight.min()),
        "largest_weight": float(pair.edge_weight.max()),
        "mass": float(pair.masses.sum()),
        "spectral_bound": pair.spectral_bound(),
    }
    arrays = {
        f"{name}_{part}": getattr(matrix, part)
        for name, matrix in (("stiffness", pair.stiffness), ("mass", pair.mass))
        for part in ("data", "indices", "indptr")
    }
    return Told(Scene(scene.mesh, pair), facts, *_saved(options, arrays))


def _spectrum(scene: Scene, options: Options) -> Told:
    pair = scene.pair_of(options.get("weights"), options.get("mass"))
    basis = fourier_basis(
        pair,
        options["k"],
        options["near"],
        options["tolerance"],
        hold=scene.mesh.topology.on_boundary if options["hold_boundary"] else (),
        certify=options["certify"],
    )
    facts = {
        "eigenvalues": basis.eigenvalues.tolist(),
        "largest_residual": float(basis.residuals.max()),
    }
    after = Scene(scene.mesh, pair, basis)
    if not options["save"]:
        return Told(after, facts)
    timeless = replace(basis.computation, seconds=())  # so that the same work gives the same file
    return Told(after, facts, ".npz", replace(basis, computation=timeless).save)


def _descriptors(scene: Scene, options: Options) -> Told:
    basis, kind, count = scene.basis, options["kind"], options["count"]
    if basis is None:
        raise BeltramiError("descriptors need a spectrum before them")
    invariant = options["scale_invariant"]
    facts: dict[str, Any] = {}
    arrays: dict[str, NDArray[Any]] = {}
    if kind in ("all", "shape-dna"):
        arrays["shape_dna"] = shape_dna(basis, options["normalization"])
        facts["shape_dna"] = arrays["shape_dna"].tolist()
    if kind in ("all", "hks"):
        heat = heat_kernel_signature(
            basis, options.get("times"), count=count, scale_invariant=invariant
        )
        arrays |= {"hks": heat.values, "hks_times": heat.at}
        facts |= {"hks_times": heat.at.tolist(), "hks_mean": _mean(basis, heat)}
    if kind in ("all", "wks"):
        wave = wave_kernel_signature(basis, count=count, scale_invariant=invariant)
        arrays |= {"wks": wave.values, "wks_energies": wave.at}
        facts |= {"wks_energies": wave.at.tolist(), "wks_mean": _mean(basis, wave)}
    return Told(scene, facts, *_saved(options, arrays))


def _mean(basis: FourierBasis, signature: Signature) -> list[float]:
    """Return the mean over the surface; of the heat kernel the trace over the area."""
    masses = np.asarray(basis.mass.sum(axis=1)).ravel()
    means: list[float] = (masses @ signature.values / masses.sum()).tolist()
    return means


def _check_descriptors(options: Options) -> None:
    if "times" in options and options["kind"] not in ("all", "hks"):
        raise BeltramiError("times belong to kind=hks")


def _parameterize(scene: Scene, options: Options) -> Told:
    chosen = {name: value for name, value in options.items() if name != "save"}
    found = parameterize(scene.mesh, **chosen)
    distortion = found.distortion
    facts = {
        "is_bijective": found.is_bijective,
        "n_flipped": len(found.flipped),
        "n_crossings": len(found.certificate.crossings),
        "n_cut_edges": len(found.cut_edges),
        "conformal": distortion.mean_conformal,
        "area": distortion.mean_area,
        "symmetric_dirichlet": distortion.symmetric_dirichlet,
    }
    arrays = {"uv": found.uv, "faces": found.mesh.faces, "vertex_map": found.vertex_map}
    return Told(scene, facts, *_saved(options, arrays))


_EXTREMES: Final = ("smallest", "median", "largest", "integral")

VERBS_OF_FUNCTIONS: Final = table(
    integrate=Verb(
        _integrate,
        {"area": "number", "volume": "number", "centroid": "numbers"},
        {
            "how": Choice(PLACES, "vertex"),
            "areas": Choice((*AREA_KINDS, *EDGE_AREA_KINDS)),
        },
        of_integrals,
        check=_check_integrate,
    ),
    curvature=Verb(
        _curvature,
        {"total": "number", "gauss_bonnet": "number"}
        | {f"{name}_{what}": "number" for name in ("gaussian", "mean") for what in _EXTREMES},
        _SAVE,
        of_curvature,
    ),
    laplacian=Verb(
        _laplacian,
        {"n_entries": "whole", "n_negative_weights": "whole"}
        | dict.fromkeys(("smallest_weight", "largest_weight", "mass", "spectral_bound"), "number"),
        {**_PAIR, **_SAVE},
        of_pair,
        gives="pair",
    ),
    spectrum=Verb(
        _spectrum,
        {"eigenvalues": "numbers", "largest_residual": "number"},
        {
            "k": Whole(100, least=1),
            "near": Number(0.0),
            "tolerance": Number(1e-6, open=True),
            "certify": Flag(),
            "hold_boundary": Flag(),
            **_PAIR,
            **_SAVE,
        },
        of_spectrum,
        gives="basis",
    ),
    descriptors=Verb(
        _descriptors,
        dict.fromkeys(("shape_dna", "hks_times", "hks_mean"), "numbers")
        | dict.fromkeys(("wks_energies", "wks_mean"), "numbers"),
        {
            "kind": Choice(_KINDS, "all"),
            "count": Whole(100, least=1),
            "times": Numbers(),
            "scale_invariant": Flag(),
            "normalization": Choice(NORMALIZATIONS, "area"),
            **_SAVE,
        },
        of_descriptors,
        needs="basis",
        check=_check_descriptors,
    ),
    parameterize=Verb(
        _parameterize,
        {"is_bijective": "flag"}
        | dict.fromkeys(("n_flipped", "n_crossings", "n_cut_edges"), "whole")
        | dict.fromkeys(("conformal", "area", "symmetric_dirichlet"), "number"),
        {
            "method": Choice(METHODS, "auto"),
            "weights": Choice((*SYMMETRIC_WEIGHTS, "mean_value")),
            "boundary": Choice(("circle", "square"), "circle"),
            "spacing": Choice(SPACINGS, "arclength"),
            "bulge": Number(0.0),
            "seams": Whole(0),
            "cut": Flag(True),
            "strict": Flag(True),
            **_SAVE,
        },
        of_parameterization,
    ),
)
