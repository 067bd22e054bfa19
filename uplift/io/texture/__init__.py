"""Spectral textures: images whose pixels are uplifted and written as OpenEXR (docs/textures.md).

Examples
--------
::

    import uplift
    from uplift.io import texture

    uplifter = texture.prepare(uplift.load("macbeth.uplift"), texture.Moments())
    texture.convert(uplifter, "wood.png", "wood.exr")
"""

from __future__ import annotations

from uplift.io.texture.colours import ENCODINGS, Counts
from uplift.io.texture.conversion import Conversion, convert
from uplift.io.texture.converter import Converter
from uplift.io.texture.lights import LightUplifter, prepare_lights
from uplift.io.texture.masked import MaskedUplifter, prepare_masked
from uplift.io.texture.pixel_encoding import PIXEL_ENCODINGS, Moments, Multipliers, PixelEncoding, Spectrum
from uplift.io.texture.sequence import (
    Failure,
    Job,
    LightSettings,
    MaskedSettings,
    Settings,
    TextureSettings,
    convert_all,
    converter_for,
    dask_executor,
    pending,
    process_executor,
)
from uplift.io.texture.uplifter import Uplifter, prepare

__all__ = [
    "ENCODINGS",
    "PIXEL_ENCODINGS",
    "Conversion",
    "Converter",
    "Counts",
    "Failure",
    "Job",
    "LightSettings",
    "LightUplifter",
    "MaskedSettings",
    "MaskedUplifter",
    "Moments",
    "Multipliers",
    "PixelEncoding",
    "Settings",
    "Spectrum",
    "TextureSettings",
    "Uplifter",
    "convert",
    "convert_all",
    "converter_for",
    "dask_executor",
    "pending",
    "prepare",
    "prepare_lights",
    "prepare_masked",
    "process_executor",
]
