"""Channel layout: which channels of a part are converted, which pass through, and how the part is written."""

from __future__ import annotations

import time
from dataclasses import dataclass

from uplift.common.errors import TextureError
from uplift.io.texture.alpha import ColourChannels
from uplift.io.texture.colours import colour_channels
from uplift.io.texture.converter import Converter, ReadColours
from uplift.io.texture.source import Image, Part
from uplift.io.texture.writer import OutputPart

OPENEXR_TYPES = ("half", "float", "uint")


@dataclass(frozen=True, eq=False)
class PartLayout:
    """Layout of one part.

    Parameters
    ----------
    part : Part
        The part of the image.
    colours : ColourChannels or None
        The colour channels, if the part has any.
    others : tuple of int
        Indices of the channels that pass through.
    decoder : callable
        Conversion of the colours to linear RGB, and counts of unusual pixels.
    output : OutputPart
        The part to write.
    """

    part: Part
    colours: ColourChannels | None
    others: tuple[int, ...]
    decoder: ReadColours
    output: OutputPart


def part_layouts(converter: Converter, image: Image) -> list[PartLayout]:
    """Return the layout of every part. Raises `TextureError` for an image without usable colours."""
    return [
        _layout(converter, image, part, colours and converter.colour_channels(colours))
        for part, colours in colour_channels_by_part(image)
    ]


def colour_channels_by_part(image: Image) -> list[tuple[Part, ColourChannels | None]]:
    """Return every part and its colour channels. Raises `TextureError` if no part has any (``no-colour-channels``)."""
    parts = [(part, colour_channels(part)) for part in image.parts]
    if not any(colours for _, colours in parts):
        names = ", ".join(dict.fromkeys(name for part in image.parts for name in part.channels))
        raise TextureError(
            f"no colour channels among {names}", code="no-colour-channels", hint="name them R, G and B, or Y"
        )
    return parts


def _layout(converter: Converter, image: Image, part: Part, colours: ColourChannels | None) -> PartLayout:
    rgb = () if colours is None else colours.rgb
    others = tuple(index for index in range(len(part.channels)) if index not in rgb)
    names = tuple(part.channels[index] for index in others)
    types = tuple(_lossless_type(part.types[index]) for index in others)
    if colours is not None:
        converted = (*"RGB", *converter.channels)
        if duplicates := set(converted) & set(names):
            raise TextureError(
                f"channel '{min(duplicates)}' exists next to the colour and would be written twice",
                code="duplicate-channel",
                hint="remove that channel",
            )
        names, types = (*converted, *names), (*(converter.depth,) * len(converted), *types)
    date = part.date or _modification_date(image)
    output = OutputPart(part.name, part.window, names, types, {**part.metadata, **converter.header}, date)
    return PartLayout(part, colours, others, converter.decoder(part), output)


def _lossless_type(name: str) -> str:
    """Return the OpenEXR type that holds all values of a type; integers become [0, 1]."""
    return name if name in OPENEXR_TYPES else {"uint8": "half"}.get(name, "float")


def _modification_date(image: Image) -> str:
    """Return the time of the image's last change as EXIF writes it."""
    return time.strftime("%Y:%m:%d %H:%M:%S", time.gmtime(image.path.stat().st_mtime))
