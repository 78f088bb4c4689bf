import numpy as np
import pytest

from beltrami.display.compose import compose
from beltrami.display.framing import fit_camera
from beltrami.display.scene import Panel, Style
from beltrami.display.values import choose_limits

STYLE = Style((120, 80))
GREY = np.full((80, 120, 3), 90, np.uint8)


@pytest.fixture
def panel(square):
    return Panel(square, fit_camera(square))


def with_bar(square, f, caption=""):
    values = np.asarray(f, float)
    limits, table = choose_limits(values, None, None)
    return Panel(square, fit_camera(square), values[:, None], limits, table, (), caption)


def test_panels_are_side_by_side(panel):
    pictures = [np.full((80, 120, 3), level, np.uint8) for level in (10, 20, 30)]
    row = compose(pictures, [panel] * 3, STYLE, columns=3, colorbar=True)
    assert np.array_equal(row, np.concatenate(pictures, axis=1))
    grid = compose(pictures, [panel] * 3, STYLE, columns=2, colorbar=True)
    assert grid.shape == (160, 240, 3)
    assert np.array_equal(grid[80:, :120], pictures[2])
    assert (grid[80:, 120:] == 255).all()  # the background, where there is no panel


def test_a_caption_is_above_its_panel(square, panel):
    named = Panel(square, panel.camera, caption="right")
    image = compose([GREY, GREY], [panel, named], STYLE, columns=2, colorbar=True)
    above = len(image) - 80
    assert above > 10
    assert (image[above:] == 90).all()
    assert (image[:above, :120] == 255).all()
    ink = (image[:above, 120:] < 128).all(axis=2)
    assert ink.any()
    columns = np.flatnonzero(ink.any(axis=0))
    assert abs((columns[0] + columns[-1]) / 2 - 60) < 3  # in the middle


def test_long_captions_are_broken_and_make_room(square, panel):
    heights = []
    for text in ("word", "word " * 12, "word\nword\nword"):
        named = Panel(square, panel.camera, caption=text.strip())
        image = compose([GREY], [named], STYLE, columns=1, colorbar=True)
        heights.append(len(image))
        band = image[: len(image) - 80]
        assert (band[:2] == 255).all()  # nothing is cut off
        assert (band[:, [0, 1, -2, -1]] == 255).all()
    assert heights[0] < heights[2] <= heights[1]


def test_the_bar_shows_the_colours_of_the_table(square):
    panel = with_bar(square, [1, 2, 3, 4])
    image = compose([GREY], [panel], STYLE, columns=1, colorbar=True)
    below = image[80:]
    colored = np.ptp(below.astype(int), axis=2) > 30
    y = np.flatnonzero(colored.sum(axis=1) > 50)
    row = below[y[len(y) // 2]]
    assert np.array_equal(row[24], np.rint(255 * panel.table[0]))
    assert np.array_equal(row[95], np.rint(255 * panel.table[-1]))
    assert (below[y[-1] + 2 :] < 128).any()  # the labels


def test_zero_is_labelled_on_symmetric_bars_only(square):
    def middle(f):
        image = compose([GREY], [with_bar(square, f)], STYLE, columns=1, colorbar=True)
        return (image[-12:, 50:70] < 128).any()

    assert middle([-1, 0, 0, 1])
    assert not middle([1, 2, 3, 4])


def test_no_bar_for_colours_or_when_not_wanted(square, panel):
    colors = Panel(square, panel.camera, np.full((4, 3), 0.5))
    for panel_, colorbar in ((colors, True), (with_bar(square, [1, 2, 3, 4]), False)):
        image = compose([GREY], [panel_], STYLE, columns=1, colorbar=colorbar)
        assert np.array_equal(image, GREY)


def test_text_is_light_on_a_dark_background(square, panel):
    named = Panel(square, panel.camera, caption="night")
    dark = compose([GREY], [named], Style((120, 80), background="black"), columns=1, colorbar=True)
    assert dark[: len(dark) - 80].max() > 200
