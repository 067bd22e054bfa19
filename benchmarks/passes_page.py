"""A page that renders a small room in the browser in two passes and as RGB, decodes the
passes, and mixes two lights by a slider.

WebGL multiplies red, green and blue as any RGB renderer does: the page draws the room
three times with other numbers. All lamps of the room have one spectrum, so that its
numbers may multiply the picture last, and a change of the light needs no rendering.
"""

from pathlib import Path

import colour
import numpy as np

from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.extras.colour.light_sets import DESCRIPTIONS
from uplift.extras.pages.html import environment, resource
from uplift.extras.scene.passes.passes import Passes

PATCHES = 24
"""Materials of the room: those of a ColorChecker, in its order."""
PASSES = 2
SIZE = 400
"""Rows and columns of the picture."""
PARTS = Path(__file__).parent / "pages"


def page(passes: Passes, reflectances: Array, size: int = SIZE) -> str:
    """Render the page of two passes, whose first light is mixed with one of the others,
    and of a ColorChecker's reflectances (24, 81) at 380, 385, …, 780 nm.
    """
    if passes.count != PASSES or len(passes.lights) < 2:
        raise OptionError(
            f"the page needs two passes with two lights or more, got {passes.count} "
            f"with {len(passes.lights)}"
        )
    if len(reflectances) != PATCHES:
        raise OptionError(
            f"materials must be the {PATCHES} of a ColorChecker, got "
            f"{len(reflectances)}"
        )
    names = [light.name for light in passes.lights]
    template = environment().from_string((PARTS / "room.html.j2").read_text("utf-8"))
    return template.render(
        title="Spectral pictures from an RGB renderer",
        lead="A room drawn by WebGL, left as RGB, right in two passes of three bands "
        "of wavelengths, decoded. Choose a lamp, and move the sliders.",
        size=size,
        first=_described(names[0]),
        lamps=[(str(row), _described(name)) for row, name in enumerate(names[1:], 1)],
        lamp=str(names.index("HP1") if "HP1" in names else 1),
        numbers=_numbers(passes, reflectances),
        style=resource(str(PARTS / "room.css")),
        script=resource(
            "extras/pages/draw.js",
            "extras/pages/webgl.js",
            str(PARTS / "room.js"),
        ),
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
    bradford = colour.CHROMATIC_ADAPTATION_TRANSFORMS["Bradford"]
    to_cones = bradford @ screen.rgb_to_xyz
    return {
        "surfaces": [bands[:, :3].tolist(), bands[:, 3:].tolist(), rgb.tolist()],
        "lights": [light.numbers.tolist() for light in passes.lights],
        "lightRgb": (np.stack(whites) @ screen.xyz_to_rgb.T).tolist(),
        "toCones": to_cones.tolist(),
        "fromCones": np.linalg.inv(to_cones).tolist(),
        "decoding": [decoding[:, :3].tolist(), decoding[:, 3:].tolist()],
    }
