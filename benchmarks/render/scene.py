"""The chart as a scene of Mitsuba's, lit evenly from everywhere, rendered to XYZ."""

from __future__ import annotations

from typing import Any

import mitsuba as mi
import numpy as np

from benchmarks.render.chart import BACKGROUND, Chart, Layout
from uplift.colorimetry.observer import sensor
from uplift.common.arrays import Array
from uplift.io.mitsuba import register

VARIANT = "scalar_spectral"
"""Of those that know spectra, the one that needs no LLVM."""
CIE_Y_INTEGRAL = 106.856895
"""By which Mitsuba's film divides, so that a radiance of 1 everywhere has Y = 1."""


def start() -> None:
    mi.set_variant(VARIANT)
    register()


def measured(chart: Chart) -> list[dict[str, Any]]:
    """The truth: every patch has the spectrum that was measured."""
    return [_regular(chart.wavelengths, spectrum) for spectrum in chart.measured]


def built_in(chart: Chart) -> list[dict[str, Any]]:
    """RGB as any scene of Mitsuba's has them, uplifted by Mitsuba."""
    return [{"type": "rgb", "value": rgb} for rgb in chart.painted.tolist()]


def from_cube(chart: Chart, cube: str) -> list[dict[str, Any]]:
    """The same RGB, uplifted by a cube."""
    return [{"type": "uplift", "cube": cube, "rgb": rgb} for rgb in chart.painted.tolist()]


def render(reflectances: list[dict[str, Any]], illuminant: str, layout: Layout, spp: int, seed: int) -> Array:
    """XYZ (height, width, 3) of the chart; a perfect reflector has that of `Light.white`."""
    scene = mi.load_dict(_scene(reflectances, illuminant, layout))
    return np.array(mi.render(scene, spp=spp, seed=seed), dtype=float)


def _scene(reflectances: list[dict[str, Any]], illuminant: str, layout: Layout) -> dict[str, Any]:
    width, height = layout.size
    half = layout.patch / 2
    patches = {
        f"patch_{number}": _square(
            reflectance, [x + half - width / 2, height / 2 - y - half, 0], [half, half, 1]
        )
        for number, (reflectance, (x, y)) in enumerate(zip(reflectances, layout.corners(), strict=True))
    }
    behind = _square({"type": "uniform", "value": BACKGROUND}, [0, 0, -1e-3], [width, height, 1])
    return {
        "type": "scene",
        # Light comes from everywhere alike, so that only wavelengths are left to chance.
        "integrator": {"type": "direct", "bsdf_samples": 1, "emitter_samples": 0},
        "light": {"type": "constant", "radiance": _light(illuminant)},
        "camera": _camera(width, height),
        "background": behind,
        **patches,
    }


def _square(reflectance: dict[str, Any], middle: list[float], scale: list[float]) -> dict[str, Any]:
    return {
        "type": "rectangle",
        "to_world": mi.ScalarTransform4f().translate(middle).scale(scale),
        "bsdf": {"type": "diffuse", "reflectance": reflectance},
    }


def _camera(width: int, height: int) -> dict[str, Any]:
    """Straight from above, a unit a pixel."""
    view = mi.ScalarTransform4f().look_at(origin=[0, 0, 100], target=[0, 0, 0], up=[0, 1, 0])
    return {
        "type": "orthographic",
        "to_world": view @ mi.ScalarTransform4f().scale([width / 2, width / 2, 1]),
        "film": {
            "type": "hdrfilm",
            "width": width,
            "height": height,
            "pixel_format": "xyz",
            "component_format": "float32",
            "rfilter": {"type": "box"},
        },
    }


def _light(illuminant: str) -> dict[str, Any]:
    """The illuminant, as bright as makes white's Y = 1."""
    found = sensor(illuminant=illuminant)
    step = found.wavelengths[1] - found.wavelengths[0]
    luminous = (found.power * found.cmfs[:, 1]).sum() * step
    return _regular(found.wavelengths, found.power * CIE_Y_INTEGRAL / luminous)


def _regular(wavelengths: Array, values: Array) -> dict[str, Any]:
    """Samples, with straight lines between them."""
    return {
        "type": "regular",
        "wavelength_min": float(wavelengths[0]),
        "wavelength_max": float(wavelengths[-1]),
        "values": ", ".join(f"{value:.9g}" for value in values),
    }
