"""Whatever the mesh and its unit: finite numbers, and what holds on every surface."""

import numpy as np
from hypothesis import assume, given, settings
from hypothesis import strategies as st

import strategies
from beltrami.errors import BeltramiError
from beltrami.mesh.mesh import Mesh
from beltrami.operators.laplacian import laplacian
from beltrami.spectrum.distances import SPECTRAL_DISTANCES, spectral_distance
from beltrami.spectrum.fourier_basis import fourier_basis
from beltrami.spectrum.functional_map import functional_map
from beltrami.spectrum.heat_kernel import heat_kernel_signature
from beltrami.spectrum.nodal_domains import nodal_domains
from beltrami.spectrum.null_space import kernel_size
from beltrami.spectrum.segment import segment
from beltrami.spectrum.shape_dna import shape_dna
from beltrami.spectrum.wave_kernel import wave_kernel_signature
from beltrami.spectrum.zoomout import zoomout


@st.composite
def bases(draw):
    """A mesh of 4 to 16 points, sometimes two side by side, in any unit; some of its modes."""
    x, f = draw(strategies.arrays())
    if draw(st.booleans()):
        x, f = np.concatenate([x, x + 10]), np.concatenate([f, f + len(x)])
    unit = 10.0 ** draw(st.sampled_from([0, 0, -12, 12, -40, 40]))
    try:
        mesh = Mesh(x * unit, f)
        pair = laplacian(mesh, draw(st.sampled_from(["cotangent", "combinatorial"])))
    except BeltramiError:  # points in no face
        assume(False)
    basis = fourier_basis(pair, draw(st.integers(2, pair.n)))
    assume(kernel_size(basis) < basis.k)
    return mesh, basis


@settings(max_examples=60)
@given(bases(), strategies.generators())
def test_finite_and_true(drawn, rng):
    mesh, basis = drawn
    n, zeros = basis.n, kernel_size(basis)
    masses = np.asarray(basis.mass.sum(axis=1)).ravel()
    components = len(np.unique(mesh.topology.components())) if basis.k > 2 else zeros
    assert zeros <= 2
    assert zeros == components or basis.k <= 2

    heat = heat_kernel_signature(basis, count=4)
    assert np.isfinite(heat.values).all()
    assert (heat.values > 0).all()
    trace = np.exp(-np.outer(shape_dna(basis, "none"), heat.at)).sum(axis=0)
    np.testing.assert_allclose(masses @ heat.values, trace, rtol=1e-6)
    lasting = heat_kernel_signature(basis, heat.at * 1e6).values * masses.sum()
    assert (lasting > 1 - 1e-6).all()

    levels = np.log(basis.eigenvalues[zeros:])
    if np.ptp(levels) > 1e-6:
        wave = wave_kernel_signature(basis, count=4)
        np.testing.assert_allclose(masses @ wave.values, 1, rtol=1e-6)

    x, y = rng.integers(n, size=2)
    for kind in SPECTRAL_DISTANCES:
        time = 1 / basis.eigenvalues[zeros] if kind == "diffusion" else None
        d, e = (spectral_distance(basis, v, kind, time=time) for v in (x, y))
        assert not np.isnan(d).any()
        assert d[x] == 0
        assert d[y] == e[x] or abs(d[y] - e[x]) < 1e-9 * d[np.isfinite(d)].max()
        assert (np.isinf(d).any()) == (zeros > 1 and kind != "diffusion")

    parts = segment(basis, int(rng.integers(1, n + 1)), edges=mesh.edges)
    np.testing.assert_allclose(parts.masses.sum(), masses.sum())
    assert set(parts.labels) == set(range(parts.count))
    assert nodal_domains(mesh, basis.eigenvectors[:, -1]).count >= 2 or zeros > 1

    pairs = np.column_stack([np.arange(n)] * 2)
    same = zoomout(functional_map(basis, basis, landmarks=pairs, k=2))
    assert np.isfinite(same.matrix).all()
    assert same.orthogonality < 10
