"""What the page holds, read without a browser."""

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
from tests.design.palette.relight_viewer.seen import codes, wanted
from uplift.colorimetry.srgb import encode
from uplift.common.errors import OptionError
from uplift.design.palette import Palette, design
from uplift.design.palette.lights import illuminant
from uplift.design.palette.palette import SpectrumSpec
from uplift.design.palette.relight_viewer.cutaway import cutaway
from uplift.design.palette.relight_viewer.packing import halves, packed
from uplift.design.palette.relight_viewer.page import page
from uplift.design.palette.relight_viewer.relighting import MOST, relighting


def script(text, name):
    return re.search(rf'<script type="[^"]*" id="{name}">(.*?)</script>', text, re.DOTALL)[1]


def unpacked(text, kind):
    """As the page's script does it."""
    planes = np.frombuffer(zlib.decompress(base64.b64decode(text)), np.uint8)
    return np.ascontiguousarray(planes.reshape(np.dtype(kind).itemsize, -1).T).view(kind).ravel()


def test_the_numbers_in_the_page_make_the_picture(shown):
    text = page(shown)
    numbers = json.loads(script(text, "numbers"))
    coefficients = unpacked(script(text, "pixels"), "<f2").reshape(*shown.weights.shape[:2], -1)
    mix = [0.2, 0.5, 0.3]
    light = np.array(mix) @ np.array(numbers["light"])
    seen = codes((coefficients.astype(float) * light) @ np.array(numbers["toRgb"]).T)
    assert np.abs(seen - wanted(shown, mix)).max() <= 1
    assert (unpacked(script(text, "labels"), "u1") == shown.labels.ravel()).all()
    assert numbers["materials"] == list(shown.materials.names)


def test_the_relighting_s_own_colours_are_those_of_the_plain_formula(shown):
    assert np.abs(codes(shown.rgb([0.1, 0.7, 0.4])) - wanted(shown, [0.1, 0.7, 0.4])).max() <= 1


@pytest.mark.parametrize("kind", ["<f2", "u1", "<f4"])
def test_packing_loses_nothing(kind):
    values = np.random.default_rng(0).integers(0, 200, 1001).astype(kind)
    assert (unpacked(packed(values), kind) == values).all()


def test_half_precision_is_finer_than_a_code():
    linear = np.linspace(0, 1, 4001)
    assert 255 * np.abs(encode(halves(linear)) - encode(linear)).max() < 0.06


def test_labels_are_what_a_pixel_shows_most_of(shown):
    for place in ((0, 0), (20, 30), (39, 55)):
        weights = shown.weights[place]
        assert shown.labels[place] == (1 + weights.tolist().index(max(weights)) if weights.any() else 0)


def test_the_page_needs_nothing_else_and_is_the_same_again(shown):
    text = page(shown)
    assert not re.search(r"""(?:src|href)=["'](?!#)|url\(|@import|https?://(?!www\.w3\.org/2000/svg)""", text)
    assert page(arbitrary()) == text


def test_names_cannot_break_the_page():
    name = "</script><b>&\"'"
    shown = arbitrary(title=name)
    shown = dataclasses.replace(
        shown,
        materials=dataclasses.replace(shown.materials, names=(name, "a", "b", "c")),
        lights=dataclasses.replace(shown.lights, names=(name, "d", "e")),
    )
    text = page(shown)
    assert text.count("</script>") == page(arbitrary()).count("</script>")
    assert name not in text.replace(html.escape(name), "")
    assert json.loads(script(text, "numbers"))["lights"][0] == name


def test_nothing_that_is_not_finite_gets_into_a_page(shown):
    lights = dataclasses.replace(shown.lights, power=np.full_like(shown.lights.power, np.nan))
    with pytest.raises(ValueError, match="JSON"):
        page(dataclasses.replace(shown, lights=lights))


def test_a_palette_s_picture_looks_as_its_spectra_do(model, sensor, small_cube):
    """Under smooth lights the picture is what whole spectra would give, but for the factor model's small error."""
    colours = {"red": (0.5, 0.1, 0.1), "leaf": (0.1, 0.3, 0.05), "sky": (0.2, 0.4, 0.7)}
    materials = [
        SpectrumSpec(name, small_cube.reflectance(rgb, sensor.wavelengths)) for name, rgb in colours.items()
    ]
    lights = [SpectrumSpec(name, illuminant(sensor, name)) for name in ("D65", "A")]
    palette = Palette(sensor, tuple(lights), tuple(materials), (), {})
    found = relighting("three", design(palette, model), cutaway(3, size=64))
    mix = np.array([0.6, 0.4])
    whole = found.weights @ np.einsum("j,njk->nk", mix, found.materials.colours)
    assert np.abs(found.rgb(mix) - whole).max() < 0.02
    assert found.materials.names == tuple(colours)
    assert found.materials.colours[0, 0] == pytest.approx(np.array(colours["red"]), abs=1e-3)
    assert found.lights.white[0] == pytest.approx([1, 1, 1], abs=1e-3)


def test_more_materials_than_labels_are_refused(model, sensor):
    flat = np.ones_like(sensor.wavelengths)
    many = tuple(SpectrumSpec(str(row), flat) for row in range(MOST + 1))
    found = design(Palette(sensor, (SpectrumSpec("E", flat),), many, (), {}), model)
    with pytest.raises(OptionError, match="256 materials"):
        relighting("many", found, np.zeros((1, 1, MOST + 1), np.float32))
