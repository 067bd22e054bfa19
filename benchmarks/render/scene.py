"""The chart as a Mitsuba scene under uniform illumination, rendered to XYZ."""

from __future__ import annotations

from typing import Any

import mitsuba as mi
import numpy as np

from benchmarks.render.chart import BACKGROUND, Chart, Layout
from uplift.colorimetry.observer import sensor
from uplift.common.arrays import Array
from uplift.io.mitsuba import register

VARIANT = "scalar_spectral"
"""The spectral variant that does not need LLVM."""
OF_SURFACES = {"type": "direct", "bsdf_samples": 1, "emitter_samples": 0}
"""Integrator for uniform illumination, where only the wavelengths are random."""
OF_LIGHTS = {"type": "direct", "bsdf_samples": 0, "emitter_samples": 1}
"""Integrator for environments."""
CIE_Y_INTEGRAL = 106.856895
"""Mitsuba divides by it, so that a constant radiance of 1 has Y = 1."""


def start(variant: str = VARIANT) -> None:
    """Select the variant and register the plug-ins."""
    mi.set_variant(variant)
    register()


def measured(chart: Chart) -> list[dict[str, Any]]:
    """Return the measured spectra of the patches: the reference."""
    return [_regular(chart.wavelengths, spectrum) for spectrum in chart.measured]


def built_in(chart: Chart) -> list[dict[str, Any]]:
    """Return the RGB of the patches, which Mitsuba uplifts."""
    return [{"type": "rgb", "value": rgb} for rgb in chart.painted.tolist()]


def from_cube(chart: Chart, cube: str) -> list[dict[str, Any]]:
    """Return the RGB of the patches, which a cube uplifts."""
    return [{"type": "uplift", "cube": cube, "rgb": rgb} for rgb in chart.painted.tolist()]


def render(reflectances: list[dict[str, Any]], illuminant: str, layout: Layout, spp: int, seed: int) -> Array:
    """Return XYZ (height, width, 3) of the chart; a perfect reflector has the XYZ of `Light.white`."""
    emitter = {"type": "constant", "radiance": light_spectrum(illuminant)}
    return render_under(emitter, reflectances, layout, spp, seed, OF_SURFACES)


def render_under(
    emitter: dict[str, Any],
    reflectances: list[dict[str, Any]],
    layout: Layout,
    spp: int,
    seed: int,
    integrator: dict[str, Any] = OF_LIGHTS,
) -> Array:
    """Return XYZ (height, width, 3) of the chart under an emitter."""
    scene = mi.load_dict(_scene(reflectances, emitter, integrator, layout))
    return np.array(mi.render(scene, spp=spp, seed=seed), dtype=float)


def _scene(
    reflectances: list[dict[str, Any]], emitter: dict[str, Any], integrator: dict[str, Any], layout: Layout
) -> dict[str, Any]:
    width, height = layout.size
    half = layout.patch / 2
    patches = {
        f"patch_{number}": _square(reflectance, [x + half - width / 2, height / 2 - y - half, 0], [half, half, 1])
        for number, (reflectance, (x, y)) in enumerate(zip(reflectances, layout.corners(), strict=True))
    }
    behind = _square({"type": "uniform", "value": BACKGROUND}, [0, 0, -1e-3], [width, height, 1])
    return {
        "type": "scene",
        "integrator": integrator,
        "light": emitter,
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


def light_spectrum(illuminant: str) -> dict[str, Any]:
    """Return the illuminant, as bright as makes white's Y = 1."""
    light_sensor = sensor(illuminant=illuminant)
    step = light_sensor.wavelengths[1] - light_sensor.wavelengths[0]
    luminous = (light_sensor.power * light_sensor.cmfs[:, 1]).sum() * step
    return _regular(light_sensor.wavelengths, light_sensor.power * CIE_Y_INTEGRAL / luminous)


def _regular(wavelengths: Array, values: Array) -> dict[str, Any]:
    """Samples, with straight lines between them."""
    return {
        "type": "regular",
        "wavelength_min": float(wavelengths[0]),
        "wavelength_max": float(wavelengths[-1]),
        "values": ", ".join(f"{value:.9g}" for value in values),
    }
