"""A page that mixes measured paints in the browser: tubes with sliders, the mixture
opaque and as a film on white and black, under three lights, and recipes for a colour.
"""

from typing import Any

import numpy as np

from uplift.colorimetry import observer
from uplift.colorimetry.sensor import Sensor
from uplift.colorimetry.tables import bradford
from uplift.extras.colour.light_sets import DESCRIPTIONS
from uplift.extras.colour.srgb import hex_codes
from uplift.extras.pages.html import render, resource
from uplift.extras.paint.paints import Paints

LIGHTS = ("D65", "A", "FL11")
WAVELENGTHS = (400.0, 700.0, 10.0)
SCRIPTS = (
    "extras/pages/draw.js",
    "extras/pages/lab.js",
    "extras/paint/colour_difference.js",
    "extras/paint/paint_mixture.js",
    "extras/paint/paint_recipes.js",
    "extras/paint/paint_page.js",
)


def page(paints: Paints) -> str:
    """Render the page of paints.

    Parameters
    ----------
    paints : Paints
        The paints.

    Returns
    -------
    str
        A page that needs no other file.
    """
    screen = observer.sensor(wavelengths=WAVELENGTHS)
    sampled = paints.at(screen.wavelengths)
    masstones = hex_codes(screen.rgb(sampled.reflectance(np.eye(len(paints)))))
    tints = hex_codes(screen.rgb(sampled.tints()))
    return render(
        "extras/paint/templates/paint_page.html.j2",
        title="Mix paints",
        lead="Squeeze paints from their tubes, or find the recipe of a colour.",
        tubes=list(zip(paints.names, masstones, tints, strict=True)),
        lights=[(name, DESCRIPTIONS[name]) for name in LIGHTS],
        numbers=page_numbers(paints),
        script=resource(*SCRIPTS),
    )


def page_numbers(paints: Paints) -> dict[str, object]:
    """Return what the scripts of the page need of paints and lights."""
    screen = observer.sensor(wavelengths=WAVELENGTHS)
    sampled = paints.at(screen.wavelengths)
    lights = [_light(name, screen) for name in LIGHTS]
    return {
        "names": paints.names,
        "wavelengths": screen.wavelengths.tolist(),
        "absorption": sampled.pigments.absorption.tolist(),
        "scattering": sampled.pigments.scattering.tolist(),
        "outside": paints.surface.outside,
        "inside": paints.surface.inside,
        "lights": lights,
        "toXyz": np.linalg.inv(lights[0]["toRgb"]).tolist(),
    }


def _light(name: str, screen: Sensor) -> dict[str, Any]:
    """Return weights to XYZ and, with the white adapted, to linear sRGB."""
    light = observer.light(name, observer.DEFAULT_OBSERVER, *WAVELENGTHS)
    to_rgb = screen.xyz_to_rgb @ bradford(light.white, screen.light.white)
    return {
        "name": name,
        "xyz": light.xyz.tolist(),
        "white": light.white.tolist(),
        "toRgb": to_rgb.tolist(),
    }
