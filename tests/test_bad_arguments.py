"""Numbers and arrays that are no good, to all that takes one: a ``BeltramiError``, or a result.

Numbers go from 1e-100 to 1e100. What is no number, or no array, is in ``test_wrong_kinds``.
"""

import re
import warnings

import numpy as np
import pytest

import beltrami as bt
from beltrami.errors import BeltramiError
from public_results import arrays_of
from public_scene import Scene

NUMBERS = {
    "NaN": float("nan"), "inf": float("inf"), "-inf": -float("inf"), "-1": -1, "0": 0,
    "0.5": 0.5, "huge": 1e100, "tiny": 1e-100, "long": 10**30, "numpy": np.float32(np.nan),
}  # fmt: skip
NOT_A_NUMBER = re.compile(r"(volume_change|relative|\.rate|predicted_rate)$")  # as documented
H = bt.kernels.Heat(1.0)
WITH_NUMBERS = {
    "repair tolerance": lambda s, v: bt.repair(s.mesh, merge_duplicate_vertices=True, tolerance=v),
    "compress max_error": lambda s, v: bt.compress(s.mesh, max_error=v),
    "compress bits": lambda s, v: bt.compress(s.mesh, bits=v),
    "decompress max_vertices": lambda s, v: bt.decompress(s.compressed, max_vertices=v),
    "ring i": lambda s, v: s.mesh.ring(v),
    "ring s": lambda s, v: s.mesh.ring(0, v),
    "face_ring": lambda s, v: s.mesh.face_ring(v),
    "knn_graph k": lambda s, v: bt.knn_graph(s.mesh.vertices, v),
    "knn_graph scale": lambda s, v: bt.knn_graph(s.mesh.vertices, 3, "gaussian", scale=v),
    "PointCloud": lambda s, v: bt.PointCloud(s.mesh.vertices, v),
    "conjugate_gradients tolerance": lambda s, v: bt.conjugate_gradients(
        s.matrix, s.f, tolerance=v, most_iterations=50
    ),
    "conjugate_gradients iterations": lambda s, v: bt.conjugate_gradients(
        s.matrix, s.f, most_iterations=v
    ),
    "minres tolerance": lambda s, v: bt.minres(s.matrix, s.f, tolerance=v, most_iterations=50),
    "fourier_basis k": lambda s, v: bt.fourier_basis(s.pair, v),
    "fourier_basis near": lambda s, v: bt.fourier_basis(s.pair, 3, near=v),
    "fourier_basis tol": lambda s, v: bt.fourier_basis(s.pair, 3, tol=v),
    "fourier_basis seed": lambda s, v: bt.fourier_basis(s.pair, 3, seed=v),
    "truncate": lambda s, v: s.basis.truncate(s.f, v),
    "basis filter rest": lambda s, v: s.basis.filter(s.f, H, rest=v),
    "filter tolerance": lambda s, v: bt.filter(s.pair, s.f, H, tolerance=v),
    "filter order": lambda s, v: bt.filter(s.pair, s.f, H, order=v),
    "inverse_iteration shift": lambda s, v: bt.inverse_iteration(s.pair, v),
    "inverse_iteration tolerance": lambda s, v: bt.inverse_iteration(s.pair, 1.0, tolerance=v),
    "inverse_iteration max": lambda s, v: bt.inverse_iteration(s.pair, 1.0, max_iterations=v),
    "heat signature count": lambda s, v: bt.heat_kernel_signature(s.basis, count=v),
    "heat signature time": lambda s, v: bt.heat_kernel_signature(s.basis, [v]),
    "heat signature tolerance": lambda s, v: bt.heat_kernel_signature(s.basis, tolerance=v),
    "wave signature count": lambda s, v: bt.wave_kernel_signature(s.basis, count=v),
    "wave signature energy": lambda s, v: bt.wave_kernel_signature(s.basis, [v]),
    "wave signature sigma": lambda s, v: bt.wave_kernel_signature(s.basis, sigma=v),
    "shape_dna tolerance": lambda s, v: bt.shape_dna(s.basis, tolerance=v),
    "spectral_distance time": lambda s, v: bt.spectral_distance(s.basis, [0], "diffusion", time=v),
    "spectral_distance source": lambda s, v: bt.spectral_distance(s.basis, [v]),
    "segment": lambda s, v: bt.segment(s.basis, v),
    "nodal_domains zero": lambda s, v: bt.nodal_domains(s.mesh, s.f, zero=v),
    "functional_map k": lambda s, v: bt.functional_map(s.basis, s.basis, s.fields, s.fields, k=v),
    "functional_map commutativity": lambda s, v: bt.functional_map(
        s.basis, s.basis, s.fields, s.fields, commutativity=v
    ),
    "zoomout k": lambda s, v: bt.zoomout(s.same, v),
    "zoomout step": lambda s, v: bt.zoomout(s.same, step=v),
    "zoomout samples": lambda s, v: bt.zoomout(s.same, samples=v),
    "meyer_frame bound": lambda s, v: bt.meyer_frame(v),
    "meyer_frame scales": lambda s, v: bt.meyer_frame(1.0, v),
    "mexican_hat_frame bound": lambda s, v: bt.mexican_hat_frame(v),
    "kernels.Heat": lambda s, v: bt.kernels.Heat(v)(s.basis.eigenvalues),
    "kernels.LowPass": lambda s, v: bt.kernels.LowPass(1.0, v)(s.basis.eigenvalues),
    "kernels.BandPass": lambda s, v: bt.kernels.BandPass(v, 2.0)(s.basis.eigenvalues),
    "smooth steps": lambda s, v: bt.smooth(s.graph, s.f, v) if abs(v) < 1e6 else None,
    "smooth step": lambda s, v: bt.smooth(s.graph, s.f, 2, v),
    "smooth_mesh steps": lambda s, v: bt.smooth_mesh(s.mesh, steps=v) if not v > 1e6 else None,
    "smooth_mesh pass_band": lambda s, v: bt.smooth_mesh(
        s.mesh, "taubin", steps=2, pass_band=v, weights="combinatorial"
    ),
    "smooth_mesh time": lambda s, v: bt.smooth_mesh(s.mesh, "implicit", time=v, steps=1),
    "smooth_mesh features": lambda s, v: bt.smooth_mesh(
        s.mesh, steps=2, features=v, weights="combinatorial"
    ),
    "smooth_mesh contrast": lambda s, v: bt.smooth_mesh(
        s.mesh, "bilateral_normals", steps=2, contrast=v
    ),
    "smooth_mesh fidelity": lambda s, v: bt.smooth_mesh(s.mesh, "tv_normals", steps=2, fidelity=v),
    "denoise noise": lambda s, v: bt.denoise(s.mesh, noise=v),
    "denoise_function noise": lambda s, v: bt.denoise_function(s.pair, s.f, v),
    "heat time": lambda s, v: bt.heat(s.pair, s.f, v),
    "heat exact": lambda s, v: bt.heat(s.pair, s.f, v, "exact"),
    "heat steps": lambda s, v: bt.heat(s.pair, s.f, 0.1, steps=v) if abs(v) < 1e6 else None,
    "wave time": lambda s, v: list(bt.wave(s.pair, s.f, None, [v], "spectral", basis=s.basis)),
    "wave step": lambda s, v: list(bt.wave(s.pair, s.f, None, [0.1], "implicit", step=v)),
    "poisson screen": lambda s, v: bt.poisson(s.pair, s.f, screen=v),
    "poisson value": lambda s, v: bt.poisson(s.pair, s.f, hold=[0], values=v),
    "regularize": lambda s, v: bt.regularize(s.pair, s.f, v),
    "interpolate value": lambda s, v: bt.interpolate(s.pair, [0], [v]),
    "interpolate order": lambda s, v: bt.interpolate(s.pair, [0], [1.0], v),
    "gaussian_bumps width": lambda s, v: bt.gaussian_bumps(s.mesh, [0], v),
    "gaussian_bumps height": lambda s, v: bt.gaussian_bumps(s.mesh, [0], 0.5, v),
    "geodesic_distance time": lambda s, v: bt.geodesic_distance(s.mesh, [0], time=v),
    "geodesic_distance source": lambda s, v: bt.geodesic_distance(s.mesh, [v]),
    "parameterize bulge": lambda s, v: bt.parameterize(s.mesh, boundary="square", bulge=v),
    "parameterize seams": lambda s, v: bt.parameterize(s.mesh, seams=v) if not v > 99 else None,
    "Grid": lambda s, v: bt.Grid((v, 3)) if not v > 1e6 else None,
    "Grid spacing": lambda s, v: bt.laplacian(bt.Grid((3, 3), spacing=v), "distance"),
    "fourier_modes": lambda s, v: s.grid.fourier_modes(v),
    "Rectangle": lambda s, v: bt.Rectangle((0, v), (0, 1)).samples(3),
    "Disk": lambda s, v: bt.Disk(v).samples(3),
    "first_fundamental_form": lambda s, v: s.surface.first_fundamental_form(v, 0.1),
    "surface mesh": lambda s, v: s.surface.mesh(v, 4) if not v > 1e6 else None,
    "exponential_map": lambda s, v: bt.exponential_map(s.surface, 0.1, 0.2, v, 0.1, steps=4),
    "ball_average radius": lambda s, v: bt.ball_average_laplacian(
        s.surface, lambda x, y, z: x, 0.1, 0.2, v, directions=4, steps=4
    ),
    "SpotLight": lambda s, v: bt.SpotLight((v, 0, 0)),
    "render zoom": lambda s, v: bt.render(s.mesh, size=(16, 16), antialias=1, zoom=v),
    "render size": lambda s, v: bt.render(s.mesh, size=(v, 16), antialias=1) if v < 99 else None,
    "render ambient": lambda s, v: bt.render(s.mesh, size=(16, 16), antialias=1, ambient=v),
    "render line_width": lambda s, v: bt.render(
        s.mesh, size=(16, 16), antialias=1, wireframe=True, line_width=v
    ),
    "render limits": lambda s, v: bt.render(
        s.mesh, s.f, size=(16, 16), antialias=1, limits=(0.0, v)
    ),
    "icosphere": lambda s, v: bt.shapes.icosphere(v) if not v > 5 else None,
    "icosphere radius": lambda s, v: bt.shapes.icosphere(1, v),
    "torus": lambda s, v: bt.shapes.torus(v, 3) if not v > 1e4 else None,
    "torus minor": lambda s, v: bt.shapes.torus(4, 3, minor=v),
    "learning_operators": lambda s, v: bt.learning_operators(s.mesh, v),
}
ARRAYS = {
    "of strings": np.array(["a", "b"]),
    "strings": ["a", "b"],
    "ragged": [[1.0], [1.0, 2.0]],
    "complex": np.ones(37) * 1j,
    "objects": np.array([None, 1], object),
    "None inside": [None, 1.0],
    "too short": np.ones(3),
    "empty": [],
    "NaN": np.full(37, np.nan),
    "infinite": np.full(37, np.inf),
    "one number": 3.0,
    "three axes": np.ones((37, 2, 2)),
    "huge": np.full(37, 1e100),
    "a mapping": {"a": 1},
}
WITH_ARRAYS = {
    "Mesh vertices": lambda s, a: bt.Mesh(a, s.mesh.faces),
    "Mesh faces": lambda s, a: bt.Mesh(s.mesh.vertices, a),
    "Mesh corner_uv": lambda s, a: bt.Mesh(s.mesh.vertices, s.mesh.faces, corner_uv=a),
    "with_data": lambda s, a: s.mesh.with_data(f=a),
    "with_vertices": lambda s, a: s.mesh.with_vertices(a),
    "Topology": lambda s, a: bt.Topology(a, 9),
    "as_mesh": lambda s, a: bt.as_mesh((a, s.mesh.faces)),
    "laplacian": lambda s, a: bt.laplacian(a),
    "apply": lambda s, a: s.pair.apply(a),
    "inner": lambda s, a: s.pair.inner(s.f, a),
    "mean": lambda s, a: s.pair.mean(a),
    "integrate": lambda s, a: bt.integrate(s.mesh, a),
    "dirichlet_energy": lambda s, a: bt.dirichlet_energy(s.mesh, a),
    "edge_derivative": lambda s, a: bt.edge_derivative(s.mesh, a),
    "project": lambda s, a: bt.project(s.pair, s.f, a),
    "is_local": lambda s, a: bt.is_local(a, s.mesh),
    "knn_graph": lambda s, a: bt.knn_graph(a, 2),
    "PointCloud": lambda s, a: bt.PointCloud(a, 2),
    "factorize": lambda s, a: bt.factorize(a),
    "solve": lambda s, a: s.factor.solve(a),
    "conjugate_gradients": lambda s, a: bt.conjugate_gradients(s.matrix, a),
    "conjugate_gradients matrix": lambda s, a: bt.conjugate_gradients(a, s.f),
    "conjugate_gradients start": lambda s, a: bt.conjugate_gradients(s.matrix, s.f, start=a),
    "conjugate_gradients kernel": lambda s, a: bt.conjugate_gradients(s.matrix, s.f, kernel=a),
    "minres": lambda s, a: bt.minres(s.matrix, a),
    "fourier_basis hold": lambda s, a: bt.fourier_basis(s.pair, 2, hold=a),
    "forward": lambda s, a: s.basis.forward(a),
    "inverse": lambda s, a: s.basis.inverse(a),
    "basis filter": lambda s, a: s.basis.filter(s.f, a),
    "filter f": lambda s, a: bt.filter(s.pair, a, H),
    "filter h": lambda s, a: bt.filter(s.pair, s.f, lambda x: a),
    "inverse_iteration start": lambda s, a: bt.inverse_iteration(s.pair, 1.0, a),
    "heat signature": lambda s, a: bt.heat_kernel_signature(s.basis, a),
    "wave signature": lambda s, a: bt.wave_kernel_signature(s.basis, a),
    "spectral_distance": lambda s, a: bt.spectral_distance(s.basis, a),
    "segment edges": lambda s, a: bt.segment(s.basis, 2, edges=a),
    "nodal_domains": lambda s, a: bt.nodal_domains(s.mesh, a),
    "functional_map": lambda s, a: bt.functional_map(s.basis, s.basis, a, a),
    "functional_map landmarks": lambda s, a: bt.functional_map(s.basis, s.basis, landmarks=a),
    "functional_map_from_points": lambda s, a: bt.functional_map_from_points(s.basis, s.basis, a),
    "transfer": lambda s, a: s.same.transfer(a),
    "kernel": lambda s, a: bt.kernels.Heat(1.0)(a),
    "smooth_step": lambda s, a: bt.kernels.smooth_step(a),
    "power": lambda s, a: s.frame.power(a),
    "analyze": lambda s, a: s.frame.analyze(s.pair, a),
    "synthesize": lambda s, a: s.frame.synthesize(s.pair, a),
    "smooth": lambda s, a: bt.smooth(s.graph, a, 2),
    "smooth hold": lambda s, a: bt.smooth(s.graph, s.f, 2, hold=a),
    "smooth_mesh hold": lambda s, a: bt.smooth_mesh(s.mesh, steps=1, hold=a),
    "denoise_function": lambda s, a: bt.denoise_function(s.pair, a),
    "heat": lambda s, a: bt.heat(s.pair, a, 0.1),
    "heat source": lambda s, a: bt.heat(s.pair, s.f, 0.1, source=a),
    "wave": lambda s, a: list(bt.wave(s.pair, s.f, a, [0.1])),
    "wave times": lambda s, a: next(bt.wave(s.pair, s.f, None, a, "spectral", basis=s.basis), 0),
    "poisson": lambda s, a: bt.poisson(s.pair, a, project=True),
    "poisson values": lambda s, a: bt.poisson(s.pair, s.f, hold=[0, 1], values=a),
    "regularize weights": lambda s, a: bt.regularize(s.pair, s.f, 1.0, weights=a),
    "interpolate": lambda s, a: bt.interpolate(s.pair, [0, 1], a),
    "interpolate vertices": lambda s, a: bt.interpolate(s.pair, a, s.f[:2]),
    "gaussian_bumps": lambda s, a: bt.gaussian_bumps(s.mesh, a, 1.0),
    "gaussian_bumps heights": lambda s, a: bt.gaussian_bumps(s.mesh, [0, 1], 1.0, a),
    "geodesic_distance": lambda s, a: bt.geodesic_distance(s.mesh, a),
    "harmonic": lambda s, a: bt.harmonic(s.mesh, [0, 1], a),
    "parameterize corners": lambda s, a: bt.parameterize(s.mesh, boundary="square", corners=a),
    "parameterize boundary": lambda s, a: bt.parameterize(s.mesh, boundary=a),
    "certify": lambda s, a: bt.certify(s.mesh, a),
    "distortion": lambda s, a: bt.distortion(s.mesh, a),
    "image": lambda s, a: s.map.image(a, [[0.2, 0.3, 0.5]]),
    "image barycentric": lambda s, a: s.map.image([0], a),
    "original": lambda s, a: s.map.original(a),
    "write_mesh uv": lambda s, a: bt.write_mesh(s.path("a.obj"), s.mesh, a),
    "render f": lambda s, a: bt.render(s.mesh, a, size=(16, 16), antialias=1),
    "render view": lambda s, a: bt.render(s.mesh, size=(16, 16), antialias=1, view=a),
    "DirectionalLight": lambda s, a: bt.DirectionalLight(a),
    "dft": lambda s, a: bt.dft(a),
    "convolve": lambda s, a: bt.convolve(s.f, a),
    "Grid.kernel": lambda s, a: s.grid.kernel(a),
    "averaging_limit": lambda s, a: s.grid.averaging_limit(a),
    "surface": lambda s, a: s.surface.jacobian(a, 0.1),
    "locate": lambda s, a: s.atlas.locate(a),
    "decompress": lambda s, a: bt.decompress(np.ones(9, np.uint8).tobytes()),
}


@pytest.fixture(scope="module")
def scene():
    disk = bt.shapes.disk(3, dimension=3)
    made = Scene(bt.Mesh(disk.vertices + 0.0, disk.faces))
    made.graph = bt.laplacian(made.mesh.topology)
    return made


def wrong(call, scene, value):
    """What is wrong with the answer, if anything is: NaN out of numbers, or another exception."""
    try:
        array = np.asarray(value)
        finite = array.dtype.kind in "biuf" and np.isfinite(array).all()
    except ValueError:  # ragged
        finite = False
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            for path, array in arrays_of(call(scene, value)):
                nan = array.dtype.kind in "fc" and np.isnan(array).any()
                if nan and finite and not NOT_A_NUMBER.search(path):
                    return f"NaN in {path or 'the result'}"
        except BeltramiError as error:
            return "" if "\n" not in str(error) else f"two lines: {error}"
        except Exception as error:  # noqa: BLE001 - whatever it is, it is told
            return f"{type(error).__name__}: {error}"
    return ""


@pytest.mark.parametrize("name", WITH_NUMBERS)
def test_numbers(scene, name):
    found = {label: wrong(WITH_NUMBERS[name], scene, v) for label, v in NUMBERS.items()}
    assert {label: text for label, text in found.items() if text} == {}


@pytest.mark.parametrize("name", WITH_ARRAYS)
def test_arrays(scene, name):
    found = {label: wrong(WITH_ARRAYS[name], scene, a) for label, a in ARRAYS.items()}
    assert {label: text for label, text in found.items() if text} == {}
