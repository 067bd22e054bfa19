"""Files of the conformance kit: a cube, its chart, the right answers, and scenes of
renderers.
"""

import warnings
from collections.abc import Mapping
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from uplift.colorimetry.gamut import SRGB
from uplift.colorimetry.observer import illuminant_spd, matching_functions
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array, StrPath
from uplift.common.errors import UpliftWarning
from uplift.common.files import write_text
from uplift.extras.colour.light_sets import REGRESSION_LIGHTS
from uplift.extras.files.csv import csv_text
from uplift.extras.files.outputs import check_folder, make_folder
from uplift.extras.images.exr import chromaticities, make_part, write_parts
from uplift.extras.report.conformance import picture_reference
from uplift.extras.report.conformance_chart import COLUMNS, ROWS, Chart, make_chart
from uplift.extras.report.conformance_results import spectra_wavelengths
from uplift.lookup.cube import Cube
from uplift.pipeline.build import build

CUBE = "conformance.uplift"
CHART = "chart.exr"
COLOURS = "colours.csv"
SPECTRA = "spectra.csv"
STATIC = ("README.txt", "scene.xml", "scene.pbrt")
"""Files that are the same for all cubes."""
PATCH = 4
"""Pixels along a side of a patch."""
DIGITS = 5
"""Decimal places of reflectances."""
EQUAL_Y = 106.856895
"""Integral of the CIE 1931 ȳ in nm, by which Mitsuba divides XYZ."""


def build_cube() -> Cube:
    """Build the cube of the kit: the ColorChecker in few nodes, with a warp of the
    phase.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UpliftWarning)
        return build("macbeth", dim=8, warp="colour")


def kit_names() -> tuple[str, ...]:
    """Return the names of the files of a kit."""
    lights = [f"{name}.spd" for name in REGRESSION_LIGHTS]
    pictures = [f"reference-{name}.exr" for name in REGRESSION_LIGHTS]
    return (CUBE, CHART, COLOURS, SPECTRA, *STATIC, *lights, *pictures)


def write_kit(cube: Cube, folder: StrPath, *, force: bool = False) -> tuple[Path, ...]:
    """Write the kit of a cube to a folder, which is created.

    Raises `OutputError` if files cannot be written, or exist without ``force``, and
    `ColourError` for a cube of a camera (``camera-without-xyz``) and for colours that
    a cube of a scene lacks.
    """
    cube.data.sensor.require_xyz()
    chart = make_chart(cube.data)
    at = spectra_wavelengths()
    spectra = cube.reflectance(chart.rgb, at)
    check_folder(folder, kit_names(), force=force)
    target = make_folder(folder)
    cube.save(target / CUBE, force=force)
    write_text(_colours(chart), target / COLOURS, force=force)
    write_text(_spectra(chart, at, spectra), target / SPECTRA, force=force)
    space = {"chromaticities": chromaticities(cube.data.sensor)}
    _write_picture(chart.rgb, target / CHART, space, force=force)
    for name in REGRESSION_LIGHTS:
        reference = picture_reference(cube, chart, name)
        rgb = reference.xyz("spectra") @ np.linalg.inv(SRGB.rgb_to_xyz).T
        _write_picture(rgb, target / f"reference-{name}.exr", {}, force=force)
        write_text(_power(cube, reference.light), target / f"{name}.spd", force=force)
    kit = files("uplift.extras.report") / "kit"
    for name in STATIC:
        text = (kit / name).read_text(encoding="utf-8")
        write_text(text, target / name, force=force)
    return tuple(target / name for name in kit_names())


def _colours(chart: Chart) -> str:
    rows = [list(map(_shortest, colour)) for colour in chart.rgb]
    return csv_text("rgb", rows)


def _spectra(chart: Chart, at: Array, spectra: Array) -> str:
    header = ["name", *"rgb", *(f"{nm:g}" for nm in at)]
    rows = []
    for name, colour, spectrum in zip(chart.names, chart.rgb, spectra, strict=True):
        values = [round(float(value), DIGITS) for value in spectrum]
        rows.append([name, *map(_shortest, colour), *values])
    return csv_text(header, rows)


def _shortest(value: float) -> float:
    """Return a number of single precision in the fewest digits."""
    return float(np.format_float_positional(np.float32(value)))


def _power(cube: Cube, shown: Light) -> str:
    """Return the radiance of a light by wavelength, of which Y of a white diffuser is 1
    in Mitsuba.
    """
    start, end, step = cube.data.sensor.range
    power = illuminant_spd(shown.illuminant, start, end, step)
    luminance = matching_functions(cube.observer, start, end, step)[:, 1]
    radiance = power * EQUAL_Y / (power @ luminance * step)
    rows = zip(cube.wavelengths, radiance, strict=True)
    return "".join(f"{nm:g} {value:.6g}\n" for nm, value in rows)


def _write_picture(
    rgb: Array, path: Path, header: Mapping[str, Any], *, force: bool
) -> None:
    """Write a picture of patches (1000, 3) of linear RGB."""
    patches = rgb.reshape(ROWS, COLUMNS, 3)
    pixels = patches.repeat(PATCH, axis=0).repeat(PATCH, axis=1)
    channels = {name: pixels[..., index] for index, name in enumerate("RGB")}
    write_parts([make_part("", header, channels)], path, force=force)
