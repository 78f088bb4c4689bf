"""Everything public, with any mesh: numbers, or a ``BeltramiError``; never NaN out of numbers."""

import contextlib
import re
import threading
import warnings
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

import beltrami as bt
import strategies
from beltrami.errors import BeltramiError
from public_calls import CALLS, OF_MESHES, ROWS, SLOW, TABLES, public_names
from public_results import arrays_of, digest
from public_scene import PAIRS, Scene

# Where the documentation says so: no volume of an open mesh, no length of an edge of a function,
# no value outside of a map; no path between components, no bound above the last band or where
# nothing is proven, no area of a face in the plane.
NOT_A_NUMBER = re.compile(r"(\.volume_change|\.noise(\.\d)?\.relative|\.evaluate)$")
INFINITE = re.compile(
    r"^(geodesic_distance|HeatMethod|spectral_|Distortion|distortion|flatten\.distortion|.*_frame)"
    r"|\.truncation$"
)
UNITS = (0, 0, 0, -12, 12)


@st.composite
def meshes(draw):
    """Sound meshes, damaged ones and repaired ones, in any unit, some flat or in R⁵."""
    kind = draw(st.sampled_from(["sound", "damaged", "repaired"]))
    mesh = bt.Mesh(*draw(strategies.arrays() if kind == "sound" else strategies.any_arrays()))
    if kind != "damaged":
        mesh = bt.repair(mesh, remove_degenerate_faces=True, remove_unreferenced=True).mesh
    x = mesh.vertices * 10.0 ** draw(st.sampled_from(UNITS))
    if draw(st.integers(0, 5)) == 0:
        x = x * np.r_[np.ones(x.shape[1] - 1), 10.0 ** draw(st.integers(-12, 0))]
    if draw(st.integers(0, 7)) == 0:
        x = np.c_[x, x[:, :1] / 3, x[:, 1:2] / 7]
    return bt.Mesh(x, mesh.faces)


def sound():
    """A disk in space without any symmetry."""
    disk = bt.shapes.disk(3, dimension=3)
    moved = np.random.default_rng(5).normal(0, 0.02, disk.vertices.shape)
    return bt.Mesh(disk.vertices + moved, disk.faces)


def test_everything_public_has_a_row():
    rows = {name.split(" ")[0] for name in ROWS}
    assert set(public_names()) - rows == set(), "add rows to public_calls.py"
    assert rows - set(public_names()) == set(), "rows of names that are gone"


@pytest.mark.parametrize("name", CALLS)
def test_every_row_succeeds_on_a_sound_mesh(name):
    scene = Scene(sound())
    check(name, CALLS[name](scene))


def check(name, result):
    """Every number is finite, but where it is said."""
    for path, array in arrays_of(result):
        if array.dtype.kind not in "fc" or np.isfinite(array).all():
            continue
        place = f"{name}{path}"
        assert not np.isnan(array).any() or NOT_A_NUMBER.search(place), f"{place} is NaN"
        assert NOT_A_NUMBER.search(place) or INFINITE.search(place), f"{place} is infinite"


def everything(mesh, seed, kinds, names=tuple(OF_MESHES)):
    scene = Scene(mesh, seed, kinds)
    before = mesh.vertices.copy(), mesh.faces.copy()
    for name in names:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            try:
                check(name, CALLS[name](scene))
            except BeltramiError:
                continue
            except Exception as error:
                error.add_note(f"in {name}")
                raise
    assert np.array_equal(mesh.vertices, before[0], equal_nan=True)
    assert np.array_equal(mesh.faces, before[1])


drawn = given(meshes(), st.integers(0, 9999), st.sampled_from(PAIRS))


@settings(max_examples=15, phases=[Phase.explicit, Phase.reuse, Phase.generate])
@drawn
def test_any_mesh(mesh, seed, kinds):
    everything(mesh, seed, kinds)


@pytest.mark.heavy
@settings(max_examples=1500, derandomize=False)
@drawn
def test_any_mesh_at_length(mesh, seed, kinds):
    everything(mesh, seed, kinds, (*OF_MESHES, *SLOW))


@pytest.mark.parametrize("wrong", [np.nan, np.inf, -1e300])
def test_numbers_that_are_not_finite(wrong):
    """Results or refusals, and no other exception; what is finite may not become NaN unasked."""
    mesh = sound()
    x = mesh.vertices.copy()
    x[4, 1] = wrong
    scene = Scene(mesh.with_vertices(x))
    for name, call in OF_MESHES.items():
        try:
            list(arrays_of(call(scene)))
        except BeltramiError:
            continue
        except Exception as error:
            error.add_note(f"in {name}")
            raise


EMPTY = bt.Mesh(np.zeros((0, 3)), np.zeros((0, 3), int))
SMALL = {
    "nothing": EMPTY,
    "one point": bt.Mesh(np.zeros((1, 3)), EMPTY.faces),
    "points": bt.Mesh(np.eye(3), EMPTY.faces),
    "one flat face": bt.Mesh(np.zeros((3, 3)), [[0, 1, 2]]),
    "one face": bt.Mesh(np.eye(3), [[0, 1, 2]]),
    "one face and its back": bt.Mesh(np.eye(3), [[0, 1, 2], [2, 1, 0]]),
    "the same vertex": bt.Mesh(np.eye(3), [[1, 1, 1]]),
    "in the plane": bt.Mesh([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]]),
    "in R7": bt.Mesh(np.eye(7)[:4], [[0, 1, 2], [0, 2, 3]]),
}


@pytest.mark.parametrize("mesh", SMALL.values(), ids=SMALL)
@pytest.mark.parametrize("kinds", [PAIRS[0], PAIRS[1]], ids="-".join)
def test_the_smallest_meshes(mesh, kinds):
    everything(mesh, 0, kinds)


# ------------------------------------------------------------------------- the same input


def bits(call, scene):
    with contextlib.suppress(BeltramiError):
        return digest(call(scene))
    return "refused"


def variants(mesh):
    """The same numbers in other types and layouts."""
    x, f = mesh.vertices.astype(np.float32), mesh.faces
    wide = np.zeros((len(x), 9), np.float32)
    wide[:, ::3] = x
    locked = x.astype(np.float64)
    locked.flags.writeable = False
    yield "float32", bt.Mesh(x, f.astype(np.int32))
    yield "float64 of it", bt.Mesh(x.astype(np.float64), f)
    yield "lists", bt.Mesh(x.tolist(), f.tolist())
    yield "strided", bt.Mesh(wide[:, ::3], f[::-1][::-1])
    yield "Fortran's order", bt.Mesh(np.asfortranarray(x), np.asfortranarray(f))
    yield "backwards", bt.Mesh(x[::-1].copy()[::-1], f.astype(np.uint16))
    yield "big-endian", bt.Mesh(x.astype(">f8"), f.astype(">i4"))
    yield "read-only", bt.Mesh(locked, f)


def test_types_and_layouts_of_arrays_change_no_bit():
    (_, first), *others = variants(sound())
    expected = {name: bits(call, Scene(first)) for name, call in OF_MESHES.items()}
    assert [name for name, found in expected.items() if found == "refused"] == []
    for variant, mesh in others:
        scene = Scene(mesh)
        for name, call in OF_MESHES.items():
            assert bits(call, scene) == expected[name], (name, variant)


@pytest.mark.parametrize("layout", ["strided", "read-only", "float32"])
def test_layouts_of_functions_change_no_bit(layout):
    first, other = Scene(sound()), Scene(sound())
    for name in ("f", "fields"):
        given_array = getattr(first, name).astype(np.float32)
        first.__dict__[name] = given_array.astype(np.float64)
        if layout == "strided":
            given_array = np.repeat(given_array.astype(np.float64), 2, axis=0)[::2]
        if layout == "read-only":
            given_array = given_array.astype(np.float64)
            given_array.flags.writeable = False
        other.__dict__[name] = given_array
    names = set(OF_MESHES) - ({"compress data"} if layout == "float32" else set())
    for name in sorted(names):  # a file keeps the type of a function
        assert bits(CALLS[name], first) == bits(CALLS[name], other), name


# ------------------------------------------------------------------------- threads


def at_once(scene, names, threads):
    """Each thread calls all of them, in an order of its own, on the same objects."""
    gate = threading.Barrier(threads)

    def one(number):
        order = np.random.default_rng(number).permutation(len(names))
        gate.wait()
        return {names[i]: bits(CALLS[names[i]], scene) for i in order}

    with ThreadPoolExecutor(threads) as pool:
        return list(pool.map(one, range(threads)))


def test_eight_threads_with_the_same_objects_get_the_same_bits():
    names = [name for name in CALLS if name not in SLOW]
    alone = Scene(sound())
    expected = {name: bits(CALLS[name], alone) for name in names}
    shared = Scene(sound())  # nothing is computed yet
    for found in at_once(shared, names, 8):
        different = [name for name in names if found[name] != expected[name]]
        assert not different


def test_no_row_hides_another():
    assert len(ROWS) == sum(map(len, TABLES))
