"""The page as text."""

from __future__ import annotations

import json
import re
import tomllib

import numpy as np
import pytest

from tests.helpers import raises
from tests.pages import Page, external_links
from uplift.colorimetry import observer
from uplift.common.errors import OptionError, OutputError
from uplift.lookup import bounds
from uplift.report.look_page import page, write_look_page


def numbers(html):
    return json.loads(re.search(r'id="numbers">(.*?)</script>', html, re.DOTALL)[1])


def test_the_page_is_well_formed_and_self_contained(html):
    assert Page(html).tags.count("figure") == 2
    assert external_links(html) == []
    assert "Content-Security-Policy" in html


def test_its_spectrum_is_the_answer(html, small_cube, found):
    given = numbers(html)
    start = 1 / (1 + np.exp(-np.array(given["start"])))
    np.testing.assert_allclose(start, found[0].reflectance[0], atol=1e-9)
    np.testing.assert_allclose(np.array(given["sensor"]) @ start, given["target"], atol=1e-6)
    assert np.shape(given["basis"]) == (81, 17)
    assert given["rgb"] == "#8a2a20"


def test_regions_are_those_of_the_bounds(html, found):
    for given, each in zip(numbers(html)["lights"], found, strict=True):
        assert given["name"] == each.light.name
        np.testing.assert_allclose(given["region"], each.outline(0), atol=1e-3)
        np.testing.assert_allclose(given["likely"], each.likely(0), atol=1e-3)


def test_colours_without_a_code_are_linear(small_cube, grey):
    assert numbers(page(small_cube, grey))["rgb"] == [0.31, 0.31, 0.31]


def test_cubes_without_an_atlas_have_no_likely_region(plain_cube, red):
    given = numbers(page(plain_cube, [bounds(plain_cube, red, observer.light("A"), divisions=1)]))
    assert given["lights"][0]["likely"] is None


def test_a_page_is_about_one_colour(small_cube):
    two = [bounds(small_cube, np.full((2, 3), 0.4), observer.light("A"), divisions=0)]
    for found in (two, []):
        with raises(OptionError, "page-needs-one-colour"):
            page(small_cube, found)


def test_existing_files_stay(small_cube, grey, tmp_path):
    path = tmp_path / "look.html"
    assert write_look_page(small_cube, grey, path) == path.stat().st_size
    with raises(OutputError, "file-exists"):
        write_look_page(small_cube, grey, path)


@pytest.mark.parametrize("name", ["A", "LED-B3"])
def test_names_of_lights_are_keys_of_toml(name):
    assert tomllib.loads(f"{name} = 1") == {name: 1}
