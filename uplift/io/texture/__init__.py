"""Textures: every pixel of an image uplifted, written as OpenEXR (docs/textures.md).

from uplift import texture

uplifter = texture.prepare(uplift.load("macbeth.uplift"), texture.Moments())
uplifter.convert("wood.png", "wood.exr")
"""

from __future__ import annotations

from uplift.io.texture.colours import ENCODINGS, Counts
from uplift.io.texture.conversion import Conversion, convert
from uplift.io.texture.pixel_encoding import FORMS, Form, Moments, Multipliers, Spectrum
from uplift.io.texture.sequence import Failure, Job, Recipe, cluster, convert_all, left, processes, ready
from uplift.io.texture.uplifter import Uplifter, prepare

__all__ = [
    "ENCODINGS",
    "FORMS",
    "Conversion",
    "Counts",
    "Failure",
    "Form",
    "Job",
    "Moments",
    "Multipliers",
    "Recipe",
    "Spectrum",
    "Uplifter",
    "cluster",
    "convert",
    "convert_all",
    "left",
    "prepare",
    "processes",
    "ready",
]
