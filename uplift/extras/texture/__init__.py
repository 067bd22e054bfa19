"""Spectral textures: images whose pixels are uplifted and written as OpenEXR
(docs/textures.md).

Examples
--------
::

    import uplift
    from uplift.extras import texture

    uplifter = texture.prepare(uplift.load("macbeth.uplift"), texture.Moments())
    texture.convert(uplifter, "wood.png", "wood.exr")
"""

from uplift.extras.texture.colours import Counts
from uplift.extras.texture.conversion import Conversion, convert
from uplift.extras.texture.emission import prepare_lights
from uplift.extras.texture.mask import prepare_masked
from uplift.extras.texture.photographs import (
    ChartInPicture,
    FurtherPicture,
    FurtherPictures,
)
from uplift.extras.texture.sequence import (
    Failure,
    Job,
    Skipped,
    TextureSettings,
    convert_all,
    pending,
)
from uplift.extras.texture.several_lights import prepare_several_lights
from uplift.extras.texture.uplifter import (
    PIXEL_ENCODINGS,
    Moments,
    Multipliers,
    Spectrum,
    prepare,
)

__all__ = [
    "PIXEL_ENCODINGS",
    "ChartInPicture",
    "Conversion",
    "Counts",
    "Failure",
    "FurtherPicture",
    "FurtherPictures",
    "Job",
    "Moments",
    "Multipliers",
    "Skipped",
    "Spectrum",
    "TextureSettings",
    "convert",
    "convert_all",
    "pending",
    "prepare",
    "prepare_lights",
    "prepare_masked",
    "prepare_several_lights",
]
