"""Functions with NaN: faces without a value have a colour of their own, when asked."""

import numpy as np
import pytest

from beltrami.display.render import render
from beltrami.errors import MeshError, NonFiniteError
from beltrami.mesh.mesh import Mesh

PLAIN = {"size": (40, 40), "antialias": 1, "colorbar": False, "level_set": None}
RED = np.array([255, 0, 0])


def halves():
    """A flat square of 8 x 8 points, f = x + 1, and NaN on the left; the light is 1 everywhere."""
    x, y = np.meshgrid(np.linspace(-1, 1, 9), np.linspace(-1, 1, 9))
    points = np.stack([x.ravel(), y.ravel()], axis=1)
    corner = (np.arange(8)[:, None] * 9 + np.arange(8)).ravel()
    lower = np.stack([corner, corner + 1, corner + 10], axis=1)
    upper = np.stack([corner, corner + 10, corner + 9], axis=1)
    f = points[:, 0] + 1
    return Mesh(points, np.vstack([lower, upper])), np.where(f < 0.75, np.nan, f), f


def test_faces_with_a_missing_corner_and_no_others_have_its_colour():
    mesh, f, whole = halves()
    inside = np.isfinite(f)[mesh.faces].all(axis=1)
    limits = {"limits": (0.0, 2.0)}
    image = render(mesh, f, missing="#ff0000", **PLAIN, **limits)
    full = render(mesh, whole, **PLAIN, **limits)
    red = (image == RED).all(axis=2)
    assert np.array_equal(image[~red], full[~red])
    assert not (full[red] == RED).all(axis=1).any()
    painted = (full != 255).any(axis=2)
    assert abs(red.sum() / painted.sum() - (~inside).mean()) < 0.05
    assert red[:, :20].sum() > red[:, 20:].sum()


def test_limits_and_level_lines_are_those_of_the_values_that_are_there():
    mesh, f, _ = halves()
    chosen = render(mesh, f, missing="red", **PLAIN)
    assert np.array_equal(
        chosen, render(mesh, f, missing="red", **PLAIN, limits=(np.nanmin(f), np.nanmax(f)))
    )
    lines = {**PLAIN, "level_set": [0.5, 1.5]}
    one = {**PLAIN, "level_set": [1.5]}
    assert np.array_equal(
        render(mesh, f, missing="red", **lines), render(mesh, f, missing="red", **one)
    )
    constant = np.where(np.isnan(f), np.nan, 3.0)
    image = render(mesh, constant[:, None], missing="red", **PLAIN)
    assert (image == [255, 0, 0]).all(axis=2).any()
    assert len(np.unique(image.reshape(-1, 3), axis=0)) == 3  # red, the middle, the background


def test_one_colour_for_all_panels_and_common_limits():
    mesh, f, whole = halves()
    both = render(mesh, [f, whole], missing="red", limits="common", **PLAIN)
    alone = render(mesh, whole, **PLAIN)
    assert np.array_equal(both[:, 40:], alone)


@pytest.mark.parametrize(
    ("change", "missing"),
    [
        (lambda f: f, None),  # nobody asked
        (lambda f: np.where(np.isnan(f), np.inf, f), "red"),
        (lambda f: np.full(len(f), np.nan), "red"),  # nothing to be seen
        (lambda f: np.stack([f, f, f], axis=1) / 3, "red"),  # colours are no values
    ],
)
def test_what_stays_an_error(change, missing):
    mesh, f, _ = halves()
    with pytest.raises(NonFiniteError):
        render(mesh, change(f), missing=missing, **PLAIN)


def test_the_colour_is_one():
    mesh, f, _ = halves()
    with pytest.raises(MeshError, match="missing"):
        render(mesh, f, missing="no colour", **PLAIN)
