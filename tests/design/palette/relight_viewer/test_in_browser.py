"""The page as people use it: real input in Chromium, pixels against plain numpy."""

from __future__ import annotations

import dataclasses
import json

import numpy as np
import pytest

from tests.design.palette.relight_viewer.conftest import arbitrary
from tests.design.palette.relight_viewer.seen import apart, box, codes, position, shares, wanted
from uplift.design.palette.relight_viewer.page import page


def centre(tab, selector):
    x, y, width, height = box(tab, selector)
    return x + width / 2, y + height / 2


def drag(tab, way):
    """Drag from the dial's middle by ``way`` pixels."""
    x, y = centre(tab, "#dial .rim")
    tab.mouse("mousePressed", x, y)
    tab.mouse("mouseMoved", x + way[0], y + way[1])
    tab.mouse("mouseReleased", x + way[0], y + way[1])


def slide(tab, slider, value):
    found = f"document.getElementById('{slider}')"
    tab.evaluate(f"{found}.value = {value}; {found}.dispatchEvent(new Event('input'))")


@pytest.mark.parametrize(("lights", "materials", "m"), [(1, 1, 3), (2, 3, 5), (5, 9, 12)])
def test_the_picture_is_lit_by_the_first_light_to_begin_with(opened, lights, materials, m):
    shown = arbitrary(lights, materials, m, size=(31, 17))
    tab = opened(shown)
    first = np.eye(lights)[0]
    assert np.abs(tab.canvas("picture")[..., :3] - wanted(shown, first)).max() <= 1
    assert tab.errors == []


def test_the_dial_follows_the_mouse_and_the_pixels_follow_the_dial(opened, shown):
    tab = opened(shown)
    before = tab.canvas("picture")
    drag(tab, (30, 18))
    radius = box(tab, "#dial .rim")[2] / 2
    assert position(tab) == pytest.approx(np.array([30, 18]) / radius, abs=0.02)
    assert apart(tab, shown) <= 1
    assert (tab.canvas("picture") != before).any()
    drag(tab, (400, -300))  # beyond the rim it stays on it
    assert position(tab) == pytest.approx([0.8, -0.6], abs=1e-6)
    assert apart(tab, shown) <= 1
    assert tab.errors == []


def test_the_dial_follows_a_finger(opened, shown):
    tab = opened(shown)
    x, y = centre(tab, "#dial .rim")
    for kind, points in (
        ("touchStart", [{"x": x, "y": y}]),
        ("touchMove", [{"x": x - 40, "y": y + 8}]),
        ("touchEnd", []),
    ):
        tab.call("Input.dispatchTouchEvent", type=kind, touchPoints=points)
    radius = box(tab, "#dial .rim")[2] / 2
    assert position(tab) == pytest.approx(np.array([-40, 8]) / radius, abs=0.02)
    assert apart(tab, shown) <= 1


def test_the_dial_follows_keys(opened, shown):
    tab = opened(shown)
    tab.evaluate("document.getElementById('dial').focus()")
    for key, at in (("0", (0, 0)), ("ArrowLeft", (-0.02, 0)), ("ArrowDown", (-0.02, 0.02))):
        tab.key(key)
        assert position(tab) == pytest.approx(at, abs=1e-9)
        assert apart(tab, shown) <= 1
    tab.key("ArrowRight", modifiers=8)  # shift
    assert position(tab) == pytest.approx((0.18, 0.02), abs=1e-9)
    tab.key("2")
    assert shares(position(tab), 3) == pytest.approx([0, 1, 0])
    told = tab.evaluate("document.getElementById('dial').getAttribute('aria-valuetext')")
    assert told == "light 0 0 %, light 1 100 %, light 2 0 %"
    tab.key("4")  # there is no such light
    assert shares(position(tab), 3) == pytest.approx([0, 1, 0])


def test_sliders_dim_their_light_exposure_all_and_reset_undoes_it(opened, shown):
    tab = opened(shown)
    drag(tab, (-12, 25))
    slide(tab, "gain-0", 40)
    slide(tab, "gain-2", 0)
    slide(tab, "exposure", -1.5)
    assert apart(tab, shown, gains=[0.4, 1, 0], stops=-1.5) <= 1
    tab.evaluate("document.getElementById('reset').click()")
    assert np.abs(tab.canvas("picture")[..., :3] - wanted(shown, [1, 0, 0])).max() <= 1
    assert tab.errors == []


def test_a_lights_name_puts_it_alone_on_everything(opened, shown):
    tab = opened(shown)
    slide(tab, "gain-1", 0)
    assert wanted(shown, [0, 1, 0]).max() > 0
    tab.evaluate("document.querySelector('[data-light=\"1\"]').click()")
    assert np.abs(tab.canvas("picture")[..., :3] - wanted(shown, [0, 1, 0])).max() <= 1


def test_patches_are_the_colours_of_whole_spectra_and_of_the_factor_model(opened, shown):
    tab = opened(shown)
    drag(tab, (20, -35))
    mix = shares(position(tab), 3)
    told = tab.evaluate(
        "[...document.querySelectorAll('[id^=mixed-][id$=told]')].map(found => found.textContent)"
    )
    light = mix @ shown.lights.coefficients
    factor = codes(shown.materials.coefficients * light @ shown.to_rgb.T)
    whole = codes(np.einsum("j,njk->nk", mix, shown.materials.colours))
    assert len(told) == 5
    for text, *both in zip(told[1:], whole, factor, strict=True):
        halves = [np.array(list(bytes.fromhex(half[1:7]))) for half in text.split(" | ")]
        assert np.abs(np.array([halves[0], halves[-1]]) - both).max() <= 1
    assert np.abs(np.array(list(bytes.fromhex(told[0][1:7]))) - codes(mix @ shown.lights.white)).max() <= 1


def test_what_the_screen_cannot_show_is_counted(opened, shown):
    tab = opened(shown)
    slide(tab, "exposure", 2)
    tab.canvas("picture")
    linear = shown.rgb([4, 0, 0])
    beyond = ((linear < -1 / 510) | (linear > 1 + 1 / 510)).any(axis=-1).mean()
    assert beyond > 0.01
    told = tab.evaluate("document.getElementById('clipped').textContent")
    assert float(told.split()[1]) == pytest.approx(100 * beyond, abs=0.1)
    slide(tab, "gain-0", 0)
    tab.canvas("picture")
    assert tab.evaluate("document.getElementById('clipped').textContent") == ""


def test_names_and_the_picture_find_each_other(opened, shown):
    tab = opened(shown)
    tab.evaluate("document.querySelector('[data-material=\"2\"]').click()")
    clear = tab.canvas("mask")[..., 3] == 0
    assert (clear == (shown.labels == 3)).all()
    x, y, width, height = box(tab, "#mask")
    row, column = np.argwhere(shown.labels == 2)[7]
    tab.mouse("mouseMoved", x + (column + 0.5) * width / 56, y + (row + 0.5) * height / 40)
    assert tab.evaluate("document.getElementById('pointed').textContent") == "material 1"
    tab.evaluate("document.querySelector('[data-material=\"2\"]').click()")
    assert (tab.canvas("mask")[..., 3] == 0).all()


def test_nothing_is_loaded_and_all_that_can_be_used_has_a_name(opened, shown):
    tab = opened(shown)
    assert tab.evaluate("performance.getEntriesByType('resource').length") == 0
    tree = tab.call("Accessibility.getFullAXTree")["nodes"]
    used = [node for node in tree if node["role"]["value"] in ("slider", "button")]
    assert len(used) == 1 + 3 + 1 + 1 + 3 + 4
    assert all(node["name"]["value"] for node in used)


def test_a_wrong_matrix_is_found(opened, shown):
    tab = opened(dataclasses.replace(shown, to_rgb=shown.to_rgb[[1, 0, 2]]))
    assert apart(tab, shown) > 1
    tab = opened(dataclasses.replace(shown, to_rgb=shown.to_rgb * 1.02))
    assert apart(tab, shown) > 1


def test_complaints_of_the_console_are_heard(tab, shown, tmp_path):
    html = page(shown)
    script = (
        "<script>console.error('broken', 1); setTimeout(() => { throw new Error('torn'); })</script></body>"
    )
    (tmp_path / "page.html").write_text(html.replace("</body>", script), encoding="utf-8")
    tab.open(tmp_path / "page.html")
    tab.canvas("picture")
    assert len(tab.errors) == 2
    assert "broken" in json.dumps(tab.errors)
    assert "torn" in json.dumps(tab.errors)
