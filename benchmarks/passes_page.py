"""A page that renders a small room in the browser in two passes and as RGB, decodes the
passes, and mixes two lights by a slider.

WebGL multiplies red, green and blue as any RGB renderer does: the page draws the room
three times with other numbers. All lamps of the room have one spectrum, so that its
numbers may multiply the picture last, and a change of the light needs no rendering.
"""

import numpy as np

from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.extras.colour.light_sets import DESCRIPTIONS
from uplift.extras.pages.html import render, resource
from uplift.extras.scene.passes.passes import Passes

SIZE = 400
"""Rows and columns of the picture."""
SCRIPTS = (
    "extras/pages/page.js",
    "extras/pages/draw.js",
    "extras/scene/passes/browser_page.js",
)


def page(passes: Passes, reflectances: Array, size: int = SIZE) -> str:
    """Render the page of two passes, of whose lights the first is mixed with one of the
    others, and of the reflectances (24, 81) of a ColorChecker.
    """
    names = [light.name for light in passes.lights]
    return render(
        "extras/scene/passes/templates/browser_page.html.j2",
        title="Spectral pictures from an RGB renderer",
        lead="A room drawn by WebGL, left as RGB, right in two passes of three bands "
        "of wavelengths, decoded. Choose a lamp, and move the sliders.",
        size=size,
        first=_described(names[0]),
        lamps=[(name, _described(name)) for name in names[1:]],
        numbers=_numbers(passes, reflectances),
        script=resource(*SCRIPTS),
    )


def _described(name: str) -> str:
    return f"{name}, {DESCRIPTIONS[name]}" if name in DESCRIPTIONS else name


def _numbers(passes: Passes, reflectances: Array) -> dict[str, object]:
    """Numbers of surfaces and lights in both passes and as RGB, and matrices."""
    screen = observer.sensor()
    bands = passes.reflectance_numbers(reflectances)
    rgb = np.clip(reflectances @ screen.matrix.T, 0, 1)
    # Passes do not have the spectra of lamps: XYZ of lights are decoded.
    white = passes.bands.weights.sum(axis=1)
    whites = [light.to_xyz @ (light.numbers * white) for light in passes.lights]
    decoding = screen.xyz_to_rgb @ passes.to_xyz
    return {
        "surfaces": [bands[:, :3].tolist(), bands[:, 3:].tolist(), rgb.tolist()],
        "lights": [light.numbers.tolist() for light in passes.lights],
        "lightRgb": (np.stack(whites) @ screen.xyz_to_rgb.T).tolist(),
        "decoding": [decoding[:, :3].tolist(), decoding[:, 3:].tolist()],
    }
