"""SVG and PNG output."""

import re
from xml.etree import ElementTree

import pytest
from markupsafe import escape

from uplift.common.text import printable
from uplift.extras.pages.figure import to_svg
from uplift.extras.pages.marks import line
from uplift.extras.pages.panels import Dot, Panel, draw


def drawn(value):
    marks = [line([0, 1], [0, value], marker="o")]
    return to_svg(draw([Panel(marks, dots=[Dot(1, 0, "text")])]), 'a < "b"')


def test_equal_figures_have_equal_svg_and_others_share_no_identifier():
    assert drawn(1) == drawn(1)
    first, second = (
        set(re.findall(r' id="([^"]+)"', drawn(value))) for value in (1, 2)
    )
    assert first
    assert not first & second


@pytest.mark.parametrize(
    "text", [r"$\frac{A$", r"a\$b", "_hidden", "a\x00\x1b[2J\ud800b"]
)
def test_text_of_files_is_drawn_as_it_is(text):
    panel = Panel([line([0, 1], [0, 1], text)], text, legend="best")
    svg = to_svg(draw([panel]))
    ElementTree.fromstring(svg)
    assert svg.count(str(escape(printable(text)))) >= 2  # title and legend
