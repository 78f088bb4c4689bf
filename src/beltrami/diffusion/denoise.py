"""denoise: a mesh without its noise, and without a knob."""

from __future__ import annotations

import math

import numpy as np

from beltrami._arrays import Floats, Integers
from beltrami._kinds import checked
from beltrami._progress import Progress
from beltrami.diffusion.blind import FEW, Blind, blind_choice
from beltrami.diffusion.candidates import SECOND
from beltrami.diffusion.choice import ALONG_NORMALS, AS_IT_IS, apply, named
from beltrami.diffusion.denoised import Denoised, DenoisedPart
from beltrami.diffusion.fairing import faired
from beltrami.diffusion.filling import brought_down
from beltrami.diffusion.patches import components_of, part_of
from beltrami.diffusion.vertex_update import require_agreeing_normals
from beltrami.errors import BeltramiError, check_name
from beltrami.mesh.door import require_mesh
from beltrami.mesh.mesh import Mesh

DENOISING_METHODS = ("auto", "linear")
_SAMPLE = 40_000  # faces on which mixtures are chosen, all parts together
_LEAST_SAMPLE = 8_000  # of one part
_PARTS = 8  # at most, with a choice of their own
_OWN = 1_000  # vertices of a component below which it has no choice of its own
_NO_VOLUME = 1e-12  # of the power 3/2 of the area


@checked
def denoise(
    mesh: Mesh,
    method: str = "auto",
    noise: float | None = None,
    *,
    progress: Progress | None = None,
) -> Denoised:
    r"""Remove the noise of a mesh; how much there is, and how, is found from the mesh.

    The level of the noise is measured along the normals (``noise_level``), again along those of a
    first result, without what is left of the shape there (``level_beside``), and once more, if the
    shape is smooth, by what low passes of many strengths remove alike. Then 95 filters are
    tried: low passes, of which some look less across ridges and creases, bilateral and guided
    filters of the normals, and normals of small total variation, of many strengths; where a
    hundredth of the vertices is on borders, 36 low passes more that average borders along
    themselves. They are mixed with those weights that make Stein's unbiased estimate of the error
    least. The result is filtered once more, by normals, if that lowers the estimate. Then, where
    there are vertices enough to tell, the result is corrected: some of what was removed comes back,
    and some of what is left goes, by weights that depend on the curvature and on the length of the
    edges (``beltrami.diffusion.corrections``). The displacements of low passes are along the
    normals, so that little shrinks or slides; the estimate counts what the other filters move
    sideways as error. Last, faces that are small beside the error that is left are faired, sideways
    too: it would spoil their normals.

    Chapter items: P15, P42, P43, P45.

    Parameters
    ----------
    mesh
        In space, its faces turned alike; open, of several components or not manifold is fine.
    method
        ``"auto"``, or ``"linear"`` for linear filters alone.
    noise
        Standard deviation of the noise along the normals, in the unit of length, if it is known.

    Returns
    -------
    Denoised: the mesh first. If the noise does not look white and Gaussian, or is very strong, or
    strong beside long thin faces, which it folds, ``warnings`` say so, and only low passes are
    used, whose estimate of the error needs no Gaussian. The level of noise that is odd is the root
    mean square, but where it only folds faces; of noise that is not white (``noise_colour``) it is
    that of all frequencies, measured beside the shape of a first result (``colour_beside``), and
    the estimate has its covariance. Spikes, single vertices or pairs that are far off, are told in
    ``spikes``: they are missing data, and the rest is denoised as if it were all, safely if it is
    odd still.

    Raises
    ------
    DimensionError, EmptyMeshError, NonFiniteError, DegenerateFaceError
        If the mesh is not in space, has no faces, or a coordinate or face is not valid.
    NotOrientableError
        If faces that share an edge disagree about the outside.
    BeltramiError
        If ``noise`` is negative.

    Notes
    -----
    On more than 40,000 faces the mixtures are chosen on patches, eight of each component; below 200
    vertices they are of linear filters alone. The divergences in Stein's estimate are measured by
    one or two small random changes of the input, from a fixed seed (Ramani, Blu and Unser 2008),
    so the same mesh gives the same result. These changes are along the normals of what low passes,
    chosen the same way, leave of the mesh, and the level is measured along them once more: along
    normals that have noise of their own, or that have lost the ridges, the estimate would favour
    the filters which agree with them. Where the noise is very strong, this is done twice.

    The mixtures are chosen as if σ were 5 % larger: to take some shape for noise costs little, but
    what is left of the noise spoils the normals; and the chosen mixture fits the noise it was
    chosen on. Where nothing but noise is left to fit, and for the second mixture, it is 15 %. The
    ``predicted_error`` is for σ as it is, and at least σ times the divergence for each vertex, the
    least that a linear filter leaves.
    Filters of normals, the second mixture and the corrections are left out where what they gain may
    be chance, which is more for noise that is not white: there the mixture goes a part of the way
    from low passes that do not look at creases to all of them. The corrections are left out also
    where to fit their 26 weights to the noise may cost more than 6 % of the error, or where nearly
    all filters that were chosen look at normals: faces that those made even would be bent. The
    ``predicted_error`` does not count what they gain.

    Sharp features make outliers of the rough part that the level is measured by, as spikes do.
    Outliers are the shape's if more of their square goes beside a first result than is left: it
    tells on which side of a crease a vertex is (``are_of_shape``). Else spikes are looked for, but
    not with ``noise`` or ``"linear"``, nor upon noise that is not white, nor on less than 200
    vertices (``beltrami.diffusion.spikes``); on so few, outliers are always said. The places of
    spikes are filled, from the vertices around and along the normals of the result; the level is
    that of the others, root mean square, and their noise may be seen not to be white.

    Where few vertices make a shape, its details are as even as noise, white or not. They are told
    by how the mesh bends: to one side, or little where edges are long (``unlike_noise``). Then what
    looks like noise that is not white is shape; in doubt, so are outliers; and the level, if it is
    little (up to 0.12 mean edges) or very strong, is divided by how unlike noise the mesh is. With
    ``noise`` nobody has to guess.

    Components of at least 1000 vertices, the eight largest, have a noise level and mixtures of
    their own; the others are denoised as one, but for those of less than 40, which stay as they are
    unless ``noise`` is given: no estimate can tell the shape of a cube from noise.

    Borders keep their place, since displacements are along the normals; means over neighbours that
    are all on one side would bend the surface there, so some low passes average a border along
    itself. Where several faces meet at an edge, all are neighbours.

    References: Stein 1981; James and Stein 1961; Luisier, Blu and Unser 2007; Zheng et al. 2011;
    Zhang et al. 2015; for spikes, Fleishman, Drori and Cohen-Or 2003.

    Examples
    --------
    >>> from beltrami.mesh.shapes import icosphere
    >>> sphere = icosphere(4)
    >>> noise = np.random.default_rng(0).normal(0, 0.01, sphere.n_vertices)
    >>> noisy = sphere.with_vertices(sphere.vertices * (1 + noise)[:, None])
    >>> clean = denoise(noisy)
    >>> round(clean.sigma, 3)
    0.01
    >>> error = np.linalg.norm(clean.mesh.vertices - sphere.vertices, axis=1)
    >>> bool(np.sqrt((error**2).mean()) < 0.003)
    True
    """
    check_name("method of denoising", method, DENOISING_METHODS)
    if noise is not None and not (math.isfinite(noise) and noise >= 0):
        raise BeltramiError(f"the noise must be finite and >= 0, not {noise}")
    require_agreeing_normals(require_mesh(mesh, "denoise"))
    moved = np.array(mesh.vertices)
    components = components_of(mesh, _OWN, _PARTS, FEW)
    size = max(_SAMPLE // len(components), _LEAST_SAMPLE)
    parts = []
    for i, vertices in enumerate(components):
        part = mesh if len(components) == 1 else part_of(mesh, vertices)
        if part.n_faces:
            found = blind_choice(part, noise, size, linear=method == "linear")
            if progress is not None:
                progress(2 * i + 1, 2 * len(components))
            moved[vertices] = _cleaned(part, found)
            parts.append(_told(vertices, found))
        if progress is not None:
            progress(2 * i + 2, 2 * len(components))
    changed = any(part.sigma or len(part.spikes) for part in parts)
    result = mesh.with_vertices(moved) if changed else mesh
    return Denoised(result, tuple(parts), _volume_change(mesh, result))


def _cleaned(part: Mesh, found: Blind) -> Floats:
    """Apply what was chosen; spikes come down along the normals of the clean mesh, not beside."""
    x = apply(found.mesh, found.bench, found.choice)
    if len(found.spikes):
        spikes = np.zeros(len(x), np.bool_)
        spikes[found.spikes] = True
        x = np.where(spikes[:, None], brought_down(part, spikes, x, x), x)
    return faired(part.with_vertices(x), math.sqrt(found.choice.risk))


def _volume_change(before: Mesh, after: Mesh) -> float:
    """Return it relative to that before; NaN where that is none, or only rounding."""
    if not before.is_closed or abs(before.volume) <= _NO_VOLUME * before.area**1.5:
        return math.nan
    return after.volume / before.volume - 1


def _told(vertices: Integers, found: Blind) -> DenoisedPart:
    choice = found.choice
    return DenoisedPart(
        vertices,
        found.noise,
        choice.sigma,
        named(choice.filters, choice.first),
        named((AS_IT_IS, ALONG_NORMALS, *SECOND), choice.second),
        choice.corrections.size,
        math.sqrt(found.risk),
        vertices[found.spikes],
    )
