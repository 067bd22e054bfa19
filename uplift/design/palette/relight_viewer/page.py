"""Relighting page: one HTML file with the picture, its coefficients and the scripts that light it."""

from __future__ import annotations

from typing import Any

import numpy as np

from uplift.colorimetry.srgb import hex_codes
from uplift.design.palette.relight_viewer.packing import pack, to_half
from uplift.design.palette.relight_viewer.relighting import Relighting
from uplift.viz.format import pluralise
from uplift.viz.html import render, resource

FOLDER = "design/palette/relight_viewer"
SCRIPTS = ("unpack.js", "screen.js", "mix.js", "dial.js", "page.js", "find.js")
"""One module of the page, in this order."""
DISPLAY_EXPONENT = 1 / 2.2
"""Approximate transfer function of displays."""
MAX_STOPS = 3
"""Range of the exposure in both directions, in powers of two."""


def page(relighting: Relighting) -> str:
    """Render the page of a relighting.

    Parameters
    ----------
    relighting : Relighting
        Picture, materials and lights.

    Returns
    -------
    str
        HTML that needs no other file. Equal values give equal text.
    """
    height, width = relighting.weights.shape[:2]
    lights, materials = relighting.lights, relighting.materials
    title = relighting.title
    return render(
        f"{FOLDER}/templates/page.html.j2",
        title=title,
        lead=(
            f"{pluralise(len(materials.names), 'material')} under any mix of "
            f"{pluralise(len(lights.names), 'light')}: move the dial to relight the picture."
        ),
        width=width,
        height=height,
        coefficients=relighting.to_rgb.shape[1],
        lights=lights.names,
        materials=materials.names,
        max_stops=MAX_STOPS,
        whites=hex_codes(lights.white),
        rows=list(zip(materials.names, _patches(relighting), strict=True)),
        numbers=_numbers(relighting),
        pixels=pack(to_half(relighting.pixels)),
        labels=pack(relighting.labels),
        script=resource(*(f"{FOLDER}/{name}" for name in SCRIPTS)),
    )


def start_light(relighting: Relighting) -> int:
    """Return the light that the page starts with: the one under which the materials look most different.

    Parameters
    ----------
    relighting : Relighting
        Materials and lights.

    Returns
    -------
    int
        Row of the light.
    """
    colours = relighting.materials.colours.clip(0, 1) ** DISPLAY_EXPONENT
    return int(np.linalg.norm(colours - colours.mean(axis=0), axis=-1).mean(axis=0).argmax())


def _patches(relighting: Relighting) -> list[list[tuple[str, str]]]:
    """For every material under every light the colours by full spectra and by the factor model."""
    coefficients = relighting.materials.coefficients[:, None] * relighting.lights.coefficients
    modelled = coefficients @ relighting.to_rgb.T
    return [
        list(zip(hex_codes(full), hex_codes(factor), strict=True))
        for full, factor in zip(relighting.materials.colours, modelled, strict=True)
    ]


def _numbers(relighting: Relighting) -> dict[str, Any]:
    """Values that the scripts compute with."""
    lights, materials = relighting.lights, relighting.materials
    return {
        "start": start_light(relighting),
        "lights": lights.names,
        "materials": materials.names,
        "wavelengths": relighting.wavelengths.tolist(),
        "power": lights.power.tolist(),
        "white": lights.white.tolist(),
        "light": lights.coefficients.tolist(),
        "material": materials.coefficients.tolist(),
        "colours": materials.colours.tolist(),
        "toRgb": relighting.to_rgb.tolist(),
    }
