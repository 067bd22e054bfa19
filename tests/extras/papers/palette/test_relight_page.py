"""The relighting page: its contents, and in Chromium input by mouse, touch and keys,
and pixels against numpy.
"""

import base64
import json
import re
import zlib

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


def arbitrary(lights=3, materials=4, m=7, size=(40, 56), title="Arbitrary"):
    """Relighting with empty rows of pixels, and with colours inside and outside the
    display gamut.
    """
    draw = np.random.default_rng(lights + 10 * materials + 100 * m)
    weights = draw.dirichlet(np.full(materials, 0.3), size) * draw.uniform(
        0, 1, (*size, 1)
    )
    weights[:5] = 0
    power = draw.uniform(0.2, 1.5, (lights, 21))
    return Relighting(
        title=title,
        weights=weights.astype(np.float32),
        materials=tuple(f"material {row}" for row in range(materials)),
        material_coefficients=draw.uniform(0, 1, (materials, m)),
        colours=draw.uniform(-0.05, 1.05, (materials, lights, 3)),
        lights=tuple(f"light {row}" for row in range(lights)),
        light_coefficients=draw.uniform(0.3, 1.4, (lights, m)),
        power=power,
        white=draw.uniform(0.2, 1, (lights, 3)),
        to_rgb=draw.normal(1 / m, 0.15, (3, m)),
        wavelengths=np.linspace(400, 700, 21),
    )


@pytest.fixture(scope="module")
def view():
    return arbitrary()


@pytest.fixture
def tab():
    tab = shared_tab()
    tab.window(1200, 1100)
    return tab


@pytest.fixture
def opened(tab, tmp_path):
    """A function that shows a page in the browser."""

    def show(view):
        (tmp_path / "page.html").write_text(page(view), encoding="utf-8")
        tab.open(tmp_path / "page.html")
        return tab

    return show


def position(tab):
    """(x, y) of the handle, in radii of the dial."""
    tab.evaluate(
        "new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => "
        "done(1))))"
    )
    value = tab.evaluate("document.getElementById('handle').getAttribute('transform')")
    return (
        np.array(
            value.removeprefix("translate(").removesuffix(")").split(), dtype=float
        )
        / DISC
    )


def box(tab, selector):
    """x, y, width and height of an element in the window."""
    value = tab.evaluate(
        f"document.querySelector('{selector}').getBoundingClientRect().toJSON()"
    )
    return [value[name] for name in ("x", "y", "width", "height")]


def rim_positions(lights):
    """(L, 2) the first light at the top, the others clockwise."""
    turn = 2 * np.pi * np.arange(lights) / lights
    return np.stack([np.sin(turn), -np.cos(turn)], axis=1)


def shares(at, lights):
    """(L,) by the inverse square of the distance."""
    squares = ((rim_positions(lights) - at) ** 2).sum(axis=1)
    if squares.min() < 1e-12:
        return (squares == squares.min()).astype(float)
    return 1 / squares / (1 / squares).sum()


def codes(linear):
    """8-bit sRGB."""
    return np.rint(255 * encode(linear))


def expected_codes(view, mix, stops=0.0):
    """(H, W, 3) 8-bit codes: the light's coefficients times each pixel's, then the
    matrix; the background is grey.
    """
    light = np.asarray(mix) @ view.light_coefficients
    signals = view.weights.astype(float) @ view.material_coefficients * light
    lit = 2.0**stops * signals @ view.to_rgb.T
    return codes(np.where(view.labels[..., None], lit, 0.025))


def largest_difference(tab, view, gains=1.0, stops=0.0):
    """The largest difference in 8-bit codes between the displayed and the expected
    picture.
    """
    mix = shares(position(tab), len(view.lights)) * gains
    pixels = tab.canvas("picture")
    assert (pixels[..., 3] == 255).all()
    return np.abs(pixels[..., :3] - expected_codes(view, mix, stops)).max()


def script(text, name):
    return re.search(
        rf'<script type="[^"]*" id="{name}">(.*?)</script>', text, re.DOTALL
    )[1]


def unpacked(text, kind):
    """Inverse of packing, as in the script of the page."""
    planes = np.frombuffer(zlib.decompress(base64.b64decode(text)), np.uint8)
    return (
        np.ascontiguousarray(planes.reshape(np.dtype(kind).itemsize, -1).T)
        .view(kind)
        .ravel()
    )


def test_the_numbers_of_the_page_give_the_picture(view):
    text = page(view)
    numbers = json.loads(script(text, "numbers"))
    coefficients = unpacked(script(text, "pixels"), "<f2").reshape(
        *view.weights.shape[:2], -1
    )
    mix = [0.2, 0.5, 0.3]
    light = np.array(mix) @ np.array(numbers["light"])
    pixels = codes((coefficients.astype(float) * light) @ np.array(numbers["toRgb"]).T)
    is_lit = view.labels > 0
    assert np.abs(pixels - expected_codes(view, mix))[is_lit].max() <= 1
    assert (unpacked(script(text, "labels"), "u1") == view.labels.ravel()).all()
    assert numbers["materials"] == list(view.materials)


def test_the_picture_agrees_with_full_spectra(model, sensor, small_cube):
    """Under smooth lights they differ by the small error of the factor model."""
    colours = {"red": (0.5, 0.1, 0.1), "leaf": (0.1, 0.3, 0.05), "sky": (0.2, 0.4, 0.7)}
    materials = [
        SpectrumSpec(name, small_cube.reflectance(rgb, sensor.wavelengths))
        for name, rgb in colours.items()
    ]
    lights = [SpectrumSpec(name, illuminant(sensor, name)) for name in ("D65", "A")]
    palette = Palette(sensor, tuple(lights), tuple(materials), (), {})
    found = relighting("three", design(palette, model), cutaway(3, size=64))
    mix = np.array([0.6, 0.4])
    full = found.weights @ np.einsum("j,njk->nk", mix, found.colours)
    assert np.abs(found.rgb(mix) - full).max() < 0.02
    assert found.materials == tuple(colours)
    assert found.colours[0, 0] == pytest.approx(np.array(colours["red"]), abs=1e-3)
    assert found.white[0] == pytest.approx([1, 1, 1], abs=1e-3)


def centre(tab, selector):
    x, y, width, height = box(tab, selector)
    return x + width / 2, y + height / 2


def drag(tab, offset):
    """Drag from the centre of the dial by ``offset`` pixels."""
    x, y = centre(tab, "#dial .rim")
    tab.mouse("mousePressed", x, y)
    tab.mouse("mouseMoved", x + offset[0], y + offset[1])
    tab.mouse("mouseReleased", x + offset[0], y + offset[1])


def slide(tab, slider, value):
    found = f"document.getElementById('{slider}')"
    tab.evaluate(f"{found}.value = {value}; {found}.dispatchEvent(new Event('input'))")


@pytest.mark.parametrize(("lights", "materials", "m"), [(1, 1, 3), (5, 9, 12)])
def test_the_picture_initially_shows_the_light_that_separates_materials(
    opened, lights, materials, m
):
    view = arbitrary(lights, materials, m, size=(31, 17))
    tab = opened(view)
    assert (
        np.abs(
            tab.canvas("picture")[..., :3]
            - expected_codes(view, np.eye(lights)[view.start_light])
        ).max()
        <= 1
    )


def test_the_page_fits_and_is_accessible(view, tmp_path):
    check_page(page(view), tmp_path)


def test_dragging_by_mouse_and_touch_moves_the_dial_and_relights_the_picture(
    opened, view
):
    tab = opened(view)
    drag(tab, (30, 18))
    radius = box(tab, "#dial .rim")[2] / 2
    assert position(tab) == pytest.approx(np.array([30, 18]) / radius, abs=0.02)
    assert largest_difference(tab, view) <= 1
    drag(tab, (400, -300))  # outside the rim: clamped to it
    assert position(tab) == pytest.approx([0.8, -0.6], abs=1e-6)
    assert largest_difference(tab, view) <= 1
    x, y = centre(tab, "#dial .rim")
    for kind, offsets in (
        ("touchStart", [(0, 0)]),
        ("touchMove", [(-40, 8)]),
        ("touchEnd", []),
    ):
        tab.call(
            "Input.dispatchTouchEvent",
            type=kind,
            touchPoints=[{"x": x + dx, "y": y + dy} for dx, dy in offsets],
        )
    assert position(tab) == pytest.approx(np.array([-40, 8]) / radius, abs=0.02)
    assert largest_difference(tab, view) <= 1
    assert tab.errors == []


def test_keys_move_the_dial(opened, view):
    tab = opened(view)
    tab.evaluate("document.getElementById('dial').focus()")
    for key, at in (
        ("0", (0, 0)),
        ("ArrowLeft", (-0.02, 0)),
        ("ArrowDown", (-0.02, 0.02)),
    ):
        tab.key(key)
        assert position(tab) == pytest.approx(at, abs=1e-9)
    tab.key("ArrowRight", modifiers=8)  # shift
    assert position(tab) == pytest.approx((0.18, 0.02), abs=1e-9)
    tab.key("2")
    assert largest_difference(tab, view) <= 1
    text = tab.evaluate(
        "document.getElementById('dial').getAttribute('aria-valuetext')"
    )
    assert text == "light 0 0 %, light 1 100 %, light 2 0 %"
    assert (
        tab.evaluate("document.getElementById('share-1').textContent")
        == "100 % of the mix"
    )
    assert "%" not in tab.evaluate(
        "document.getElementById('gain-0-text').value"
    )  # not the share of the mix


def test_sliders_scale_their_light_exposure_scales_all_and_reset_restores(opened, view):
    tab = opened(view)
    drag(tab, (-12, 25))
    for slider, value in (("gain-0", 40), ("gain-2", 0), ("exposure", -1.5)):
        slide(tab, slider, value)
    assert largest_difference(tab, view, gains=[0.4, 1, 0], stops=-1.5) <= 1
    slide(tab, "exposure", 2)
    tab.evaluate("document.querySelector('[data-light=\"1\"]').click()")
    pixels = tab.canvas("picture")[..., :3]
    mix = np.array([0, 1, 0])
    assert np.abs(pixels - expected_codes(view, mix, 2)).max() <= 1
    linear = view.rgb(4 * mix)
    clipped = ((linear < -1 / 510) | (linear > 1 + 1 / 510)).any(axis=-1).mean()
    assert clipped > 0.01
    text = tab.evaluate("document.getElementById('clipped').textContent")
    assert float(text.split()[1]) == pytest.approx(100 * clipped, abs=0.1)
    tab.evaluate("document.getElementById('reset').click()")
    assert (
        np.abs(
            tab.canvas("picture")[..., :3]
            - expected_codes(view, np.eye(3)[view.start_light])
        ).max()
        <= 1
    )
    assert tab.errors == []
