"""What becomes of each part of an image: which channels are uplifted, which pass through, how it is written."""

from __future__ import annotations

import time
from dataclasses import dataclass

from uplift.common.errors import TextureError
from uplift.io.texture.colours import Decoder, colour_channels, decoder
from uplift.io.texture.source import Image, Part
from uplift.io.texture.uplifter import Uplifter
from uplift.io.texture.writer import Layout

OWN = ("half", "float", "uint")
"""Types of OpenEXR."""
Places = tuple[int, int, int]
"""Of red, green and blue among a part's channels."""


@dataclass(frozen=True, eq=False)
class PartLayout:
    """A part, the places of its red, green and blue, if it has them, and of the channels that pass through."""

    part: Part
    colours: Places | None
    rest: tuple[int, ...]
    decoder: Decoder
    layout: Layout


def part_layouts(uplifter: Uplifter, image: Image) -> list[PartLayout]:
    """A plan for every part. Raises `TextureError` where there is nothing to uplift, or no way to."""
    try:
        return [_plan(uplifter, image, *each) for each in colour_channels_by_part(image)]
    except TextureError as error:
        raise TextureError(error.problem, path=image.path, hint=error.hint) from error


def colour_channels_by_part(image: Image) -> list[tuple[Part, Places | None]]:
    """Every part and the places of its colour. Raises `TextureError` where there is none, or no telling which."""
    try:
        found = [(part, colour_channels(part)) for part in image.parts]
    except TextureError as error:
        raise TextureError(error.problem, path=image.path, hint=error.hint) from error
    if not any(places for _, places in found):
        names = ", ".join(dict.fromkeys(name for part in image.parts for name in part.channels))
        hint = "colour is in R, G and B, or in Y"
        raise TextureError(f"holds no colour but {names}", path=image.path, hint=hint)
    return found


def _plan(uplifter: Uplifter, image: Image, part: Part, colours: Places | None) -> PartLayout:
    rest = tuple(index for index in range(len(part.channels)) if colours is None or index not in colours)
    names = tuple(part.channels[index] for index in rest)
    kinds = tuple(_exact(part.kinds[index]) for index in rest)
    if colours is not None:
        made = (*"RGB", *uplifter.channels)
        if taken := set(made) & set(names):
            hint = "leave it out: the texture would have two"
            raise TextureError(f"has a channel '{min(taken)}' beside its colour", hint=hint)
        names, kinds = (*made, *names), (*(uplifter.depth,) * len(made), *kinds)
    layout = Layout(part.name, part.window, names, kinds, uplifter.header, part.date or _date(image))
    return PartLayout(
        part,
        colours,
        rest,
        decoder(uplifter.cube.data.sensor, part, uplifter.encoding, uplifter.out_of_gamut),
        layout,
    )


def _exact(kind: str) -> str:
    """The type of OpenEXR that holds all values of a type, as 0 to 1."""
    return kind if kind in OWN else {"uint8": "half"}.get(kind, "float")


def _date(image: Image) -> str:
    """When the image was last changed, as EXIF writes it."""
    return time.strftime("%Y:%m:%d %H:%M:%S", time.gmtime(image.path.stat().st_mtime))
