"""Figure of an image under other lights, from its spectral texture and by RGB products."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import OpenEXR

from benchmarks.textures.pictures import Picture
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.colorimetry.gamut import SRGB
from uplift.colorimetry.sensor import Light
from uplift.colorimetry.srgb import to_display_codes
from uplift.common.arrays import Array
from uplift.io import texture
from uplift.lookup import Cube
from uplift.viz.figure import new_figure, write_png

LIGHTS = {"A": "tungsten", "FL11": "three-band fluorescent", "HP1": "high-pressure sodium"}
DETAIL = (slice(0, 300), slice(60, 460))
"""Rows and columns of the detail."""


def draw(cube: Cube, picture: Picture, path: Path) -> dict[str, float]:
    """Write the figure, and return the mean ΔE00 between both methods by light."""
    spectra = _spectra(cube, picture)
    rgb = np.clip(picture.linear(), 0, 1)[DETAIL]
    sensor = cube.data.sensor
    figure = new_figure(10.2, 4.5)
    panels = figure.subplots(2, len(LIGHTS) + 1)
    _show(panels[0, 0], sensor.rgb(spectra), "D65, from the texture's spectra")
    _show(panels[1, 0], rgb, "the image")
    errors = {}
    for (above, below), (name, what) in zip(panels[:, 1:].T, LIGHTS.items(), strict=True):
        light = observer.light(name)
        spectral = spectra @ light.xyz.T
        colour = _screen(cube, light.white)
        errors[name] = _mean_delta_e(light, spectral, (rgb * colour) @ np.linalg.inv(sensor.xyz_to_rgb).T)
        _show(above, _screen(cube, spectral) / colour.max(), f"{name}, {what}")
        _show(below, rgb * colour / colour.max(), f"{name}, RGB × RGB: ΔE00 {errors[name]:.1f}")
    write_png(figure, path, force=True)
    return errors


def _spectra(cube: Cube, picture: Picture) -> Array:
    """Return the spectra (h, w, N) of the texture, read by OpenEXR."""
    with tempfile.TemporaryDirectory() as folder:
        uplifter = texture.prepare(cube)
        texture.convert(uplifter, picture.path, Path(folder) / "texture.exr")
        channels = OpenEXR.File(str(Path(folder) / "texture.exr"), separate_channels=True).channels()
        return np.stack([channels[name].pixels[DETAIL] for name in uplifter.channels], axis=-1).astype(float)


def _screen(cube: Cube, xyz: Array) -> Array:
    """Return linear sRGB without chromatic adaptation, as of a camera balanced for daylight."""
    return xyz @ cube.data.sensor.xyz_to_rgb.T


def _mean_delta_e(light: Light, first: Array, second: Array) -> float:
    return float(delta_e_2000(lab(first, light.white), lab(second, light.white)).mean())


def _show(axes: Any, linear: Array, title: str) -> None:
    axes.imshow(to_display_codes(linear, SRGB).astype(np.uint8))
    axes.set_title(title, fontsize=9, loc="left")
    axes.set_axis_off()
