"""What texts state about scale and unit of wavelengths, and what they do not."""

import numpy as np
import pytest

from uplift.extras.formats.quantities import TABLE
from uplift.extras.formats.statements import (
    WAVE_NUMBER,
    find_unit,
    is_plain,
    label_scale,
    remark_scale,
    remark_unit,
    unit_by_values,
)


def divisor(scale):
    return None if scale is None else scale.divisor


@pytest.mark.parametrize(
    ("texts", "expected"),
    [
        ("Reflect. %|(%R)|%R|R% 400|R [%]|R_pct|reflectance in percent|0-100", 100),
        ("ochre [%]|Reflectance factor [%]", 100),
        ("R-factor|Reflectance factor|fraction|R (0-1)|0..1|in [0, 1]|0 to 1", 1),
        ("Reflectance × 10,000|R (x10000)|scale factor: 0.0001", 1e4),
        ("50% grey|grey 50 %|Reflectance|2020-01-01|scale factor 10|fraction 3", None),
    ],
)
def test_scales_of_labels(texts, expected):
    found = {divisor(label_scale(text.replace("_", " "))) for text in texts.split("|")}
    assert found == {expected}


@pytest.mark.parametrize(
    ("texts", "expected"),
    [
        ("Units: % Reflectance|Y Units: Reflectance (percentage)|in %|%|percent", 100),
        ("Reflectance as a fraction", 1),
        ("Humidity: 45 %|Relative humidity (%)|Gloss [%]|Battery level %", None),
    ],
)
def test_scales_of_remarks(texts, expected):
    found = {divisor(remark_scale(text)) for text in texts.split("|")}
    assert found == {expected}


@pytest.mark.parametrize(
    ("texts", "expected"),
    [
        ("Wavelength (nm)|[nm]|Wavelength nm.|WavelengthNM", 1),
        ("Wavelength_um|λ/µm|microns", 1e3),
        ("Wavelength (A)|angstroms", 0.1),
        ("cm-1|Wavenumber (cm⁻¹)|1/cm", WAVE_NUMBER),
        ("wavelength [m]", 1e9),
        ("umber|name|Mean", None),
    ],
)
def test_units(texts, expected):
    assert set(map(find_unit, texts.split("|"))) == {expected}


def test_examples_of_units_are_found():
    for row in TABLE["unit"]:
        found = set(map(find_unit, row["examples"].split(", ")))
        assert found == {row["nm"]}, row


def test_units_of_remarks_are_about_wavelengths():
    others = ["Aperture: 8 mm", "Slit: 10 µm"]
    assert remark_unit(others) is None
    assert remark_unit([*others, "X Units: Wavelength (micrometers)"]) == 1e3


def test_units_by_values_need_an_order():
    wavelengths = np.linspace(0.35, 2.5, 50)
    assert unit_by_values(wavelengths[::-1]) == 1e3
    assert unit_by_values(np.random.default_rng(0).permutation(wavelengths)) == 1.0


def test_labels_without_a_name():
    plain = ["Reflectance", "R [%]", "%R", "[counts]", "Reflect. %", "value"]
    names = ["ochre", "R1", "G", "", "Sample reflectance"]
    assert list(filter(is_plain, plain + names)) == plain
