"""Verbs that judge, change or write a mesh."""

from __future__ import annotations

from typing import Any, Final

from beltrami.batch.memory import (
    of_compression,
    of_denoising,
    of_diagnosis,
    of_repair,
    of_smoothing,
    of_writing,
)
from beltrami.batch.parameters import Choice, Flag, Number, Whole
from beltrami.batch.verb import Options, Scene, Told, Verb, table
from beltrami.compression.choosing import MODES
from beltrami.compression.compress import compress
from beltrami.compression.contents import describe
from beltrami.compression.grid import MOST_BITS
from beltrami.compression.numbers import EFFORTS
from beltrami.diffusion.denoise import DENOISING_METHODS, denoise
from beltrami.diffusion.smooth_mesh import KEPT, smooth_mesh
from beltrami.diffusion.smoothing_methods import SMOOTHING_METHODS
from beltrami.errors import BeltramiError
from beltrami.io.registry import WRITERS, write_mesh
from beltrami.mesh.diagnose import diagnose
from beltrami.mesh.repair import repair
from beltrami.operators.pair import INTRINSIC, MASSES, TUFTED
from beltrami.operators.weights import SYMMETRIC_WEIGHTS

WEIGHTS: Final = (*SYMMETRIC_WEIGHTS, INTRINSIC, TUFTED)
_REPAIRS: Final = (
    "remove_non_finite",
    "merge_duplicate_vertices",
    "remove_degenerate_faces",
    "remove_duplicate_faces",
    "split_non_manifold",
    "orient",
    "remove_unreferenced",
)
_COUNTS: Final = ("n_vertices", "n_faces", "n_edges", "n_components", "n_boundary_loops")
_TOPOLOGY: Final = ("euler_characteristic", "genus")
_TRUTHS: Final = ("is_clean", "is_closed", "is_manifold", "is_oriented", "is_orientable")
_DEFECTS: Final = (
    "non_finite_vertices",
    "unreferenced_vertices",
    "duplicate_vertices",
    "non_manifold_vertices",
    "degenerate_faces",
    "duplicate_faces",
    "non_manifold_edges",
    "inconsistent_edges",
    "boundary_edges",
)


def _diagnose(scene: Scene, _options: Options) -> Told:
    found = diagnose(scene.mesh)
    names = (*_COUNTS, *_TOPOLOGY, *_TRUTHS, "area", "volume")
    facts: dict[str, Any] = {name: getattr(found, name) for name in names}
    return Told(scene, facts | {f"n_{name}": len(getattr(found, name)) for name in _DEFECTS})


def _repair(scene: Scene, options: Options) -> Told:
    named = any(options.get(name) for name in (*_REPAIRS, "keep_largest_component"))
    asked = {name: options.get(name, not named) for name in _REPAIRS}
    largest = options.get("keep_largest_component", False)
    fixed = repair(
        scene.mesh, tolerance=options["tolerance"], keep_largest_component=largest, **asked
    )
    facts = {
        "done": "; ".join(fixed.done),
        "n_vertices": fixed.mesh.n_vertices,
        "n_faces": fixed.mesh.n_faces,
    }
    return Told(Scene(fixed.mesh), facts)


def _check_repair(options: Options) -> None:
    named = any(options.get(name) for name in (*_REPAIRS, "keep_largest_component"))
    if options["tolerance"] > 0 and not options.get("merge_duplicate_vertices", not named):
        raise BeltramiError("tolerance goes with merge_duplicate_vertices=true")


def _smooth(scene: Scene, options: Options) -> Told:
    return Told(Scene(smooth_mesh(scene.mesh, **options)))


def _check_smooth(options: Options) -> None:
    method = options["method"]
    allowed = SMOOTHING_METHODS[method].options
    extra = sorted(set(options) - {*allowed, "method", "hold_boundary", "keep"})
    if extra:
        raise BeltramiError(f"the method {method!r} has no {extra[0]}; it has {', '.join(allowed)}")
    if "time" in allowed and "time" not in options:
        raise BeltramiError(f"the method {method!r} needs a time")
    if options["hold_boundary"] and "keep" in options:
        raise BeltramiError(f"keeping the {options['keep']} would move the boundary that is held")


def _denoise(scene: Scene, options: Options) -> Told:
    found = denoise(scene.mesh, **options)
    facts = {
        "sigma": found.sigma,
        "predicted_error": found.predicted_error,
        "volume_change": found.volume_change,
        "warnings": "; ".join(found.warnings),
    }
    return Told(Scene(found.mesh), facts)


def _compress(scene: Scene, options: Options) -> Told:
    mesh = scene.mesh
    data = compress(mesh, **options)
    facts = {
        "bytes": len(data),
        "bits_per_vertex": 8 * len(data) / max(mesh.n_vertices, 1),
        "max_error": describe(data).max_error,
    }
    return Told(scene, facts, ".btm", lambda path: path.write_bytes(data))


def _check_compress(options: Options) -> None:
    if "bits" in options and "max_error" in options:
        raise BeltramiError("max_error and bits say the same thing: give one of them")


def _write(scene: Scene, options: Options) -> Told:
    facts = {"n_vertices": scene.mesh.n_vertices, "n_faces": scene.mesh.n_faces}
    return Told(scene, facts, f".{options['format']}", lambda path: write_mesh(path, scene.mesh))


def _columns(kind: str, *names: str) -> dict[str, str]:
    return dict.fromkeys(names, kind)


VERBS_OF_MESHES: Final = table(
    diagnose=Verb(
        _diagnose,
        _columns("whole", *_COUNTS, *_TOPOLOGY)
        | _columns("flag", *_TRUTHS)
        | _columns("number", "area", "volume")
        | _columns("whole", *(f"n_{name}" for name in _DEFECTS)),
        {},
        of_diagnosis,
    ),
    repair=Verb(
        _repair,
        {"done": "text", "n_vertices": "whole", "n_faces": "whole"},
        {name: Flag(None) for name in (*_REPAIRS, "keep_largest_component")}
        | {"tolerance": Number(0.0, most=0.1)},
        of_repair,
        changes=True,
        check=_check_repair,
    ),
    smooth=Verb(
        _smooth,
        {},
        {
            "method": Choice(tuple(SMOOTHING_METHODS), "averaging"),
            "steps": Whole(),
            "step": Number(),
            "pass_band": Number(),
            "time": Number(),
            "weights": Choice(WEIGHTS),
            "mass": Choice(MASSES),
            "features": Number(),
            "contrast": Number(),
            "fidelity": Number(open=True),
            "hold_boundary": Flag(),
            "keep": Choice(KEPT),
        },
        of_smoothing,
        changes=True,
        check=_check_smooth,
    ),
    denoise=Verb(
        _denoise,
        _columns("number", "sigma", "predicted_error", "volume_change") | {"warnings": "text"},
        {"method": Choice(DENOISING_METHODS, "auto"), "noise": Number()},
        of_denoising,
        changes=True,
    ),
    compress=Verb(
        _compress,
        {"bytes": "whole", "bits_per_vertex": "number", "max_error": "number"},
        {
            "max_error": Number(open=True),
            "bits": Whole(least=1, most=MOST_BITS),
            "mode": Choice(MODES, "auto"),
            "effort": Choice(EFFORTS, "best"),
            "keep_order": Flag(),
        },
        of_compression,
        check=_check_compress,
    ),
    write=Verb(
        _write,
        {"n_vertices": "whole", "n_faces": "whole"},
        {"format": Choice(tuple(suffix.lstrip(".") for suffix in WRITERS), "ply")},
        of_writing,
    ),
)
