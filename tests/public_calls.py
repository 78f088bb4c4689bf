"""How to call everything public: for each name a function of a scene (``public_scene``).

A name is that of ``beltrami.__all__``, ``Class.method`` or ``module.name``. A new public function
needs a row here, and is then called with every kind of mesh by ``test_public_*``.
"""

from __future__ import annotations

import functools
import inspect

import numpy as np

import beltrami as bt
from beltrami.diffusion.heat import HEAT_METHODS
from beltrami.diffusion.regularize import FORMS
from beltrami.diffusion.smoothing_methods import SMOOTHING_METHODS
from beltrami.diffusion.wave import WAVE_METHODS
from beltrami.geodesics.distance import DISTANCE_METHODS
from beltrami.operators.energy import ROUTES
from beltrami.operators.integrals import PLACES
from beltrami.parameterization.parameterize import METHODS


def _written(scene, suffix):
    place = scene.path(f"a{suffix}")
    bt.write_mesh(place, scene.mesh)
    return place


def _saved(scene):
    place = scene.path("basis.npz")
    scene.basis.save(place)
    return place


def _table(scene):
    place = scene.path("f.npy")
    np.save(place, scene.f)
    return place


def _gathered(scene):
    blocks = bt.partition_rows(scene.pair, min(2, scene.n))
    return bt.gather_rows(blocks, [scene.f[block.owned] for block in blocks])


def _batch(scene):
    return bt.run_batch(
        [str(_written(scene, ".ply"))], "repair, integrate", scene.path("x").parent, workers=0
    )


def _heat(scene, how):
    calls = {
        "explicit": {"steps": 9},
        "implicit": {"hold": scene.held, "source": scene.f},
        "spectral": {"basis": scene.basis, "tolerance": 9.0},
        "exact": {},
        "crank_nicolson": {"steps": 3},
    }
    return bt.heat(scene.pair, scene.f, scene.time, how, **calls[how])


def _wave(scene, how):
    g = scene.f if how == "implicit" else None
    return list(bt.wave(scene.pair, scene.f, g, [0, np.sqrt(scene.time)], how))


def _smooth(scene, how):
    calls = {
        "averaging": {"steps": 2},
        "taubin": {"steps": 3, "weights": "combinatorial"},
        "windowed_sinc": {"steps": 5},
        "implicit": {"time": scene.time, "weights": "combinatorial"},
        "explicit": {"time": scene.time, "steps": 20},
        "bilaplacian": {"time": scene.time**2},
        "curvature_flow": {"time": scene.time, "steps": 1, "keep": "centroid"},
        "conformal_flow": {"time": scene.time, "steps": 1},
        "bilateral_normals": {"steps": 2, "hold_boundary": True},
        "guided_normals": {"steps": 1},
        "tv_normals": {},
    }
    return bt.smooth_mesh(scene.mesh, how, **calls[how])


def _poisson(scene, how):
    calls = {
        "project": {"project": True},
        "hold": {"hold": scene.held, "values": scene.f[scene.held]},
        "screen": {"screen": 1 / scene.time},
    }
    return bt.poisson(scene.pair, scene.f, **calls[how])


def _solved(method, scene):
    return method(scene.matrix, scene.f, tolerance=1e-8, most_iterations=500, kernel=None)


def each(name, kinds, call):
    """A row for each kind, since one that is refused would hide the others."""
    return {f"{name} {kind}": functools.partial(_of_kind, call, kind) for kind in kinds}


def _of_kind(call, kind, scene):
    return call(scene, kind)


MESHES = {
    "Mesh": lambda s: bt.Mesh(s.mesh.vertices, s.mesh.faces, {"f": s.f}),
    "Mesh.components": lambda s: [s.mesh.components(), s.mesh.components("edges")],
    "Mesh.face_ring": lambda s: s.mesh.face_ring(0),
    "Mesh.ring": lambda s: [s.mesh.ring(0, 2, kind) for kind in ("exact", "ball", "walk")],
    "Mesh.to": lambda s: s.mesh.to("arrays"),
    "Mesh.weighted_normals": lambda s: [
        s.mesh.weighted_normals(kind) for kind in ("uniform", "area", "angle")
    ],
    "Mesh.with_data": lambda s: s.mesh.with_data(f=s.f),
    "Mesh.with_vertices": lambda s: s.mesh.with_vertices(2 * s.mesh.vertices),
    "Topology": lambda s: bt.Topology(s.mesh.faces, s.n),
    "Topology.components": lambda s: s.mesh.topology.components("edges"),
    "Topology.face_ring": lambda s: s.mesh.topology.face_ring(s.n - 1),
    "Topology.ring": lambda s: s.mesh.topology.ring(0),
    "as_mesh": lambda s: bt.as_mesh((s.mesh.vertices, s.mesh.faces)),
    "diagnose": lambda s: bt.diagnose(s.mesh),
    "Diagnosis": lambda s: bt.diagnose(s.mesh).defects,
    "Diagnosis.report": lambda s: bt.diagnose(s.mesh).report(),
    "Diagnosis.to_dict": lambda s: bt.diagnose(s.mesh).to_dict(),
    "repair": lambda s: bt.repair(
        s.mesh,
        remove_vertices=s.held,
        remove_non_finite=True,
        merge_duplicate_vertices=True,
        remove_degenerate_faces=True,
        remove_duplicate_faces=True,
        split_non_manifold=True,
        orient=True,
        remove_unreferenced=True,
    ),
    **each(
        "Repair",
        ("keep_largest_component", "merge_duplicate_vertices", "split_non_manifold", "orient"),
        lambda s, how: bt.repair(s.mesh, **{how: True}),
    ),
    "cut_to_disk": lambda s: bt.cut_to_disk(s.mesh),
    "Cut": lambda s: bt.cut_to_disk(s.mesh).mesh,
    "colouring": lambda s: bt.colouring(s.mesh),
    **each(
        "read_mesh",
        (".ply", ".obj", ".off", ".stl"),
        lambda s, kind: bt.read_mesh(_written(s, kind)),
    ),
    **each(
        "read_points",
        (".ply", ".obj", ".off"),
        lambda s, kind: bt.read_points(_written(s, kind)),
    ),
    "write_mesh": lambda s: _written(s, ".ply.gz").stat().st_size,
    "read_function": lambda s: bt.read_function(_table(s)),
    "write_function": lambda s: bt.write_function(s.path("g.csv"), s.f, missing=True),
    "compress": lambda s: bt.compress(s.mesh, bits=10),
    "compress data": lambda s: bt.compress(
        s.mesh.with_data(f=s.f), effort="fast", keep_order=True, bits=6
    ),
    "decompress": lambda s: bt.decompress(s.compressed),
    "vertex_order": lambda s: bt.vertex_order(s.mesh),
    "render": lambda s: bt.render(s.mesh, s.f, size=(24, 24), antialias=1, colorbar=False),
    "page": lambda s: bt.page(s.mesh, s.path("a.html"), s.f, modes=2, plane=False).notes,
    "Page": lambda s: bt.page(
        s.mesh, s.path("a.html"), modes=1, laplacians=("combinatorial",), noise=0
    ).path.is_file(),
    "run_batch": _batch,
    "Batch": lambda s: _batch(s).state.done,
    "colorize": lambda s: bt.colorize(s.fields),
    "DirectionalLight": lambda s: bt.render(
        s.mesh, size=(16, 16), antialias=1, light=bt.DirectionalLight((0, 0, 1))
    ),
    "DirectionalLight.towards": lambda s: bt.DirectionalLight((0, 1, 1)).towards(s.mesh.vertices),
    "SpotLight": lambda s: bt.render(
        s.mesh, size=(16, 16), antialias=1, light=bt.SpotLight((0, 0, 9)), wireframe=True
    ),
    "SpotLight.towards": lambda s: bt.SpotLight((0, 1, 1)).towards(s.mesh.vertices),
}
OPERATORS = {
    **each(
        "edge_weights",
        ("combinatorial", "distance", "cotangent", "mean_value", "clamped"),
        lambda s, kind: bt.edge_weights(s.mesh, kind),
    ),
    **each(
        "laplacian",
        ("cotangent", "distance", "clamped", "intrinsic_delaunay", "tufted"),
        lambda s, kind: bt.laplacian(s.mesh, kind),
    ),
    "laplacian of faces": lambda s: bt.laplacian(s.mesh.topology),
    "Laplacian": lambda s: bt.laplacian(s.pair.weights),
    "Laplacian.apply": lambda s: s.pair.apply(s.fields),
    "Laplacian.dirichlet_energy": lambda s: s.pair.dirichlet_energy(s.f),
    "Laplacian.inner": lambda s: s.pair.inner(s.f, 2 * s.f),
    "Laplacian.mean": lambda s: s.pair.mean(s.fields),
    "Laplacian.norm": lambda s: s.pair.norm(s.f),
    "Laplacian.require_non_negative": lambda s: s.pair.require_non_negative("this"),
    "Laplacian.require_semi_definite": lambda s: s.pair.require_semi_definite("this"),
    "Laplacian.spectral_bound": lambda s: s.pair.spectral_bound(),
    "intrinsic_delaunay": lambda s: bt.intrinsic_delaunay(s.mesh),
    "IntrinsicTriangulation": lambda s: bt.laplacian(bt.intrinsic_delaunay(s.mesh, cover=True)),
    **each("vertex_areas", ("voronoi", "barycentric"), lambda s, k: bt.vertex_areas(s.mesh, k)),
    **each("edge_areas", ("circumcenter", "incenter"), lambda s, k: bt.edge_areas(s.mesh, k)),
    "edge_derivative": lambda s: bt.edge_derivative(s.mesh, s.f),
    **each("integrate", PLACES, lambda s, how: bt.integrate(s.mesh, s.fields, how)),
    **each("dirichlet_energy", ROUTES, lambda s, how: bt.dirichlet_energy(s.mesh, s.f, how)),
    "curvature": lambda s: bt.curvature(s.mesh),
    "Curvature": lambda s: bt.curvature(s.mesh).mean,
    "face_gradient": lambda s: bt.face_gradient(s.mesh),
    "face_divergence": lambda s: bt.face_divergence(s.mesh),
    "is_local": lambda s: bt.is_local(s.pair.stiffness, s.mesh),
    **each(
        "knn_graph",
        ("combinatorial", "distance", "gaussian"),
        lambda s, kind: bt.knn_graph(s.mesh.vertices, 2, kind),
    ),
    "PointCloud": lambda s: bt.laplacian(bt.PointCloud(s.mesh.vertices, 3), "gaussian"),
    "PointCloud.make_laplacian": lambda s: bt.PointCloud(s.mesh.vertices, 4).make_laplacian(
        "tufted", None
    ),
    "project": lambda s: bt.project(s.pair, s.f, np.ones(s.n)),
    "factorize": lambda s: s.factor,
    "factorize superlu": lambda s: bt.factorize(s.matrix, backend="superlu"),
    "Factor": lambda s: s.factor.memory,
    "Factor.solve": lambda s: s.factor.solve(s.fields),
    "Factor.backward_error": lambda s: s.factor.backward_error(s.factor.solve(s.f), s.f),
    "conjugate_gradients": lambda s: _solved(bt.conjugate_gradients, s),
    "minres": lambda s: _solved(bt.minres, s),
    "IterativeSolution": lambda s: bt.conjugate_gradients(
        s.pair.stiffness, s.pair.stiffness @ s.f, tolerance=1e-6
    ),
    "partition_rows": lambda s: bt.partition_rows(s.pair, min(2, s.n)),
    "RowBlock": lambda s: bt.partition_rows(s.pair, np.zeros(s.n, int)),
    "gather_rows": _gathered,
    "write_rows": lambda s: len(
        bt.write_rows(s.path("x").parent, bt.partition_rows(s.pair, 1), {"f": s.f})
    ),
    "learning_operators": lambda s: bt.learning_operators(s.mesh, min(4, s.n)),
    "LearningOperators": lambda s: bt.learning_operators(
        s.mesh, min(4, s.n), weights="tufted", cache=s.path("x").parent
    ),
    "LearningOperators.to": None,  # tests/learning, where torch is
}
SPECTRA = {
    "fourier_basis": lambda s: s.basis,
    "fourier_basis held": lambda s: bt.fourier_basis(s.pair, 1, hold=s.held),
    "FourierBasis": lambda s: s.basis.orthogonality,
    "FourierBasis.energy": lambda s: s.basis.energy(s.f),
    "FourierBasis.error_decay": lambda s: s.basis.error_decay(s.fields),
    "FourierBasis.filter": lambda s: s.basis.filter(s.f, bt.kernels.Heat(s.time), rest=0.5),
    "FourierBasis.forward": lambda s: s.basis.forward(s.fields),
    "FourierBasis.inverse": lambda s: s.basis.inverse(s.basis.forward(s.f)),
    "FourierBasis.save": lambda s: _saved(s).is_file(),  # it says how long it took
    "FourierBasis.truncate": lambda s: s.basis.truncate(s.f, 1),
    "load_basis": lambda s: bt.load_basis(_saved(s), s.pair).eigenvectors,
    **each(
        "filter",
        ("chebyshev", "lanczos", "exact"),
        lambda s, how: bt.filter(s.pair, s.fields, bt.kernels.Heat(s.time), how, tolerance=1e-4),
    ),
    "inverse_iteration": lambda s: bt.inverse_iteration(s.pair, 0.1 / s.time),
    "InverseIteration": lambda s: bt.inverse_iteration(s.pair, 0.1 / s.time, s.f).eigenvalue,
    "heat_kernel_signature": lambda s: bt.heat_kernel_signature(s.basis, count=4),
    "wave_kernel_signature": lambda s: bt.wave_kernel_signature(s.basis, count=4),
    "Signature": lambda s: bt.heat_kernel_signature(s.basis, count=3, scale_invariant=True),
    "shape_dna": lambda s: bt.shape_dna(s.basis),
    **each(
        "spectral_distance",
        ("biharmonic", "commute_time"),
        lambda s, kind: bt.spectral_distance(s.basis, s.held, kind),
    ),
    "spectral_distance diffusion": lambda s: bt.spectral_distance(
        s.basis, [0], "diffusion", time=s.time
    ),
    "spectral_embedding": lambda s: bt.spectral_embedding(s.basis),
    "segment": lambda s: bt.segment(s.basis, 2, edges=s.mesh.edges),
    "Segmentation": lambda s: bt.segment(s.basis, 1),
    "nodal_domains": lambda s: bt.nodal_domains(s.mesh, s.f),
    "NodalDomains": lambda s: bt.nodal_domains(s.pair, s.f, "weak"),
    "functional_map": lambda s: bt.functional_map(
        s.basis, s.basis, landmarks=np.column_stack([np.arange(s.n)] * 2)
    ),
    "FunctionalMap": lambda s: bt.functional_map(s.basis, s.basis, s.fields, s.fields),
    "FunctionalMap.backward": lambda s: s.same.backward(),
    "FunctionalMap.transfer": lambda s: s.same.transfer(s.fields),
    "functional_map_from_points": lambda s: s.same,
    "zoomout": lambda s: bt.zoomout(
        bt.functional_map_from_points(s.basis, s.basis, np.arange(s.n), k=1)
    ),
    "mexican_hat_frame": lambda s: bt.mexican_hat_frame(s.pair.spectral_bound(), 2),
    "meyer_frame": lambda s: s.frame,
    "Frame": lambda s: s.frame.bounds,
    "Frame.analyze": lambda s: s.frame.analyze(s.pair, s.f, tolerance=1e-4),
    "Frame.power": lambda s: s.frame.power(s.basis.eigenvalues),
    "Frame.synthesize": lambda s: s.frame.synthesize(
        s.pair, s.frame.analyze(s.pair, s.f, tolerance=1e-4), tolerance=1e-4
    ),
    "plot_spectrum": lambda s: bt.plot_spectrum(s.basis, {"f": s.f}, size=(400, 300)),
    **{
        f"kernels.{kernel.__name__}": lambda s, make=kernel, numbers=numbers: make(*numbers)(
            s.basis.eigenvalues * s.time
        )
        for kernel, numbers in (
            (bt.kernels.Heat, (0.5,)),
            (bt.kernels.Wave, (0.5,)),
            (bt.kernels.WaveImpulse, (0.5,)),
            (bt.kernels.Tikhonov, (0.5,)),
            (bt.kernels.LowPass, (1.0, 0.5)),
            (bt.kernels.HighPass, (1.0,)),
            (bt.kernels.BandPass, (0.5, 1.0)),
        )
    },
    "kernels.Kernel": lambda s: (bt.kernels.Heat(1) * bt.kernels.Wave(1))(s.basis.eigenvalues),
    "kernels.Combined": lambda s: (bt.kernels.Heat(1) + bt.kernels.Wave(1))(np.ones(2)),
    "kernels.smooth_step": lambda s: bt.kernels.smooth_step(s.f),
}
FLOWS = {
    "smooth": lambda s: bt.smooth(s.pair, s.fields, 3, hold=s.held),
    **each("smooth_mesh", SMOOTHING_METHODS, _smooth),
    "denoise": lambda s: bt.denoise(s.mesh),
    "Denoised": lambda s: bt.denoise(s.mesh, noise=0.01),
    "denoise_function": lambda s: bt.denoise_function(s.pair, s.fields),
    "DenoisedFunction": lambda s: bt.denoise_function(s.pair, s.f, 0.1),
    **each("heat", HEAT_METHODS, _heat),
    **each("wave", WAVE_METHODS, _wave),
    **each("poisson", ("project", "hold", "screen"), _poisson),
    **each("regularize", FORMS, lambda s, form: bt.regularize(s.pair, s.fields, s.time, form)),
    **each(
        "interpolate",
        (1, 2),
        lambda s, order: bt.interpolate(s.pair, s.held, s.f[s.held], order),
    ),
    "gaussian_bumps": lambda s: bt.gaussian_bumps(s.mesh, s.held, 0.5),
    **each(
        "geodesic_distance",
        DISTANCE_METHODS,
        lambda s, how: bt.geodesic_distance(s.mesh, [0], method=how),
    ),
    "HeatMethod": lambda s: s.heat_method,
    "HeatMethod.distance": lambda s: s.heat_method.distance(s.held),
    **each("parameterize", METHODS, lambda s, how: bt.parameterize(s.mesh, how)),
    "parameterize square": lambda s: bt.parameterize(s.mesh, boundary="square"),
    "Parameterization": lambda s: s.map.textured.corner_uv,
    "Parameterization.image": lambda s: s.map.image([0], [[0.2, 0.3, 0.5]]),
    "Parameterization.original": lambda s: s.map.original(s.map.uv[:1]),
    "Parameterization.evaluate": lambda s: s.map.evaluate(s.f, [[0.1, 0.1], [9.0, 9.0]]),
    "Parameterization.from_map": lambda s: s.map.from_map(s.map.to_map(s.f)),
    "Parameterization.to_map": lambda s: s.map.to_map(s.fields),
    "flatten": lambda s: bt.flatten(s.mesh),
    "atlas": lambda s: bt.atlas(s.mesh, 2, size=64, strict=False),
    "TextureAtlas": lambda s: bt.atlas(s.mesh, size=32, seams=0, max_distortion=4.0),
    "bake": lambda s: bt.bake(bt.atlas(s.mesh, size=32, strict=False), s.f),
    "segment_into_disks": lambda s: bt.segment_into_disks(s.mesh, 2),
    "DiskCells": lambda s: bt.segment_into_disks(s.mesh, 1).labels,
    "harmonic": lambda s: bt.harmonic(s.mesh, s.held, s.fields[s.held]),
    "certify": lambda s: bt.certify(s.mesh, s.fields),
    "Certificate": lambda s: bt.certify(s.map.mesh, s.map.uv),
    "distortion": lambda s: bt.distortion(s.mesh, s.fields),
    "Distortion": lambda s: bt.distortion(s.mesh, s.mesh.vertices[:, :2]).energy,
}
GRIDS = {
    "Grid": lambda s: bt.laplacian(s.grid),
    "Grid.averaging_kernel": lambda s: s.grid.averaging_kernel(),
    "Grid.averaging_limit": lambda s: s.grid.averaging_limit(s.on_grid),
    "Grid.divergence": lambda s: s.grid.divergence(),
    "Grid.eigenvalues": lambda s: s.grid.eigenvalues(),
    "Grid.fourier_modes": lambda s: s.grid.fourier_modes(3),
    "Grid.gradient": lambda s: s.grid.gradient("centered"),
    "Grid.kernel": lambda s: s.grid.kernel(np.ones((3, 3))),
    "Grid.laplacian_kernel": lambda s: s.grid.laplacian_kernel(),
    "Grid.make_laplacian": lambda s: s.grid.make_laplacian("distance", "unit"),
    "dft": lambda s: bt.dft(s.on_grid.reshape(s.grid.shape)),
    "idft": lambda s: bt.idft(bt.dft(s.f)),
    "convolve": lambda s: bt.convolve(s.f, s.f),
}
SURFACES = {
    "Rectangle": lambda s: bt.Rectangle((0, 1), (-1, 1)),
    "Rectangle.contains": lambda s: bt.Rectangle((0, 1), (0, 2)).contains(*s.uv.T),
    "Rectangle.nearest": lambda s: bt.Rectangle((0, 1), (0, 2)).nearest(*(3 * s.uv.T)),
    "Rectangle.samples": lambda s: bt.Rectangle((0, 1), (0, 2)).samples(5),
    "Disk": lambda s: bt.Disk(2.0),
    "Disk.contains": lambda s: bt.Disk(2.0).contains(*s.uv.T),
    "Disk.nearest": lambda s: bt.Disk(0.5).nearest(*(3 * s.uv.T)),
    "Disk.samples": lambda s: bt.Disk(2.0).samples(5),
    "ParametricSurface": lambda s: s.surface,
    "ParametricSurface.area_element": lambda s: s.surface.area_element(*s.uv.T),
    "ParametricSurface.curve_length": lambda s: s.surface.curve_length(
        lambda t: (t, t / 2), 0.0, 1.0
    ),
    "ParametricSurface.first_fundamental_form": lambda s: s.surface.first_fundamental_form(*s.uv.T),
    "ParametricSurface.gaussian_curvature": lambda s: s.surface.gaussian_curvature(*s.uv.T),
    "ParametricSurface.is_conformal": lambda s: s.surface.is_conformal(),
    "ParametricSurface.is_flat": lambda s: s.surface.is_flat(),
    "ParametricSurface.is_isometric": lambda s: s.surface.is_isometric(),
    "ParametricSurface.jacobian": lambda s: s.surface.jacobian(*s.uv.T),
    "ParametricSurface.laplace_beltrami": lambda s: s.surface.laplace_beltrami(
        lambda x, y, z: x * y + z
    )(*s.uv.T),
    "ParametricSurface.mean_curvature": lambda s: s.surface.mean_curvature(*s.uv.T),
    "ParametricSurface.mesh": lambda s: s.surface.mesh(5, 4),
    "ParametricSurface.pullback": lambda s: s.surface.pullback(lambda x, y, z: x)(*s.uv.T),
    "ParametricSurface.trace": lambda s: s.surface.trace(lambda t: (t, t), s.uv[:, 0]),
    "Atlas": lambda s: s.atlas,
    "Atlas.covers": lambda s: s.atlas.covers(0, s.surface(*s.uv.T)),
    "Atlas.laplace_beltrami": lambda s: s.atlas.laplace_beltrami(lambda x, y, z: x)(
        s.surface(*s.uv.T)
    ),
    "Atlas.locate": lambda s: s.atlas.locate(s.surface(*s.uv.T)),
    "Atlas.transition": lambda s: s.atlas.transition(0, 0)(*s.uv.T),
    "ball_average_laplacian": lambda s: bt.ball_average_laplacian(
        s.surface, lambda x, y, z: x, *s.uv.T, 0.05, directions=8, steps=8
    ),
    "exponential_map": lambda s: bt.exponential_map(s.surface, *s.uv.T, 0.1, 0.2, steps=8),
    "shapes.blob": lambda s: bt.shapes.blob(500),
    "shapes.cube": lambda s: bt.shapes.cube(2),
    "shapes.cylinder": lambda s: bt.shapes.cylinder(5, 3),
    "shapes.disk": lambda s: bt.shapes.disk(2),
    "shapes.grid": lambda s: bt.shapes.grid(3, 2),
    "shapes.icosphere": lambda s: bt.shapes.icosphere(1),
    "shapes.octahedron": lambda s: bt.shapes.octahedron(),
    "shapes.tetrahedron": lambda s: bt.shapes.tetrahedron(),
    "shapes.torus": lambda s: bt.shapes.torus(5, 4),
    "datasets.Dataset": lambda s: bt.datasets.describe("spot"),
    "datasets.describe": lambda s: bt.datasets.describe("torus"),
    "datasets.names": lambda s: bt.datasets.names(),
    "datasets.fetch": None,  # tests/datasets, with a server
    "datasets.load": None,
}
TABLES = (MESHES, OPERATORS, SPECTRA, FLOWS, GRIDS, SURFACES)
ROWS = {name: call for table in TABLES for name, call in table.items()}
CALLS = {name: call for name, call in ROWS.items() if call is not None}
SLOW = ("plot_spectrum", "page", "Page", "run_batch", "Batch")  # called once
OF_MESHES = {
    name: call
    for name, call in CALLS.items()
    if name not in {**GRIDS, **SURFACES, **dict.fromkeys(SLOW)}
}


def public_names():
    """Every public function, class and method: what needs a row."""
    for name in bt.__all__:
        value = getattr(bt, name)
        if inspect.ismodule(value):
            if value is not bt.errors:
                yield from (f"{name}.{inner}" for inner in value.__all__)
            continue
        yield name
        if inspect.isclass(value):
            for method in dir(value):
                static = inspect.getattr_static(value, method)
                derived = isinstance(static, property | functools.cached_property)
                if not method.startswith("_") and callable(getattr(value, method)) and not derived:
                    yield f"{name}.{method}"
