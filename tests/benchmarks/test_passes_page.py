"""The page that renders a room in two passes: its contents, and in Chromium its
pictures.
"""

import json
import re
import time

import numpy as np
import pytest

from benchmarks.passes_page import page
from tests.browsing import check_page, shared_tab
from tests.conftest import MACBETH
from tests.helpers import raises
from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import read_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.common.errors import OptionError
from uplift.extras.scene.passes.bands import PRESETS
from uplift.extras.scene.passes.choice import fit_bands
from uplift.extras.scene.passes.materials import library_materials

SIZE = 64
LIGHTS = ("D65", "FL2", "HP1")


@pytest.fixture(scope="module")
def checker():
    """Reflectances (24, 81) of the ColorChecker."""
    return on_grid(read_atlas(MACBETH), observer.grid())


@pytest.fixture(scope="module")
def library():
    """Materials of the shipped sets."""
    return library_materials()


@pytest.fixture(scope="module")
def passes(library):
    """Two passes of three lights."""
    return fit_bands(PRESETS[2], library, LIGHTS)


@pytest.fixture(scope="module")
def html(passes, checker):
    """A small page."""
    return page(passes, checker, SIZE)


def numbers(html):
    (text,) = re.findall(r'id="numbers">(.*?)</script>', html, re.DOTALL)
    return json.loads(text)


def test_numbers_of_the_page_decode(html, checker):
    """White of each light, and the ColorChecker under it, have nearly their colours."""
    values = numbers(html)
    decoding = np.concatenate(values["decoding"], axis=1)
    surfaces = np.concatenate(values["surfaces"][:2], axis=1)
    for row, name in enumerate(LIGHTS):
        light = observer.light(name)
        lit = surfaces * values["lights"][row]
        decoded = lit @ decoding.T @ observer.sensor().rgb_to_xyz.T
        expected = checker @ light.xyz.T
        errors = delta_e_2000(lab(decoded, light.white), lab(expected, light.white))
        assert errors.mean() < 1


def test_other_passes_are_refused(library, checker, passes):
    with raises(OptionError):
        page(fit_bands(PRESETS[1], library, LIGHTS), checker)
    with raises(OptionError):
        page(fit_bands(PRESETS[2], library, LIGHTS[:1]), checker)
    with raises(OptionError):
        page(passes, checker[:23])


@pytest.fixture(scope="module")
def tab(html, tmp_path_factory):
    """The page in Chromium."""
    tab = shared_tab()
    path = tmp_path_factory.mktemp("page") / "page.html"
    path.write_text(html, encoding="utf-8")
    tab.window(1000, 800)
    tab.open(path)
    if tab.evaluate("document.getElementById('picture').hidden"):
        pytest.skip("the browser has no WebGL 2 with float textures")
    return tab


def picture(tab, light, mix):
    """Codes (height, width, 3) with a border at the left and at the right end."""
    pictures = []
    for split in (0, 1):
        settings = {"lamp": light, "mix": mix, "split": split}
        for name, value in settings.items():
            tab.evaluate(f"document.getElementById('{name}').value = {value}")
        tab.evaluate(
            "document.getElementById('mix').dispatchEvent(new Event('input')), 0"
        )
        pictures.append(tab.canvas("picture")[..., :3].astype(float))
    return pictures


def test_both_sides_agree_by_day_and_differ_under_a_sodium_lamp(tab):
    end = time.monotonic() + 60
    samples = "document.getElementById('samples').textContent.split(': ')[1]"
    while int(tab.evaluate(samples) or 0) < 10:
        assert time.monotonic() < end
        time.sleep(0.1)
    middle = np.s_[8:-8, 8:-8]
    passes, rgb = picture(tab, 2, 0)
    day = np.abs(passes - rgb)[middle].mean()
    assert passes[middle].std() > 20
    passes, rgb = picture(tab, 2, 1)
    sodium = np.abs(passes - rgb)[middle].mean()
    assert sodium > 2 * day
    assert tab.errors == []


def test_the_page_fits_and_is_accessible(html, tmp_path):
    check_page(html, tmp_path)
