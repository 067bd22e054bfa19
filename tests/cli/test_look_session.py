"""From a choice on the page of ``uplift bounds --html`` to a cube that answers it."""

from __future__ import annotations

import json
import tomllib

import numpy as np

from benchmarks.browser import SETTLE, SHIFT, browser
from tests.parts import CHROMIUM, need
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.colorimetry.observer import DEFAULT_OBSERVER, display_sensors
from uplift.colorimetry.srgb import decode

LIGHTS = ("--light", "A", "--light", "FL11")
CHOICE = (("region-1", "ArrowLeft", 3), ("region-1", "ArrowDown", 1), ("region-0", "ArrowRight", 1))
"""Region, key and number of steps of 5 in a* or b*."""


def choose(page):
    """Move colours on the page and copy the look, as text."""
    with browser() as tab:
        tab.window(1440, 900)
        tab.open(page)
        for region, key, times in CHOICE:
            tab.evaluate(f"document.getElementById('{region}').focus()")
            for _ in range(times):
                tab.key(key, SHIFT)
                tab.evaluate(SETTLE)
        states = [tab.evaluate(f"document.getElementById('state-{number}').textContent") for number in (0, 1)]
        tab.evaluate("document.getElementById('copy').click()")
        field = "document.getElementById('toml')"
        copied = tab.evaluate(f"{field}.value.slice({field}.selectionStart, {field}.selectionEnd)")
    assert states == ["chosen", "chosen"]
    return copied


def test_a_cube_answers_what_was_chosen_on_the_page(run, home):
    need(CHROMIUM)
    before = json.loads(
        run("bounds", "#8a2a20", *LIGHTS, "--html", "page.html", "--format", "json").stdout.split("\n")[0]
    )
    (home / "looks.toml").write_text(choose(home / "page.html"), encoding="utf-8")
    (look,) = tomllib.loads((home / "looks.toml").read_text(encoding="utf-8"))["look"]
    run("build", "--dim", 4, "--look", "looks.toml", "-o", "looks.uplift")
    answer = json.loads(run("query", look["rgb"], "--cube", "looks.uplift", *LIGHTS, "--format", "json").stdout)
    assert answer["round_trip"]["delta_e_2000"] < 1e-3
    for screen in display_sensors(("A", "FL11"), DEFAULT_OBSERVER):
        name = screen.illuminant
        chosen = decode(np.array(list(bytes.fromhex(look[name][1:]))) / 255)
        assert delta_e_rgb(screen, answer["lights"][name]["srgb"], chosen) <= 0.1
        assert delta_e_rgb(screen, before["lights"][name]["srgb"], chosen) > 1
