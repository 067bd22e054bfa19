"""The page: a spectrum, its colours under some lights, and the regions that they can be
moved in.

The browser moves the logarithm of the odds g / (1 − g) of the answer by cosines of the
wavelength, so that every result is a reflectance in (0, 1). Steps of least change, in
the metric of the fit (docs/mathematics.md, 5), lead to the chosen a* and b* and keep
the RGB.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from uplift.colorimetry.gamut import SRGB, conversion
from uplift.colorimetry.observer import display_sensors
from uplift.colorimetry.sensor import Light, Sensor
from uplift.common.arrays import Array
from uplift.common.errors import OptionError
from uplift.common.text import pluralise
from uplift.extras.colour.light_sets import DESCRIPTIONS
from uplift.extras.looks.lab_errors import LIKELY
from uplift.extras.looks.metamer_bounds import Bounds
from uplift.extras.pages.html import render, resource
from uplift.lookup.cube import Cube
from uplift.models.moments import MAX_COUNT, Moments

# digits of the numbers of the page: the RGB of its spectra is exact to far less than a
# code
DIGITS = 12
MARGIN = 1e-6  # distance of the answer from 0 and 1, where the odds are 0 or infinite
CODE_SLACK = 1e-6  # distance in encoded codes at which a colour is written as '#rrggbb'


def page(cube: Cube, found: Sequence[Bounds]) -> str:
    """Render a page on which the look of a colour is chosen, from its bounds under some
    lights.
    """
    if not found or len(found[0].xyz) != 1:
        count = len(found[0].xyz) if found else 0
        raise OptionError(
            "a page shows one colour under some lights, got "
            f"{pluralise(count, 'colour')}",
            hint="give a single colour",
        )
    sensor = cube.data.sensor
    rgb = found[0].volumes.rgb[0]
    written = _written(cube, rgb)
    screens = display_sensors(
        [bounds.light.illuminant for bounds in found], cube.observer, *sensor.range
    )
    lights = [
        _light(bounds, screen) for bounds, screen in zip(found, screens, strict=True)
    ]
    colour = written
    if not isinstance(written, str):
        colour = " ".join(f"{number:.4g}" for number in written)
    return render(
        "extras/report/templates/look_page.html.j2",
        title=f"Looks of {colour}",
        lead=f"Many spectra have this RGB under {sensor.illuminant}. Drag its colour "
        "under another light: the spectrum "
        f"follows, and the colour under {sensor.illuminant} stays.",
        build=sensor.illuminant,
        lights=lights,
        likely=f"{LIKELY:.0%}",
        numbers=_model(sensor, found[0].reflectance[0], rgb)
        | {
            "build": _view(sensor.light, conversion(sensor, SRGB) @ sensor.xyz_to_rgb),
            "lights": lights,
        }
        | {"rgb": written, "luminance": SRGB.rgb_to_xyz[1].tolist()},
        script=resource(
            "extras/pages/draw.js",
            "extras/pages/lab.js",
            "extras/report/look_page.js",
        ),
    )


def _model(sensor: Sensor, answer: Array, rgb: Array) -> dict[str, Any]:
    """Linear part of the answer, basis in the metric of least change, and the RGB to
    keep.
    """
    model = Moments(MAX_COUNT, *sensor.range[:2])
    inside = np.clip(answer, MARGIN, 1 - MARGIN)
    basis = model.basis(sensor.wavelengths) / np.sqrt(model.metric_diagonal())
    return {
        "wavelengths": sensor.wavelengths.tolist(),
        "start": _rounded(np.log(inside / (1 - inside))),
        "basis": _rounded(basis),
        "sensor": _rounded(sensor.matrix),
        "target": rgb.tolist(),
    }


def _light(found: Bounds, screen: Sensor) -> dict[str, Any]:
    likely = found.likely(0)
    return _view(found.light, screen.xyz_to_rgb) | {
        "about": DESCRIPTIONS.get(found.light.name, ""),
        "region": np.round(found.outline(0), 3).tolist(),
        "likely": None if likely is None else np.round(likely, 3).tolist(),
        "largest": float(found.largest.delta_e_2000[0]),
    }


def _view(light: Light, to_rgb: Array) -> dict[str, Any]:
    return {
        "name": light.name,
        "xyz": _rounded(light.xyz),
        "white": _rounded(light.white),
        "toRgb": _rounded(to_rgb),
    }


def _written(cube: Cube, rgb: Array) -> str | list[float]:
    """The colour as a file of looks has it: '#rrggbb' where that is exact, else linear
    RGB.
    """
    codes = cube.encode(rgb)
    whole = np.rint(codes)
    if (np.abs(codes - whole) <= CODE_SLACK).all():
        return "#" + bytes(whole.astype(np.uint8)).hex()
    return [round(float(number), 6) for number in rgb]


def _rounded(values: Array) -> Any:
    """Numbers with `DIGITS` significant digits, as lists."""
    flat = [float(f"{value:.{DIGITS}g}") for value in values.ravel().tolist()]
    return np.reshape(flat, values.shape).tolist()
