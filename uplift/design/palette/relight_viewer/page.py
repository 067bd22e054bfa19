"""The light dial as one HTML page that needs nothing else: no network, no other file."""

from __future__ import annotations

import json
from importlib.resources import files

from uplift.design.palette.relight_viewer.controls import controls
from uplift.design.palette.relight_viewer.packing import halves, packed
from uplift.design.palette.relight_viewer.relighting import Relighting
from uplift.design.palette.relight_viewer.table import palette_table
from uplift.viz.markup import Markup, element, pluralise

SCRIPTS = ("unpack.js", "screen.js", "mix.js", "dial.js", "page.js", "find.js")
"""One module in the page, in this order."""


def page(shown: Relighting) -> str:
    """The whole HTML text. The same palette and picture give the same text."""
    styles = _resource("uplift.viz", "page.css") + _resource(__package__, "page.css")
    head = element(
        "head",
        element("meta", charset="utf-8"),
        element("meta", name="viewport", content="width=device-width, initial-scale=1"),
        element("meta", name="color-scheme", content="light dark"),
        element("title", f"{shown.title} – uplift palette"),
        element("style", Markup(styles)),
    )
    body = element(
        "body",
        element("header", element("h1", shown.title), element("p", _lead(shown), class_="lead")),
        element("noscript", element("p", "This page mixes light by JavaScript, which is off.", class_="bad")),
        element(
            "main",
            element("div", _picture(shown), controls(shown), class_="bench"),
            palette_table(shown),
            aria_busy="true",
        ),
        _footer(shown),
        element("script", _numbers(shown), type="application/json", id="numbers"),
        element("script", Markup(packed(halves(shown.pixels))), type="text/plain", id="pixels"),
        element("script", Markup(packed(shown.labels)), type="text/plain", id="labels"),
        element("script", Markup("".join(_resource(__package__, name) for name in SCRIPTS)), type="module"),
    )
    return f"<!DOCTYPE html>\n{element('html', head, body, lang='en')}\n"


def _resource(package: str, name: str) -> str:
    return files(package).joinpath(name).read_text(encoding="utf-8")


def _lead(shown: Relighting) -> str:
    materials = pluralise(len(shown.materials.names), "material")
    lights = pluralise(len(shown.lights.names), "light")
    return f"{materials} under any mix of {lights}: move the dial, and the picture is lit anew."


def _picture(shown: Relighting) -> Markup:
    height, width = shown.weights.shape[:2]
    told = f"The materials {', '.join(shown.materials.names)}, lit as the dial says"
    canvas = element("canvas", id="picture", role="img", aria_label=told, width=width, height=height)
    mask = element("canvas", id="mask", aria_hidden="true", width=width, height=height)
    caption = element(
        "figcaption", element("span", id="pointed"), element("span", id="clipped"), class_="note"
    )
    wait = element("p", "Unpacking the picture, which takes a browser of 2023 or later …", class_="wait")
    view = element("div", wait, canvas, mask, class_="view", style=f"aspect-ratio:{width}/{height}")
    return element("figure", view, caption, class_="picture")


def _footer(shown: Relighting) -> Markup:
    (height, width), count = shown.weights.shape[:2], shown.to_rgb.shape[1]
    told = (
        f"Each of the {width} × {height} pixels holds {count} coefficients of a spectral factor model, rendered "
        f"without light. A mix of lights is one 3 × {count} matrix for all of them (Bergner, Möller & Drew, A Spectral "
        "Engine for Visualization, 2004). The dial mixes lights by the inverse square of their distance; a slider dims "
        "its light, and exposure brightens all. Colours are sRGB; what the screen cannot show is clipped, and said so."
    )
    return element("footer", element("p", told))


def _numbers(shown: Relighting) -> Markup:
    """What the script computes with."""
    lights, materials = shown.lights, shown.materials
    told = {
        "lights": lights.names,
        "materials": materials.names,
        "wavelengths": shown.wavelengths.tolist(),
        "power": lights.power.tolist(),
        "white": lights.white.tolist(),
        "light": lights.coefficients.tolist(),
        "material": materials.coefficients.tolist(),
        "colours": materials.colours.tolist(),
        "toRgb": shown.to_rgb.tolist(),
    }
    return Markup(json.dumps(told, ensure_ascii=False, allow_nan=False).replace("<", "\\u003c"))
