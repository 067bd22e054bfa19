"""The relighting page: its contents, and in Chromium input by mouse, touch and keys,
and pixels against numpy.
"""

import re

import numpy as np
import pytest

from tests.browsing import check_page, shared_tab
from uplift.extras.colour.srgb import encode
from uplift.extras.papers.palette.colours import illuminant
from uplift.extras.papers.palette.design import design
from uplift.extras.papers.palette.palette import Palette, SpectrumSpec
from uplift.extras.papers.palette.picture import cutaway
from uplift.extras.papers.palette.relight_page import Relighting, page, relighting

DISC = 84


def arbitrary():
    """Relighting with empty rows of pixels, and with colours inside and outside the
    display gamut.
    """
    draw = np.random.default_rng(3)
    weights = draw.dirichlet(np.full(4, 0.3), (31, 17)) * draw.random((31, 17, 1))
    weights[:5] = 0
    return Relighting(
        title="Arbitrary",
        weights=weights.astype(np.float32),
        materials=("one", "two", "three", "four"),
        material_coefficients=draw.uniform(0, 1, (4, 7)),
        colours=draw.uniform(-0.05, 1.05, (4, 3, 3)),
        lights=("day", "lamp", "night"),
        light_coefficients=draw.uniform(0.3, 1.4, (3, 7)),
        power=draw.uniform(0.2, 1.5, (3, 21)),
        white=draw.uniform(0.2, 1, (3, 3)),
        to_rgb=draw.normal(1 / 7, 0.15, (3, 7)),
        wavelengths=np.linspace(400, 700, 21),
    )


VIEW = arbitrary()


@pytest.fixture
def tab(tmp_path):
    """The page in the browser."""
    (tmp_path / "page.html").write_text(page(VIEW), encoding="utf-8")
    tab = shared_tab()
    tab.window(1200, 1100)
    tab.open(tmp_path / "page.html")
    return tab


def position(tab):
    """(x, y) of the handle, in radii of the dial."""
    tab.evaluate(
        "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => "
        "done(1))))"
    )
    value = tab.evaluate("document.getElementById('handle').getAttribute('transform')")
    return np.array(re.findall(r"[-.\de]+(?=[ )])", value), dtype=float) / DISC


def shares(at):
    """(3,) by the inverse square of the distance to lights on the rim, the first one at
    the top, the others clockwise.
    """
    turn = 2 * np.pi * np.arange(3) / 3
    rim = np.stack([np.sin(turn), -np.cos(turn)], axis=1)
    near = 1 / ((rim - at) ** 2).sum(axis=1)
    return near / near.sum()


def check_picture(tab, mix, stops=0.0):
    """Compare 8-bit codes: the light's coefficients times each pixel's, then the
    matrix; the background is grey.
    """
    light = mix @ VIEW.light_coefficients
    signals = VIEW.weights.astype(float) @ VIEW.material_coefficients * light
    lit = 2.0**stops * signals @ VIEW.to_rgb.T
    expected = 255 * encode(np.where(VIEW.labels[..., None], lit, 0.025))
    pixels = tab.canvas("picture")
    assert (pixels[..., 3] == 255).all()
    assert np.abs(pixels[..., :3] - np.rint(expected)).max() <= 1
    assert tab.errors == []


def test_the_picture_agrees_with_full_spectra(model, sensor, small_cube):
    """Under smooth lights they differ by the small error of the factor model."""
    colours = np.array([[0.5, 0.1, 0.1], [0.1, 0.3, 0.05], [0.2, 0.4, 0.7]])
    spectra = small_cube.reflectance(colours, sensor.wavelengths)
    materials = tuple(map(SpectrumSpec, ("red", "leaf", "sky"), spectra))
    lights = tuple(
        SpectrumSpec(name, illuminant(sensor, name)) for name in ("D65", "A")
    )
    palette = Palette(sensor, lights, materials, (), {})
    found = relighting("three", design(palette, model), cutaway(3, size=64))
    mix = np.array([0.6, 0.4])
    full = found.weights @ np.einsum("j,njk->nk", mix, found.colours)
    assert np.abs(found.rgb(mix) - full).max() < 0.02
    assert found.materials == ("red", "leaf", "sky")
    assert found.colours[:, 0] == pytest.approx(colours, abs=1e-3)
    assert found.white[0] == pytest.approx([1, 1, 1], abs=1e-3)


def test_the_page_fits_and_is_accessible(tmp_path):
    check_page(page(VIEW), tmp_path)


def test_dragging_by_mouse_and_touch_moves_the_dial_and_relights_the_picture(tab):
    x, y, width, _ = tab.evaluate(
        "Object.values(document.querySelector('#dial .rim').getBoundingClientRect()"
        ".toJSON())"
    )[:4]
    radius = width / 2
    middle = np.array([x, y]) + radius

    def mouse(offset):
        tab.mouse("mousePressed", *middle)
        tab.mouse("mouseMoved", *(middle + offset))
        tab.mouse("mouseReleased", *(middle + offset))

    def touch(offset):
        for kind, at in (("Start", middle), ("Move", middle + offset)):
            points = [{"x": at[0], "y": at[1]}]
            tab.call(
                "Input.dispatchTouchEvent", type=f"touch{kind}", touchPoints=points
            )
        tab.call("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])

    outside = (400, -300)  # clamped to the rim
    for drag, offset in ((mouse, (30, 18)), (mouse, outside), (touch, (-40, 8))):
        drag(offset)
        at = np.array(offset) / max(radius, np.hypot(*offset))
        assert position(tab) == pytest.approx(at, abs=0.02)
        check_picture(tab, shares(position(tab)))
