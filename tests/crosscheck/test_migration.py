"""The migration tables are true: each row is evaluated on both sides, with the real packages."""

import re
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.sparse import issparse

import beltrami as bt

FOLDER = Path(__file__).parents[2] / "docs" / "migration"
PACKAGES = {"libigl": "igl", "trimesh": "trimesh", "lapy": "lapy", "pygsp": "pygsp"}


def rows(page):
    """The rows of the table of a page: the call there, the call here, and what is said of it."""
    text = (FOLDER / f"{page}.md").read_text(encoding="utf-8")
    return re.findall(r"^\| `(.+?)` \| `(.+?)` \|(.*)\|$", text, re.MULTILINE)


@cache
def scope(page):
    """Run the block at the head of a page."""
    pytest.importorskip(PACKAGES[page], reason=f"{page} is not installed")
    text = (FOLDER / f"{page}.md").read_text(encoding="utf-8")
    made = {}
    with np.errstate(all="ignore"):
        exec(re.search(r"```python\n(.*?)```", text, re.DOTALL)[1], made)  # noqa: S102
    return made


def plain(value):
    return value.toarray() if issparse(value) else np.asarray(value)


def tolerance(note):
    """What the note allows, beside the largest value: "within 0.01", or else rounding."""
    found = re.search(r"within ([\d.e-]+\d)", note)
    return float(found[1]) if found else 1e-8


def difference(theirs, ours):
    """Largest difference beside the largest value; infinite if the shapes differ."""
    a, b = plain(theirs), plain(ours)
    if a.shape != b.shape:
        return np.inf
    if a.dtype == bool:
        return float((a != b).any())
    return abs(a - b).max(initial=0) / max(abs(a).max(initial=0), 1e-300)


@pytest.mark.filterwarnings("ignore")  # of other libraries
@pytest.mark.parametrize(
    ("page", "theirs", "ours", "note"),
    [(page, *row) for page in PACKAGES for row in rows(page)],
)
def test_both_sides_of_a_row_agree(page, theirs, ours, note):
    names = scope(page)
    there, here = eval(theirs, dict(names)), eval(ours, dict(names))  # noqa: S307
    assert difference(there, here) <= tolerance(note)


@pytest.mark.parametrize("page", PACKAGES)
def test_the_tables_are_not_empty_and_no_row_is_lost(page):
    text = (FOLDER / f"{page}.md").read_text(encoding="utf-8")
    found = rows(page)
    assert len(found) == text.count("\n| ") - 1 >= 14
    assert len({theirs for theirs, _, _ in found}) == len(found)
    for _, ours, _ in found:
        for name in re.findall(r"bt\.(\w+)", ours):
            assert hasattr(bt, name), name


def test_what_is_said_of_libigl():
    igl = pytest.importorskip("igl")
    mesh = bt.shapes.icosphere(1)
    V, F = mesh.to("arrays")
    stray = np.vstack([V, [[5.0, 5.0, 5.0]]])
    assert igl.massmatrix(stray, F, igl.MASSMATRIX_TYPE_VORONOI).shape == (42, 42)
    with pytest.raises(bt.errors.UnreferencedVertexError) as caught:
        bt.laplacian(bt.Mesh(stray, F))
    assert caught.value.vertices.tolist() == [42]
    V[3] = np.nan
    assert np.isnan(igl.cotmatrix(V, F).data).any()
    with pytest.raises(bt.errors.NonFiniteError) as caught:
        bt.laplacian(bt.Mesh(V, F))
    assert caught.value.vertices.tolist() == [3]


def test_the_comparison_sees_another_sign_and_another_factor():
    L = bt.laplacian(bt.shapes.icosphere(1)).stiffness
    assert difference(L, -L) > 1
    assert difference(L, 2 * L) > 0.9
    assert difference(L, L[:5]) == np.inf
    assert tolerance("within 0.02: another step") == 0.02
