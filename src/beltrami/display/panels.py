"""From the arguments of render to panels: one mesh, function, caption and camera for each."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from typing import Any, TypeAlias

import numpy as np

from beltrami._arrays import Floats, as_floats
from beltrami.display.camera import Camera
from beltrami.display.colormaps import is_signed
from beltrami.display.framing import fit_camera
from beltrami.display.scene import Panel, check_mesh
from beltrami.display.texture import Texture, make_texture
from beltrami.display.values import as_values, choose_limits, seen_values
from beltrami.errors import DimensionError, EmptyMeshError, MeshError, check_name, shown
from beltrami.mesh.door import require_mesh
from beltrami.mesh.mesh import Mesh

Levels: TypeAlias = str | float | Sequence[float] | None


def paired(
    mesh: Mesh | Sequence[Mesh], f: Any, caption: str | Sequence[str] | None
) -> tuple[list[Mesh], list[Any], list[str]]:
    """Make lists of the same length: meshes, functions (or None) and captions.

    A list or tuple that holds nothing but arrays and None is several functions; anything else is
    one, which all meshes share.

    Raises
    ------
    DimensionError
        If there is not one function and one caption for each panel.

    Examples
    --------
    >>> triangle = Mesh([[0, 0], [2, 0], [0, 2]], [[0, 1, 2]])
    >>> meshes, functions, captions = paired(triangle, [None, np.ones(3)], ["one", "two"])
    >>> len(meshes), captions
    (2, ['one', 'two'])
    """
    given = list(mesh) if isinstance(mesh, list | tuple) else [mesh]
    meshes = [require_mesh(each, "a picture") for each in given]
    if not meshes:
        raise EmptyMeshError("there is no mesh to draw")
    for each in meshes:
        check_mesh(each)
    several = isinstance(f, list | tuple) and len(f) > 0
    several = several and all(x is None or (isinstance(x, np.ndarray) and x.ndim) for x in f)
    functions = list(f) if several else [f] * len(meshes)
    if len(meshes) == 1:
        meshes = meshes * len(functions)
    if caption is None:
        captions = [""] * len(meshes)
    else:
        captions = [caption] if isinstance(caption, str) else list(caption)
    for what, things in (("functions", functions), ("captions", captions)):
        if len(things) != len(meshes):
            raise DimensionError(
                f"{len(things)} {what} for {len(meshes)} panels",
                remedy="Give one for each panel, with None or an empty text where there is none.",
            )
    return meshes, functions, captions


def place_cameras(meshes: list[Mesh], camera: Camera | str | None, **options: Any) -> list[Camera]:
    """Return one camera for each panel: the given one, a common one, or each its own.

    Raises
    ------
    MeshError
        If options of ``fit_camera`` are given beside a camera, which has its own.
    """
    if isinstance(camera, Camera):
        beside = [name for name in ("view", "focus") if options.get(name) is not None]
        beside += [k for k, usual in (("up", "y"), ("zoom", 1.0)) if options.get(k, usual) != usual]
        if beside:
            raise MeshError(
                f"{', '.join(beside)} given beside a camera, which has its own",
                remedy="Give one or the other.",
            )
        return [camera] * len(meshes)
    if camera is not None:
        check_name("camera", camera, ("common",))
        return [fit_camera(meshes, **options)] * len(meshes)
    return [fit_camera(mesh, **options) for mesh in meshes]


def make_panels(
    meshes: list[Mesh],
    functions: list[Any],
    captions: list[str],
    cameras: list[Camera],
    colormap: Any,
    limits: Any,
    level_set: Levels,
    texture: Any = None,
    missing: bool = False,
) -> list[Panel]:
    """Check the functions and textures, and choose colours, limits and level sets."""
    values = [
        None if f is None else as_values(mesh, f, missing)
        for mesh, f in zip(meshes, functions, strict=True)
    ]
    seen = [
        _numbers(seen_values(mesh, v)) if v is not None and v.shape[1] == 1 else None
        for mesh, v in zip(meshes, values, strict=True)
    ]
    if isinstance(limits, str):
        check_name("limits", limits, ("common",))
        every = [s for s in seen if s is not None] or [np.zeros(1)]
        limits, colormap = choose_limits(np.concatenate(every), None, colormap)
    textures = textured(meshes, functions, texture)
    panels = []
    for mesh, v, s, text, camera, picture in zip(
        meshes, values, seen, captions, cameras, textures, strict=True
    ):
        if s is None:
            panels.append(Panel(mesh, camera, v, caption=text, texture=picture))
            continue
        ends, table = choose_limits(s, limits, colormap)
        panels.append(Panel(mesh, camera, v, ends, table, _levels(level_set, s), text))
    return panels


def _numbers(values: Floats) -> Floats:
    return np.asarray(values[~np.isnan(values)])


def textured(meshes: list[Mesh], functions: list[Any], texture: Any) -> list[Texture | None]:
    """Prepare the texture of each panel: a list has one for each, anything else is for all.

    Raises
    ------
    DimensionError
        If there is not one texture for each panel.
    MeshError
        If there is a function and a texture on the same mesh.
    """
    several = isinstance(texture, list | tuple)
    several = several and all(isinstance(x, str | PathLike | np.ndarray | None) for x in texture)
    pictures = list(texture) if several else [texture] * len(meshes)
    if len(pictures) != len(meshes):
        raise DimensionError(
            f"{len(pictures)} textures for {len(meshes)} panels",
            remedy="Give one for each panel, with None where there is none.",
        )
    made: list[Texture | None] = []
    for mesh, f, picture in zip(meshes, functions, pictures, strict=True):
        if picture is not None and f is not None:
            raise MeshError(
                "a function and a texture for the same mesh",
                remedy="Give one of them, or bake the function into the texture.",
            )
        made.append(None if picture is None else make_texture(mesh, picture))
    return made


def _levels(level_set: Levels, f: Floats) -> tuple[float, ...]:
    """Return the levels to draw: zero by default, where f has both signs."""
    if level_set is None:
        return ()
    if isinstance(level_set, str):
        check_name("level set", level_set, ("auto",))
        return (0.0,) if is_signed(f) else ()
    levels = np.atleast_1d(as_floats(level_set))
    if levels.ndim != 1 or not np.isfinite(levels).all():
        raise MeshError(f"the level sets {shown(level_set)} are not finite numbers")
    return tuple(levels.tolist())
