"""Textures: every pixel of an image uplifted, written as OpenEXR (docs/textures.md).

from uplift.io import texture

uplifter = texture.prepare(uplift.load("macbeth.uplift"), texture.Moments())
uplifter.convert("wood.png", "wood.exr")
"""

from __future__ import annotations

from uplift.io.texture.colours import ENCODINGS, Counts
from uplift.io.texture.conversion import Conversion, convert
from uplift.io.texture.pixel_encoding import FORMS, Moments, Multipliers, PixelEncoding, Spectrum
from uplift.io.texture.sequence import (
    Failure,
    Job,
    TextureSettings,
    cluster,
    convert_all,
    pending,
    processes,
    uplifter_for,
)
from uplift.io.texture.uplifter import Uplifter, prepare

__all__ = [
    "ENCODINGS",
    "FORMS",
    "Conversion",
    "Counts",
    "Failure",
    "Job",
    "Moments",
    "Multipliers",
    "PixelEncoding",
    "Spectrum",
    "TextureSettings",
    "Uplifter",
    "cluster",
    "convert",
    "convert_all",
    "pending",
    "prepare",
    "processes",
    "uplifter_for",
]
