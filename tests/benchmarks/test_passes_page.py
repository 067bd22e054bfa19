"""The page that renders a room in two passes."""

import json
import re

import numpy as np

from benchmarks.passes_page import page
from tests.browsing import check_page
from tests.conftest import MACBETH
from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import read_atlas
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.extras.scene.passes.bands import PRESETS
from uplift.extras.scene.passes.choice import fit_bands
from uplift.extras.scene.passes.materials import library_materials

LIGHTS = ("D65", "FL2", "HP1")


def test_numbers_of_the_page_decode_and_it_is_accessible(tmp_path):
    """The ColorChecker under each light has nearly its colours."""
    checker = on_grid(read_atlas(MACBETH), observer.grid())
    passes = fit_bands(PRESETS[2], library_materials(), LIGHTS)
    html = page(passes, checker, 64)
    (text,) = re.findall(r'id="numbers">(.*?)</script>', html, re.DOTALL)
    values = json.loads(text)
    decoding = np.concatenate(values["decoding"], axis=1)
    surfaces = np.concatenate(values["surfaces"][:2], axis=1)
    for row, name in enumerate(LIGHTS):
        light = observer.light(name)
        lit = surfaces * values["lights"][row]
        decoded = lit @ decoding.T @ observer.sensor().rgb_to_xyz.T
        expected = checker @ light.xyz.T
        errors = delta_e_2000(lab(decoded, light.white), lab(expected, light.white))
        assert errors.mean() < 1
    check_page(html, tmp_path)
