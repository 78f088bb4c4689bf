"""page: a mesh in one HTML file that computes, for any browser and without a network."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from beltrami._arrays import Floats, as_function, whole
from beltrami._kinds import checked
from beltrami._progress import Progress
from beltrami.display.page_bundle import page_html
from beltrami.display.page_contents import Wanted, page_contents
from beltrami.display.page_maps import own_coordinates
from beltrami.display.page_picture import page_picture
from beltrami.display.texture import is_pattern
from beltrami.errors import BeltramiError, DimensionError, MeshError, check_name, shown
from beltrami.io.atomic import replacing
from beltrami.io.picture import Picture
from beltrami.mesh.door import require_mesh
from beltrami.mesh.geometry import in_space
from beltrami.mesh.mesh import Mesh
from beltrami.operators.soundness import refuse_unreferenced, require_sound
from beltrami.operators.weights import SYMMETRIC_WEIGHTS

SUFFIXES = (".html", ".htm")
LAPLACIANS = ("cotangent", "combinatorial", "distance")
_AXES = ("x", "y", "z")
_WEIGHTS = (*SYMMETRIC_WEIGHTS, "intrinsic_delaunay", "tufted")
_SEED = 2
_MOST_MODES = 1024  # layers and weights that every graphics card has room for
_LEAST, _LARGEST = 1e-15, 1e15  # mean edges, and functions: their squares are single floats


@dataclass(frozen=True)
class Page:
    """A page that was written.

    Attributes
    ----------
    path
        The file.
    size
        Its bytes.
    notes
        What is not in it, and why.
    """

    path: Path
    size: int
    notes: tuple[str, ...]


@checked
def page(
    mesh: Mesh,
    path: str | os.PathLike[str],
    f: ArrayLike | Mapping[str, ArrayLike] | None = None,
    *,
    title: str = "",
    modes: int = 64,
    laplacians: tuple[str, ...] = LAPLACIANS,
    plane: bool = True,
    noise: float = 0.2,
    up: str = "y",
    unit: str = "",
    texture: Picture | None = None,
    progress: Progress | None = None,
) -> Page:
    r"""Write one HTML file in which the mesh can be turned and its functions computed.

    The eigenpairs travel in the file, and the page sums :math:`\sum_i h(\lambda_i) \hat f_i
    \varphi_i` on the graphics card (WebGL2, also in software): eigenfunctions and their zeros,
    heat and waves from a point that is clicked, the shape of the first M terms, filters drawn by
    hand, smoothing and exaggerating, the quadratic regulariser; besides a map to the plane with
    its distortion and a texture, and the mesh beside a noisy and a denoised copy. Nothing is
    loaded from anywhere: the policy of the page forbids it. The address ``page.html#heat`` opens
    that panel; in the console of the browser ``beltrami.values()`` and ``beltrami.positions()`` are
    the numbers behind the picture, in the order ``beltrami.app.data.numbers`` of the vertices.

    Chapter items: F3.1, F3.7.

    Parameters
    ----------
    mesh
        In the plane or in space; what ``laplacian`` accepts.
    path
        File to write, ``.html``, as a whole or not at all.
    f
        A function on the vertices, or several by name; two of our own are there besides.
    title
        What the page is called; the name of the file by default.
    modes
        Eigenpairs of each Laplacian, up to 1024; all, if there are fewer.
    laplacians
        Weights, at least one, each with its default mass.
    plane
        Whether to map the mesh to the plane (``parameterize``).
    noise
        Standard deviation of the noise of the comparison, in mean edge lengths; 0 for none.
    up
        The axis that is vertical at first.
    unit
        The unit of length, for the axes: ``"mm"``.
    texture
        A picture on the mesh, which the page then opens with: a file, or an array (h, w, 3) or
        (h, w), as in ``render``. It lies where ``corner_uv`` says, and once over the map to the
        plane, on faces without ``corner_uv`` not at all. ``"checkerboard"`` for squares alone.
    progress
        Called with (parts done, parts in all).

    Returns
    -------
    Page: its ``notes`` say what is not in the page, and why.

    Raises
    ------
    DimensionError, EmptyMeshError, NonFiniteError, DegenerateFaceError, UnreferencedVertexError
        If the mesh or a function is not what a Laplacian needs, or has more than three dimensions.
    UnknownNameError, MeshError, BeltramiError
        If an option has no such value; if the mean edge or a function is below 1e-15 or above 1e15,
        or an edge or the noise too large for the mean edge; if there is no place for a texture.
    FileFormatError, FileNotFoundError
        If the texture is no picture, or not there.

    Notes
    -----
    Numbers are rounded: eigenvectors to 1/254 of their largest value or finer, such that the shape
    is off by about 1.5 % of the mean edge, functions to 1/508 of their range, positions to 0.5 %
    of the mean edge, texture coordinates to 1/16384 of a picture. A texture takes 200 kB at most:
    what is larger becomes a JPEG, or coarser, and a note says so. Size for 64 modes of three
    Laplacians: less than 3 MB with 35,000 vertices (a test weighs it). Cost: that of the
    eigenpairs, one ``parameterize`` and one ``denoise``, which takes longest.

    Examples
    --------
    >>> import tempfile
    >>> from beltrami.mesh.shapes import icosphere
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     written = page(icosphere(2), Path(folder) / "sphere.html", modes=16, noise=0)
    >>> written.size < 200_000, written.notes
    (True, ('without the comparison of noise: it was not asked for.',))
    """
    file = Path(path)
    check_name("suffix of a page", file.suffix.lower(), SUFFIXES)
    require_sound(require_mesh(mesh, "a page"))
    if not mesh.topology.referenced.all():
        refuse_unreferenced(mesh.topology)
    if mesh.dimension > 3:
        raise DimensionError(
            f"a page shows meshes in the plane or in space, not in R^{mesh.dimension}",
            remedy="Choose three coordinates: Mesh(vertices[:, :3], faces).",
        )
    _require_singles("the mean edge", float(mesh.edge_lengths.mean()))
    if not laplacians:
        raise BeltramiError("a page needs a Laplacian: name one of its weights")
    kinds = tuple(check_name("weights", kind, _WEIGHTS) for kind in laplacians)
    if not 0 <= noise < np.inf:
        raise BeltramiError(f"noise is {shown(noise)}, where a finite number >= 0 is needed")
    axis = check_name("axis", up, _AXES)
    _require_place(mesh, plane, texture)
    wanted = Wanted(
        whole("modes", modes, 1, _MOST_MODES),
        kinds,
        plane,
        float(noise),
        axis,
        str(unit),
        texture is not None,
        None if texture is None or is_pattern(texture) else page_picture(texture),
    )
    functions = _own(mesh, axis) | _given(f, mesh.n_vertices)
    parts = len(kinds) + 4
    done = 0

    def tell() -> None:
        nonlocal done
        done += 1
        if progress is not None:
            progress(done, parts)

    contents = page_contents(mesh, functions, wanted, tell)
    title = str(title) or file.stem
    header = {"title": title, **contents.header}
    text = page_html(title, header, contents.sections.packed()).encode()
    with replacing(file) as out:
        out.write(text)
    tell()
    return Page(file, len(text), contents.notes)


def _require_place(mesh: Mesh, plane: bool, texture: Picture | None) -> None:
    """Refuse a texture if no map is to be in the page."""
    if texture is not None and own_coordinates(mesh) is None and not plane:
        raise MeshError(
            "a texture on a mesh without texture coordinates, in a page without a map",
            remedy="Leave out plane=False, or give a mesh with corner_uv.",
        )


def _own(mesh: Mesh, up: str) -> dict[str, Floats]:
    """Return a smooth function with noise, and one that jumps: what filters are tried on."""
    height = in_space(mesh.vertices, mesh.faces)[0][:, _AXES.index(up)]
    if np.ptp(height) == 0:  # a planar mesh that lies
        height = mesh.vertices[:, 0]
    level = (height - height.min()) / (np.ptp(height) or 1.0)
    noise = np.random.default_rng(_SEED).normal(0.0, 0.15, len(level))
    return {
        "height with noise": level + noise,
        "a step": np.where(level > np.median(level), 1.0, -1.0),
    }


def _given(f: ArrayLike | Mapping[str, ArrayLike] | None, n: int) -> dict[str, Floats]:
    """Return functions by name, each checked: (n,)."""
    named = {} if f is None else f if isinstance(f, Mapping) else {"f": f}
    checked = {}
    for name, values in named.items():
        column = as_function(values, n, f"the function {name!r}")
        if column.size != n:
            raise DimensionError(
                f"the function {name!r} has the shape {column.shape} where ({n},) is needed",
                remedy="Give each column a name.",
            )
        _require_singles(f"the function {name!r}", float(np.abs(column).max()))
        checked[str(name)] = column.reshape(n)
    return checked


def _require_singles(what: str, size: float) -> None:
    """Refuse sizes with which the graphics card cannot compute."""
    if size and not _LEAST <= size <= _LARGEST:
        raise MeshError(
            f"{what} is {size:.3g}, where a page needs {_LEAST:g} to {_LARGEST:g}",
            remedy="Choose another unit.",
        )
