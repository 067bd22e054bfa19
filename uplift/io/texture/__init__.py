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
from uplift.io.texture.lights import LightUplifter, prepare_lights
from uplift.io.texture.pixel_encoding import PIXEL_ENCODINGS, Moments, Multipliers, PixelEncoding, Spectrum
from uplift.io.texture.sequence import Failure, Job, TextureSettings, convert_all, converter_for, pending
from uplift.io.texture.uplifter import Converter, MaskedUplifter, Uplifter, prepare, prepare_masked

__all__ = [
    "ENCODINGS",
    "PIXEL_ENCODINGS",
    "Conversion",
    "Converter",
    "Counts",
    "Failure",
    "Job",
    "LightUplifter",
    "MaskedUplifter",
    "Moments",
    "Multipliers",
    "PixelEncoding",
    "Spectrum",
    "TextureSettings",
    "Uplifter",
    "convert",
    "convert_all",
    "converter_for",
    "pending",
    "prepare",
    "prepare_lights",
    "prepare_masked",
]
