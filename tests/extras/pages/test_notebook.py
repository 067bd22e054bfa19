"""Cubes in notebooks: short text, escaped HTML, figures of spectra."""

import dataclasses
from xml.etree import ElementTree

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from uplift.extras.pages.notebook import plot_cube
from uplift.lookup import Cube

COLOURS = np.array([[0.8, 0.2, 0.1], [0.1, 0.3, 0.8]])


@pytest.mark.parametrize("name", ["small_cube", "plain_cube"])
def test_html_is_well_formed_and_states_the_facts(request, name):
    cube = request.getfixturevalue(name)
    root = ElementTree.fromstring(cube._repr_html_())
    text = "".join(root.itertext())
    assert "dim 8" in text
    assert "sRGB under D65" in text
    assert len(root.findall(".//span")) == len(cube.atlas_names)
    assert root.find(".//{*}svg") is not None


def test_names_are_escaped(small_cube):
    names = ("<script>alert('&')</script>", *small_cube.atlas_names[1:])
    atlas = dataclasses.replace(small_cube.data.atlas, names=names)
    html = Cube(dataclasses.replace(small_cube.data, atlas=atlas))._repr_html_()
    assert "<script>" not in html
    assert ElementTree.fromstring(html).find(".//span").get("title") == names[0]


def test_spectra_are_plotted_in_their_own_colours(small_cube):
    lines = plot_cube(small_cube, COLOURS).axes[0].lines[1::2]
    for line, spectrum in zip(lines, small_cube.reflectance(COLOURS), strict=True):
        assert_array_equal(line.get_ydata(), spectrum)
    assert lines[0].get_color() != lines[1].get_color()
