"""SVG and PNG output."""

import re
from xml.etree import ElementTree

import matplotlib
import pytest
from markupsafe import escape

from uplift.common.text import printable
from uplift.extras.pages.figure import (
    STYLE,
    figure_text,
    new_figure,
    style_axes,
    to_svg,
)


def drawn(value):
    with matplotlib.rc_context(STYLE):
        figure = new_figure(2, 1)
        axes = figure.subplots()
        axes.plot([0, value], marker="o")
        style_axes(axes)
        return to_svg(figure, 'a < "b"')


def test_equal_figures_have_equal_svg_and_others_share_no_identifier():
    assert drawn(1) == drawn(1)
    first, second = (
        set(re.findall(r' id="([^"]+)"', drawn(value))) for value in (1, 2)
    )
    assert first
    assert not first & second


@pytest.mark.parametrize(
    "text", [r"$\frac{A$", "$$", r"a\$b", "_hidden", "a\x00\x1b[2Jb", "\ud800", "{$x$}"]
)
def test_text_of_files_is_drawn_as_it_is(text):
    with matplotlib.rc_context(STYLE):
        figure = new_figure(3, 2)
        axes = figure.subplots()
        axes.plot([0, 1], label=figure_text(text))
        axes.set_title(figure_text(text))
        axes.legend()
        svg = to_svg(figure)
    ElementTree.fromstring(svg)
    assert svg.count(str(escape(printable(text)))) >= 2  # title and legend
