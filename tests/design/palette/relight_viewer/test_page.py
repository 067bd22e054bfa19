"""Contents of the page without a browser."""

from __future__ import annotations

import base64
import dataclasses
import html
import json
import re
import zlib

import numpy as np
import pytest

from tests.design.palette.relight_viewer.conftest import arbitrary
from tests.design.palette.relight_viewer.expected import codes, expected_codes
from tests.helpers import raises
from uplift.colorimetry.srgb import encode
from uplift.common.errors import OptionError
from uplift.design.palette import Palette, design
from uplift.design.palette.lights import illuminant
from uplift.design.palette.palette import SpectrumSpec
from uplift.design.palette.relight_viewer.cutaway import cutaway
from uplift.design.palette.relight_viewer.packing import pack, to_half
from uplift.design.palette.relight_viewer.page import page
from uplift.design.palette.relight_viewer.relighting import MAX_MATERIALS, relighting


def script(text, name):
    return re.search(rf'<script type="[^"]*" id="{name}">(.*?)</script>', text, re.DOTALL)[1]


def unpacked(text, kind):
    """Inverse of packing, as in the script of the page."""
    planes = np.frombuffer(zlib.decompress(base64.b64decode(text)), np.uint8)
    return np.ascontiguousarray(planes.reshape(np.dtype(kind).itemsize, -1).T).view(kind).ravel()


def test_the_numbers_of_the_page_give_the_picture(view):
    text = page(view)
    numbers = json.loads(script(text, "numbers"))
    coefficients = unpacked(script(text, "pixels"), "<f2").reshape(*view.weights.shape[:2], -1)
    mix = [0.2, 0.5, 0.3]
    light = np.array(mix) @ np.array(numbers["light"])
    pixels = codes((coefficients.astype(float) * light) @ np.array(numbers["toRgb"]).T)
    assert np.abs(pixels - expected_codes(view, mix)).max() <= 1
    assert (unpacked(script(text, "labels"), "u1") == view.labels.ravel()).all()
    assert numbers["materials"] == list(view.materials.names)


def test_relighting_rgb_agrees_with_the_plain_formula(view):
    assert np.abs(codes(view.rgb([0.1, 0.7, 0.4])) - expected_codes(view, [0.1, 0.7, 0.4])).max() <= 1


@pytest.mark.parametrize("kind", ["<f2", "u1", "<f4"])
def test_packing_is_lossless(kind):
    values = np.random.default_rng(0).integers(0, 200, 1001).astype(kind)
    assert (unpacked(pack(values), kind) == values).all()


def test_half_precision_is_finer_than_8_bit_codes():
    linear = np.linspace(0, 1, 4001)
    assert 255 * np.abs(encode(to_half(linear)) - encode(linear)).max() < 0.06


def test_labels_are_the_predominant_materials(view):
    for place in ((0, 0), (20, 30), (39, 55)):
        weights = view.weights[place]
        assert view.labels[place] == (1 + weights.tolist().index(max(weights)) if weights.any() else 0)


def test_the_page_is_self_contained_and_reproducible(view):
    text = page(view)
    assert not re.search(r"""(?:src|href)=["'](?!#)|url\(|@import|https?://(?!www\.w3\.org/2000/svg)""", text)
    assert page(arbitrary()) == text


def test_names_cannot_break_the_page():
    name = "</script><b>&\"'"
    view = arbitrary(title=name)
    view = dataclasses.replace(
        view,
        materials=dataclasses.replace(view.materials, names=(name, "a", "b", "c")),
        lights=dataclasses.replace(view.lights, names=(name, "d", "e")),
    )
    text = page(view)
    assert text.count("</script>") == page(arbitrary()).count("</script>")
    assert name not in text.replace(html.escape(name), "")
    assert json.loads(script(text, "numbers"))["lights"][0] == name


def test_a_page_has_no_numbers_that_are_not_finite(view):
    lights = dataclasses.replace(view.lights, power=np.full_like(view.lights.power, np.nan))
    with pytest.raises(ValueError, match="JSON"):
        page(dataclasses.replace(view, lights=lights))


def test_the_picture_agrees_with_full_spectra(model, sensor, small_cube):
    """Under smooth lights they differ by the small error of the factor model."""
    colours = {"red": (0.5, 0.1, 0.1), "leaf": (0.1, 0.3, 0.05), "sky": (0.2, 0.4, 0.7)}
    materials = [SpectrumSpec(name, small_cube.reflectance(rgb, sensor.wavelengths)) for name, rgb in colours.items()]
    lights = [SpectrumSpec(name, illuminant(sensor, name)) for name in ("D65", "A")]
    palette = Palette(sensor, tuple(lights), tuple(materials), (), {})
    found = relighting("three", design(palette, model), cutaway(3, size=64))
    mix = np.array([0.6, 0.4])
    full = found.weights @ np.einsum("j,njk->nk", mix, found.materials.colours)
    assert np.abs(found.rgb(mix) - full).max() < 0.02
    assert found.materials.names == tuple(colours)
    assert found.materials.colours[0, 0] == pytest.approx(np.array(colours["red"]), abs=1e-3)
    assert found.lights.white[0] == pytest.approx([1, 1, 1], abs=1e-3)


def test_too_many_materials_are_refused(model, sensor):
    flat = np.ones_like(sensor.wavelengths)
    many = tuple(SpectrumSpec(str(row), flat) for row in range(MAX_MATERIALS + 1))
    found = design(Palette(sensor, (SpectrumSpec("E", flat),), many, (), {}), model)
    with raises(OptionError, "too-many-materials"):
        relighting("many", found, np.zeros((1, 1, MAX_MATERIALS + 1), np.float32))
