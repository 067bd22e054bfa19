"""RGB space of the colours of an image: the one that the caller names, that the file states, or a default."""

from __future__ import annotations

from pathlib import Path

from uplift.colorimetry.gamut import SRGB
from uplift.colorimetry.sensor import Sensor
from uplift.colorimetry.spaces import ImageSpace
from uplift.colorimetry.srgb import decode
from uplift.common.errors import UpliftWarning
from uplift.io.texture.source import Image, Part

SRGB_SPACE = ImageSpace("sRGB", SRGB, decode)
"""Space of 8-bit and 16-bit images that state none."""


def source_space(part: Part, sensor: Sensor, chosen: ImageSpace | None = None) -> ImageSpace | None:
    """Return the space of the colours of a part, None if it is that of the sensor.

    Parameters
    ----------
    part : Part
        Part of an image.
    sensor : Sensor
        The sensor whose linear RGB are wanted.
    chosen : ImageSpace, optional
        The space that the caller names, which overrides the statement of the file.

    Returns
    -------
    ImageSpace or None
    """
    space = chosen or (part.profile.space if part.profile is not None else None) or _default(part)
    return None if space is None or space.agrees_with(sensor, encoded=bool(part.max_code)) else space


def space_warnings(image: Image, sensor: Sensor, chosen: ImageSpace | None = None) -> tuple[UpliftWarning, ...]:
    """Return warnings about parts whose space is not known: unusable statements, and assumptions."""
    if chosen is not None:
        return ()
    warnings = (_warning(part, sensor, image.path) for part in image.parts)
    return tuple({str(each): each for each in warnings if each is not None}.values())


def _default(part: Part) -> ImageSpace | None:
    """Return sRGB for codes, and the space of the sensor for floats."""
    return SRGB_SPACE if part.max_code else None


def _warning(part: Part, sensor: Sensor, path: Path) -> UpliftWarning | None:
    read_as = f"its colours are read as {'sRGB' if part.max_code else f'linear {sensor.space}'}"
    if part.profile is not None and part.profile.space is None:
        name = f" ({part.profile.name})" if part.profile.name else ""
        problem = f"the image states a colour space that cannot be used{name}; {read_as}"
        return UpliftWarning(problem, code="colour-space-unreadable", path=path)
    if part.profile is None and not SRGB_SPACE.agrees_with(sensor, encoded=False):
        problem = f"the image states no colour space; {read_as}"
        return UpliftWarning(problem, code="colour-space-assumed", path=path)
    return None
