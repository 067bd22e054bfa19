"""Parts of Mitsuba's scenes: variants with our plug-ins, spectra, paints and films.

Mitsuba is imported where it is used: a process has one variant at a time.
"""

from typing import Any

import numpy as np

from benchmarks import Row
from uplift.colorimetry import observer
from uplift.common.arrays import Array
from uplift.extras.scene.passes.passes import scaled_power

VARIANT = "scalar_spectral"
"""The spectral variant that does not need LLVM."""
CIE_Y_INTEGRAL = 106.856895
"""Mitsuba divides by it, so that a constant radiance of 1 has Y = 1."""


def start_mitsuba(variant: str = VARIANT) -> str:
    """Select the variant and register the plug-ins; return Mitsuba's version."""
    import mitsuba

    from uplift.extras.mitsuba.plugin import register

    mitsuba.set_variant(variant)
    if variant.endswith("spectral"):
        register()
    return str(mitsuba.__version__)


def spectrum(values: Array) -> Row:
    """Describe values (81,) at the wavelengths of the observer with straight lines
    between them.
    """
    return {
        "type": "regular",
        "wavelength_min": float(observer.START),
        "wavelength_max": float(observer.END),
        "values": ", ".join(f"{value:.9g}" for value in values),
    }


def radiance(power: Array) -> Row:
    """Describe a light of power (81,) whose Y, the sum over the wavelengths, is 1."""
    return spectrum(power * CIE_Y_INTEGRAL / observer.STEP)


def sky(illuminant: str) -> Row:
    """Describe uniform illumination under which the perfect reflector has Y = 1."""
    return {"type": "constant", "radiance": radiance(scaled_power(illuminant))}


def rgb(numbers: Array) -> Row:
    """Describe three numbers that an RGB variant multiplies as they are."""
    return {"type": "rgb", "value": [float(number) for number in numbers]}


def diffuse(reflectance: Any) -> Row:
    """Describe a diffuse surface of a reflectance."""
    return {"type": "diffuse", "reflectance": reflectance}


def film(width: int, height: int, pixel_format: str = "xyz") -> Row:
    """Describe a film of XYZ or RGB whose pixels are independent."""
    return {
        "type": "hdrfilm",
        "width": width,
        "height": height,
        "pixel_format": pixel_format,
        "component_format": "float32",
        "rfilter": {"type": "box"},
    }


def render(scene: Row, samples: int, seed: int = 0) -> Array:
    """Return the picture (height, width, 3) of a scene.

    Its parts are loaded one after the other: the order of lamps, and with it the use of
    random numbers, is otherwise a matter of chance.
    """
    import mitsuba as mi

    loaded = mi.load_dict({"type": "scene", **scene}, parallel=False, optimize=False)
    return np.array(mi.render(loaded, spp=samples, seed=seed), dtype=float)
