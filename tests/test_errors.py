import copy
import pickle

import numpy as np
import pytest

from beltrami import errors
from beltrami.diffusion.heat import heat
from beltrami.diffusion.smooth_mesh import smooth_mesh
from beltrami.errors import (
    ApproximationError,
    BeltramiError,
    ConvergenceError,
    DatasetError,
    FileFormatError,
    MeshError,
    MissingExtraError,
    NotDifferentiableError,
    NotManifoldError,
    NotPositiveDefiniteError,
    RankLossError,
    SingularMatrixError,
    StepTooLongError,
    SurfaceError,
    TruncationError,
    UnknownNameError,
    check_name,
)
from beltrami.mesh.shapes import icosphere
from beltrami.operators.laplacian import laplacian
from beltrami.parameterization.parameterize import parameterize

EXAMPLES = (
    MeshError("bad", vertices=[3, 1], faces=[2], edges=[[0, 1]], remedy="Mend it."),
    NotManifoldError("bad", edges=np.array([[4, 5]])),
    StepTooLongError(2.0, 0.5),
    TruncationError(0.25, 12),
    SingularMatrixError("singular", rows=[7]),
    NotPositiveDefiniteError([3, 4]),
    ConvergenceError("late"),
    ApproximationError("far", 0.5, "Come nearer."),
    UnknownNameError("weights", "cotan", ("cotangent", "distance")),
    FileFormatError("a.obj", "no number", line=7),
    RankLossError("no immersion", parameters=[[0.0, 1.5]], remedy="Move."),
    FileFormatError("a.ply", "too short", byte=0),
    MissingExtraError("trimesh", "io", "reading"),
    DatasetError("not there", "a.obj"),
)


@pytest.mark.parametrize("thing", [np.eye(40), "x" * 999, list(range(999)), {"a": "b\nc"}])
def test_what_was_given_is_shown_in_one_short_line(thing):
    said = errors.shown(thing)
    assert len(said) <= 60
    assert "\n" not in said
    assert said[:5] == repr(thing)[:5]


@pytest.mark.parametrize("name", errors.__all__)
def test_every_error_is_one_of_this_library(name):
    assert issubclass(getattr(errors, name), BeltramiError)


def test_all_names_every_error():
    made = {
        name
        for name, thing in vars(errors).items()
        if isinstance(thing, type) and issubclass(thing, BeltramiError)
    }
    assert made == set(errors.__all__)


@pytest.mark.parametrize(
    ("cls", "also"),
    [
        (MeshError, ValueError),
        (StepTooLongError, ValueError),
        (SingularMatrixError, ValueError),
        (NotPositiveDefiniteError, ValueError),
        (ConvergenceError, RuntimeError),
        (UnknownNameError, ValueError),
        (FileFormatError, ValueError),
        (MissingExtraError, ImportError),
        (SurfaceError, ValueError),
    ],
)
def test_who_knows_only_python_catches_them_too(cls, also):
    assert issubclass(cls, also)


@pytest.mark.parametrize("name", [n for n in errors.__all__ if n.endswith("Error")])
def test_the_kinds_of_mesh_errors(name):
    cls = getattr(errors, name)
    others = (StepTooLongError, SingularMatrixError, ConvergenceError, UnknownNameError)
    others += (FileFormatError, MissingExtraError, BeltramiError, NotPositiveDefiniteError)
    others += (SurfaceError, RankLossError, NotDifferentiableError, TruncationError)
    others += (ApproximationError, DatasetError)
    assert issubclass(cls, MeshError) != (cls in others)


def test_the_guilty_are_kept_as_integers_and_named():
    error = EXAMPLES[0]
    assert str(error) == "bad (vertices 3, 1; faces 2; edges (0, 1)). Mend it."
    assert (error.problem, error.remedy) == ("bad", "Mend it.")
    for array in (error.vertices, error.faces, error.edges):
        assert array.dtype == np.int64
    assert error.edges.shape == (1, 2)


def test_nothing_guilty_nothing_named():
    error = MeshError("bad")
    assert str(error) == "bad"
    assert len(error.vertices) == len(error.faces) == 0
    assert error.edges.shape == (0, 2)
    assert str(MeshError("bad", remedy="Mend it.")) == "bad. Mend it."


@pytest.mark.parametrize(("count", "tail"), [(5, "3, 4"), (6, "and 1 more"), (40, "and 35 more")])
def test_long_lists_are_cut_after_five(count, tail):
    text = str(MeshError("bad", vertices=np.arange(count)))
    assert text.startswith("bad (vertices 0, 1, 2, 3, 4")
    assert text.endswith(f"{tail})")


def test_a_single_edge_may_be_given_flat():
    assert MeshError("bad", edges=(3, 4)).edges.tolist() == [[3, 4]]


@pytest.mark.parametrize("error", EXAMPLES, ids=lambda e: type(e).__name__)
def test_errors_survive_pickling_and_copying(error):
    for other in (pickle.loads(pickle.dumps(error)), copy.copy(error)):  # noqa: S301
        assert type(other) is type(error)
        assert str(other) == str(error)
        assert set(vars(other)) == set(vars(error))
        for key, value in vars(error).items():
            assert np.array_equal(getattr(other, key), value)


def test_a_step_too_long_tells_the_longest():
    error = StepTooLongError(2.0, 0.5)
    assert (error.step, error.longest) == (2.0, 0.5)
    assert "0.5" in str(error)
    assert "implicit" in str(error)


def test_places_in_files():
    assert str(FileFormatError("a.obj", "no number", line=7)) == "a.obj, line 7: no number"
    assert str(FileFormatError("a.ply", "short", byte=0)) == "a.ply, byte 0: short"
    assert str(FileFormatError("a.ply", "short")) == "a.ply: short"


def test_the_guilty_parameters_are_named():
    error = RankLossError("no immersion", parameters=[0.25, 1.5], remedy="Move.")
    assert str(error) == "no immersion ((u, v) = (0.25, 1.5)). Move."
    assert error.parameters.tolist() == [[0.25, 1.5]]
    assert str(SurfaceError("bad")) == "bad"
    assert SurfaceError("bad").parameters.shape == (0, 2)
    assert issubclass(RankLossError, SurfaceError)
    assert issubclass(NotDifferentiableError, SurfaceError)


def test_a_missing_extra_says_what_to_install():
    error = MissingExtraError("trimesh", "io", "reading glTF")
    assert str(error) == "reading glTF needs the package 'trimesh': pip install 'beltrami[io]'"
    assert (error.package, error.extra) == ("trimesh", "io")


def test_unknown_names_list_the_choices_and_the_nearest():
    with pytest.raises(UnknownNameError) as caught:
        check_name("weights", "cotan", ("cotangent", "distance"))
    assert "choose one of 'cotangent', 'distance'" in str(caught.value)
    assert str(caught.value).endswith("Did you mean 'cotangent'?")
    assert caught.value.choices == ("cotangent", "distance")
    assert "Did you mean" not in str(UnknownNameError("weights", "xyz", ("cotangent",)))


@pytest.mark.parametrize(
    ("call", "meant"),
    [
        (lambda mesh: laplacian(mesh, "conformal"), "cotangent"),  # as the chapter calls it
        (lambda mesh: laplacian(mesh, "uniform"), "combinatorial"),
        (lambda mesh: laplacian(mesh, mass="lumped"), "barycentric"),
        (lambda mesh: laplacian(mesh, mass="mixed"), "voronoi"),
        (lambda mesh: smooth_mesh(mesh, "heat"), "implicit"),
        (lambda mesh: heat(laplacian(mesh), mesh.vertices, 1, "expm"), "exact"),
        (lambda mesh: parameterize(mesh, "lscm"), "least_squares_conformal"),
    ],
)
def test_names_of_elsewhere_lead_to_ours(call, meant):
    with pytest.raises(UnknownNameError, match=f"Did you mean '{meant}'"):
        call(icosphere(1))


@pytest.mark.parametrize("name", [None, 3, ["distance"], b"distance", "Distance", ""])
def test_only_exact_names_pass(name):
    with pytest.raises(UnknownNameError):
        check_name("weights", name, ("cotangent", "distance"))
    assert check_name("weights", "distance", ("cotangent", "distance")) == "distance"
