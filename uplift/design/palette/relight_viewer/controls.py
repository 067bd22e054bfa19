"""What a hand moves: the dial, a slider a light, exposure; and the spectrum that comes of it."""

from __future__ import annotations

from uplift.design.palette.relight_viewer.relighting import Relighting
from uplift.viz.markup import Markup, element

STOPS = 3
"""How far exposure goes up and down, in powers of two."""
KEYS = "Drag the dial, or use arrow keys, with Shift in large steps; 1 to 9 go to a light, 0 to the middle."


def controls(shown: Relighting) -> Markup:
    """Everything beside the picture; the script draws what is within the two ``svg``."""
    sliders = [_slider(f"gain-{row}", name, (0, 100, 1), 100) for row, name in enumerate(shown.lights.names)]
    exposure = _slider("exposure", "exposure", (-STOPS, STOPS, 0.05), 0)
    reset = element("button", "Reset", id="reset", type="button")
    return element(
        "div",
        _dial(),
        element("div", *sliders, exposure, class_="sliders"),
        element("div", element("p", KEYS, class_="note", id="keys"), reset, class_="hands"),
        element("h3", "Mixed light"),
        _spectrum(),
        class_="controls",
    )


def _dial() -> Markup:
    return element(
        "svg",
        id="dial",
        viewBox="-160 -112 320 224",
        tabindex=0,
        role="slider",
        aria_label="Light dial",
        aria_roledescription="two-dimensional dial",
        aria_describedby="keys",
        aria_valuemin=0,
        aria_valuemax=100,
        aria_valuenow=100,
    )


def _slider(name: str, label: str, steps: tuple[float, float, float], value: float) -> Markup:
    least, most, step = map(str, steps)
    entry = element("input", id=name, type="range", min=least, max=most, step=step, value=str(value))
    return element(
        "div", element("label", label, for_=name), entry, element("output", id=f"{name}-told", for_=name)
    )


def _spectrum() -> Markup:
    told = "Spectrum of the mixed light, and the part of each light in it"
    return element("svg", id="spectrum", viewBox="0 0 320 98", role="img", aria_label=told)
