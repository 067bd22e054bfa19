"""The page in Chromium: input by mouse, touch and keys, and pixels against numpy."""

from __future__ import annotations

import dataclasses
import json
import re

import numpy as np
import pytest

from tests.browsing import check_page
from tests.design.palette.relight_viewer.conftest import arbitrary
from tests.design.palette.relight_viewer.expected import (
    box,
    codes,
    expected_codes,
    largest_difference,
    position,
    shares,
)
from uplift.design.palette.relight_viewer.page import page, start_light


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


@pytest.mark.parametrize(("lights", "materials", "m"), [(1, 1, 3), (2, 3, 5), (5, 9, 12)])
def test_the_picture_initially_shows_the_light_that_separates_materials(opened, lights, materials, m):
    view = arbitrary(lights, materials, m, size=(31, 17))
    tab = opened(view)
    first = np.eye(lights)[start_light(view)]
    assert np.abs(tab.canvas("picture")[..., :3] - expected_codes(view, first)).max() <= 1
    assert tab.errors == []


def test_start_light_separates_materials():
    view = arbitrary(2, 3, 5)
    colours = np.full((3, 2, 3), 0.5)
    colours[0, 1] = 0.1
    view = dataclasses.replace(view, materials=dataclasses.replace(view.materials, colours=colours))
    assert start_light(view) == 1
    assert '"start": 1' in page(view)


def test_the_page_fits_and_is_accessible(view, tmp_path):
    check_page(page(view), tmp_path)


def test_dragging_moves_the_dial_and_relights_the_picture(opened, view):
    tab = opened(view)
    before = tab.canvas("picture")
    drag(tab, (30, 18))
    radius = box(tab, "#dial .rim")[2] / 2
    assert position(tab) == pytest.approx(np.array([30, 18]) / radius, abs=0.02)
    assert largest_difference(tab, view) <= 1
    assert (tab.canvas("picture") != before).any()
    drag(tab, (400, -300))  # outside the rim: clamped to it
    assert position(tab) == pytest.approx([0.8, -0.6], abs=1e-6)
    assert largest_difference(tab, view) <= 1
    assert tab.errors == []


def test_touch_moves_the_dial(opened, view):
    tab = opened(view)
    x, y = centre(tab, "#dial .rim")
    for kind, points in (
        ("touchStart", [{"x": x, "y": y}]),
        ("touchMove", [{"x": x - 40, "y": y + 8}]),
        ("touchEnd", []),
    ):
        tab.call("Input.dispatchTouchEvent", type=kind, touchPoints=points)
    radius = box(tab, "#dial .rim")[2] / 2
    assert position(tab) == pytest.approx(np.array([-40, 8]) / radius, abs=0.02)
    assert largest_difference(tab, view) <= 1


def test_keys_move_the_dial(opened, view):
    tab = opened(view)
    tab.evaluate("document.getElementById('dial').focus()")
    for key, at in (("0", (0, 0)), ("ArrowLeft", (-0.02, 0)), ("ArrowDown", (-0.02, 0.02))):
        tab.key(key)
        assert position(tab) == pytest.approx(at, abs=1e-9)
        assert largest_difference(tab, view) <= 1
    tab.key("ArrowRight", modifiers=8)  # shift
    assert position(tab) == pytest.approx((0.18, 0.02), abs=1e-9)
    tab.key("2")
    assert shares(position(tab), 3) == pytest.approx([0, 1, 0])
    text = tab.evaluate("document.getElementById('dial').getAttribute('aria-valuetext')")
    assert text == "light 0 0 %, light 1 100 %, light 2 0 %"
    tab.key("4")  # no such light
    assert shares(position(tab), 3) == pytest.approx([0, 1, 0])


def test_sliders_scale_their_light_exposure_scales_all_and_reset_restores(opened, view):
    tab = opened(view)
    drag(tab, (-12, 25))
    slide(tab, "gain-0", 40)
    slide(tab, "gain-2", 0)
    slide(tab, "exposure", -1.5)
    assert largest_difference(tab, view, gains=[0.4, 1, 0], stops=-1.5) <= 1
    texts = [tab.evaluate(f"document.getElementById('gain-{row}-text').value") for row in range(3)]
    assert texts == ["40 %", "100 %", "0 %"]
    tab.evaluate("document.getElementById('reset').click()")
    start = np.eye(3)[start_light(view)]
    assert np.abs(tab.canvas("picture")[..., :3] - expected_codes(view, start)).max() <= 1
    assert tab.errors == []


def test_the_name_of_a_light_selects_it_alone(opened, view):
    tab = opened(view)
    slide(tab, "gain-1", 0)
    assert expected_codes(view, [0, 1, 0]).max() > 0
    tab.evaluate("document.querySelector('[data-light=\"1\"]').click()")
    assert np.abs(tab.canvas("picture")[..., :3] - expected_codes(view, [0, 1, 0])).max() <= 1


def test_patches_are_colours_by_full_spectra_and_by_the_factor_model(opened, view):
    tab = opened(view)
    drag(tab, (20, -35))
    mix = shares(position(tab), 3)
    texts = tab.evaluate("[...document.querySelectorAll('[id^=mixed-][id$=text]')].map(found => found.textContent)")
    light = mix @ view.lights.coefficients
    factor = codes(view.materials.coefficients * light @ view.to_rgb.T)
    full = codes(np.einsum("j,njk->nk", mix, view.materials.colours))
    assert len(texts) == 5
    for text, *both in zip(texts[1:], full, factor, strict=True):
        halves = [np.array(list(bytes.fromhex(half[1:7]))) for half in text.split(" | ")]
        assert np.abs(np.array([halves[0], halves[-1]]) - both).max() <= 1
    assert np.abs(np.array(list(bytes.fromhex(texts[0][1:7]))) - codes(mix @ view.lights.white)).max() <= 1


def test_clipped_pixels_are_counted(opened, view):
    tab = opened(view)
    start = start_light(view)
    slide(tab, "exposure", 2)
    tab.canvas("picture")
    linear = view.rgb(4 * np.eye(3)[start])
    clipped = ((linear < -1 / 510) | (linear > 1 + 1 / 510)).any(axis=-1).mean()
    assert clipped > 0.01
    text = tab.evaluate("document.getElementById('clipped').textContent")
    assert float(text.split()[1]) == pytest.approx(100 * clipped, abs=0.1)
    slide(tab, f"gain-{start}", 0)
    tab.canvas("picture")
    assert tab.evaluate("document.getElementById('clipped').textContent") == ""


def test_names_highlight_materials_and_pointing_shows_names(opened, view):
    tab = opened(view)
    tab.evaluate("document.querySelector('[data-material=\"2\"]').click()")
    clear = tab.canvas("mask")[..., 3] == 0
    assert (clear == (view.labels == 3)).all()
    x, y, width, height = box(tab, "#mask")
    row, column = np.argwhere(view.labels == 2)[7]
    tab.mouse("mouseMoved", x + (column + 0.5) * width / 56, y + (row + 0.5) * height / 40)
    assert tab.evaluate("document.getElementById('pointed').textContent") == "material 1"
    tab.evaluate("document.querySelector('[data-material=\"2\"]').click()")
    assert (tab.canvas("mask")[..., 3] == 0).all()


def test_no_resources_are_loaded_and_all_controls_have_names(opened, view):
    tab = opened(view)
    assert tab.evaluate("performance.getEntriesByType('resource').length") == 0
    tree = tab.call("Accessibility.getFullAXTree")["nodes"]
    used = [node for node in tree if node["role"]["value"] in ("slider", "button")]
    assert len(used) == 1 + 3 + 1 + 1 + 3 + 4
    assert all(node["name"]["value"] for node in used)


def test_the_comparison_detects_a_wrong_matrix(opened, view):
    tab = opened(dataclasses.replace(view, to_rgb=view.to_rgb[[1, 0, 2]]))
    assert largest_difference(tab, view) > 1
    tab = opened(dataclasses.replace(view, to_rgb=view.to_rgb * 1.02))
    assert largest_difference(tab, view) > 1


def test_console_errors_are_recorded(tab, view, tmp_path):
    html = page(view)
    script = "<script>console.error('broken', 1); setTimeout(() => { throw new Error('torn'); })</script></body>"
    html = re.sub('<meta http-equiv="Content-Security-Policy".*?>', "", html)
    (tmp_path / "page.html").write_text(html.replace("</body>", script), encoding="utf-8")
    tab.open(tmp_path / "page.html")
    tab.canvas("picture")
    assert len(tab.errors) == 2
    assert "broken" in json.dumps(tab.errors)
    assert "torn" in json.dumps(tab.errors)
