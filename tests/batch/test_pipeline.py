import inspect
import json

import numpy as np
import pytest

import beltrami as bt
from beltrami.batch.failures import PipelineError, TooLargeError
from beltrami.batch.memory import BASE, parse_size
from beltrami.batch.pipeline import as_pipeline
from beltrami.batch.record import fits
from beltrami.batch.verb import KINDS, Scene, Size
from beltrami.batch.verbs import VERBS

FUNCTIONS = {
    "repair": bt.repair,
    "smooth": bt.smooth_mesh,
    "denoise": bt.denoise,
    "compress": bt.compress,
    "integrate": bt.integrate,
    "laplacian": bt.laplacian,
    "parameterize": bt.parameterize,
}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_parameters_are_those_of_the_library_with_their_defaults(name):
    own = inspect.signature(FUNCTIONS[name]).parameters
    for key, parameter in VERBS[name].parameters.items():
        if key == "save":
            continue
        default = own[key].default
        assert parameter.default in (default, None), key  # of repair None stands for everything
        if parameter.default is None and name != "repair":
            assert default is None, key


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("repiar", "step 1 .*unknown verb 'repiar'.*Did you mean 'repair'"),
        ("repair, spectrum kk=3", "step 2 .*unknown parameter of spectrum 'kk'"),
        ("diagnose x=1", "diagnose has no parameters"),
        ("spectrum k=0", "k is 0 where 1 or more"),
        ("spectrum k=2.5", "k is 2.5 where a whole number"),
        ("spectrum k=true", "k is True where a whole number"),
        ("spectrum weights=cotan", "unknown weights 'cotan'.*'cotangent'"),
        ("spectrum tolerance=0", "tolerance is 0 where a finite number > 0"),
        ("spectrum near=nan", "near is nan"),
        ("compress bits=31", "bits is 31 where from 1 to 30"),
        ("compress bits=9 max_error=0.1", "give one of them"),
        ("descriptors", "needs a spectrum"),
        ("spectrum, smooth, descriptors", "step 3.*needs a spectrum after the last step"),
        ("spectrum, descriptors kind=wks times=1", "times belong to kind=hks"),
        ("spectrum, descriptors times=[]", "times is empty"),
        ("smooth method=implicit", "'implicit' needs a time"),
        ("smooth method=taubin time=1", "'taubin' has no time"),
        ("smooth hold_boundary=true keep=volume", "would move the boundary"),
        ("repair orient=true tolerance=0.01", "tolerance goes with"),
        ("repair orient=1", "orient is 1 where true or false"),
        ("integrate how=edge areas=voronoi", "areas at the edge"),
        ("write format=gltf", "unknown format 'gltf'"),
    ],
)
def test_a_pipeline_that_cannot_run_is_told_in_one_line(text, problem):
    with pytest.raises(PipelineError, match=problem) as caught:
        as_pipeline(text)
    assert "\n" not in str(caught.value)


def test_an_empty_pipeline_is_none():
    with pytest.raises(PipelineError, match="needs a step"):
        as_pipeline([])


def test_a_verb_may_come_twice():
    steps = as_pipeline("diagnose, repair, diagnose").steps
    assert [step.label for step in steps] == ["diagnose", "repair", "diagnose_2"]


def test_dashes_are_underscores():
    assert as_pipeline("spectrum hold-boundary=true") == as_pipeline("spectrum hold_boundary=true")


def test_the_key_is_of_the_bytes_the_steps_and_the_version():
    def key(text, digest="a", suffix=".ply", version="1"):
        return as_pipeline(text).key(digest, suffix, version)

    base = key("repair, spectrum k=100")
    assert key("repair tolerance=0, spectrum") == base  # defaults, written or not
    others = [
        key("repair, spectrum k=101"),
        key("spectrum k=100"),
        key("spectrum k=100, repair"),
        key("repair, spectrum k=100", digest="b"),
        key("repair, spectrum k=100", suffix=".off"),
        key("repair, spectrum k=100", version="2"),
    ]
    assert len({base, *others}) == 7


EVERYTHING = (
    "diagnose, repair, smooth steps=2, denoise, integrate, integrate how=edge, curvature, "
    "laplacian, spectrum k=6, descriptors count=3, compress, write, parameterize"
)


def test_every_verb_fills_the_columns_that_it_has_with_values_of_their_kind(tmp_path):
    pipeline = as_pipeline(EVERYTHING)
    assert {step.name for step in pipeline.steps} == set(VERBS)
    scene = Scene(bt.shapes.icosphere(2))
    for step in pipeline.steps:
        told = step.verb.run(scene, step.options)
        assert set(told.facts) == set(step.verb.columns), step.label
        for name, kind in step.verb.columns.items():
            assert kind in KINDS
            assert told.facts[name] is not None
            assert fits(kind, told.facts[name]), (step.label, name, told.facts[name])
            json.dumps(told.facts[name])
        if told.write is not None:
            path = tmp_path / f"{step.label}{told.suffix}"
            told.write(path)
            assert path.stat().st_size > 0
        scene = told.scene


def test_repair_without_a_parameter_repairs_everything_but_keeps_all_components():
    two = np.vstack([bt.shapes.icosphere(0).vertices, [[9, 9, 9], [7, 7, 7], [8, 7, 7], [7, 8, 7]]])
    faces = [*bt.shapes.icosphere(0).faces.tolist(), [13, 14, 15], [13, 14, 15], [13, 13, 14]]
    step = as_pipeline("repair").steps[0]
    fixed = step.verb.run(Scene(bt.Mesh(two, faces)), step.options).scene.mesh
    assert (fixed.n_vertices, fixed.n_faces) == (15, 21)
    step = as_pipeline("repair remove_unreferenced=true").steps[0]
    fixed = step.verb.run(Scene(bt.Mesh(two, faces)), step.options).scene.mesh
    assert (fixed.n_vertices, fixed.n_faces) == (15, 23)
    step = as_pipeline("repair remove_duplicate_faces=false").steps[0]
    fixed = step.verb.run(Scene(bt.Mesh(two, faces)), step.options).scene.mesh
    assert fixed.n_faces == 22


def test_the_spectrum_takes_the_pair_before_it_unless_told_otherwise():
    mesh = bt.shapes.icosphere(1)
    pair = bt.laplacian(mesh, "distance", "unit")
    scene = Scene(mesh, pair)
    assert scene.pair_of(None, None) is pair
    assert scene.pair_of("cotangent", None).weight_kind == "cotangent"


def test_means_of_signatures_are_those_of_the_surface():
    mesh = bt.shapes.torus(12, 9)
    basis = bt.fourier_basis(bt.laplacian(mesh), 108)
    step = as_pipeline("spectrum, descriptors kind=hks times=[0.1, 0.3]").steps[1]
    told = step.verb.run(Scene(mesh, None, basis), step.options)
    trace = np.exp(-basis.eigenvalues * np.array([[0.1], [0.3]])).sum(axis=1)
    assert np.allclose(told.facts["hks_mean"], trace / mesh.area, rtol=1e-9)


def test_estimates_grow_with_the_mesh_and_name_the_step():
    pipeline = as_pipeline("repair, spectrum k=200, descriptors count=2000")
    small, _ = pipeline.estimate(Size(100, 200))
    large, where = pipeline.estimate(Size(10**6, 2 * 10**6))
    assert BASE < small < large
    assert where == "descriptors"
    assert large > 2 * 8 * 10**6 * 2000


@pytest.mark.parametrize(
    "text",
    [
        *("", "4", "0GB", "-1GB", "4PB", "GB", "1e999", "9" * 400 + "GB", "4i", "0.5B"),
        *(0, -1, 1e30, 10**400, float("nan"), True, [4], 1j),
    ],
)
def test_what_is_no_size_of_memory(text):
    if text == "4":
        assert parse_size(text) == 4
        return
    with pytest.raises(PipelineError, match="a size such as 4GB"):
        parse_size(text)


def test_an_estimate_counts_what_all_steps_before_hold():
    size = Size(10**6, 2 * 10**6)
    few, many = (
        as_pipeline(f"spectrum k={k}, diagnose, descriptors count=2000").estimate(size)
        for k in (100, 200)
    )
    assert few[1] == many[1] == "descriptors"
    assert many[0] - few[0] == 8 * 10**6 * 100


def test_the_center_is_that_of_the_surface():
    moved = bt.shapes.icosphere(1)
    mesh = bt.Mesh(3 * moved.vertices + [1, 2, -7], moved.faces)
    step = as_pipeline("integrate").steps[0]
    facts = step.verb.run(Scene(mesh), step.options).facts
    assert np.allclose(facts["centroid"], [1, 2, -7], rtol=0, atol=1e-12)
    assert np.isclose(facts["area"], mesh.area)
    assert np.isclose(facts["volume"], mesh.volume)


def test_too_large_says_how_much():
    error = TooLargeError("spectrum of 5 vertices", 8 * 10**9, 4 * 10**9)
    assert isinstance(error, MemoryError)
    assert "8.00 GB of memory, and 4.00 GB are allowed" in str(error)
