"""``--also``: further photographs of a colour or an image, under other lights."""

from __future__ import annotations

import glob
import math
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, TypeVar

import click

from uplift.common.errors import ColourError, OptionError
from uplift.common.text import format_value, parse_float
from uplift.extras.images.sequences import UDIM

from . import options
from .option_types import distinct_light

if TYPE_CHECKING:
    from uplift.colorimetry.illuminants import Illuminant
    from uplift.extras.colour.colour_source import ColourSource
    from uplift.extras.photographs.colour import PhotographedColour
    from uplift.lookup.cube import Cube

Value = TypeVar("Value")
LARGEST_CODE = 255


@dataclass(frozen=True)
class Further:
    """A further photograph: its light, and the text after it."""

    light: Illuminant
    text: str


def parse_further(text: str, what: str, is_what: Callable[[str], bool]) -> Further:
    """Parse LIGHT:WHAT. A light may hold colons as well: the first one after which
    there is a WHAT ends it, or else the first one of all.
    """
    places = [place for place, letter in enumerate(text) if letter == ":"]
    if not places:
        raise OptionError(
            f"a further photograph is LIGHT:{what}, got {format_value(text)}",
            hint="name its light, for example A for tungsten",
        )
    fitting = [place for place in places if is_what(text[place + 1 :])]
    place = (fitting or places)[0]
    return Further(distinct_light(text[:place]), text[place + 1 :])


def is_file(text: str) -> bool:
    """Whether a text is the name of a file, or a pattern of names."""
    return os.path.lexists(text) or glob.has_magic(text) or UDIM in text


def is_colour(text: str) -> bool:
    """Whether a text is a colour."""
    from uplift.extras.colour.colour_source import is_colour

    return is_colour(text)


def parse_noise(text: str) -> tuple[float, float]:
    """Parse 'SHARE' or 'SHARE,FLOOR', of which the share may be in percent."""
    share, _, floor = text.partition(",")
    try:
        scale = 100 if share.strip().endswith("%") else 1
        noise = (
            parse_float(share.strip().removesuffix("%")) / scale,
            parse_float(floor or "0"),
        )
    except ValueError:
        noise = (-1.0, 0.0)
    if not all(0 <= value < 1 for value in noise):
        raise OptionError(
            f"noise must be SHARE or SHARE,FLOOR in [0, 1), got {format_value(text)}",
            hint="write for example 0.5% or 0.005,0.0005",
        )
    return noise


def parse_corners(text: str) -> tuple[float, ...]:
    """Parse the corners X,Y,X,Y,X,Y,X,Y of a chart."""
    try:
        corners = tuple(parse_float(number) for number in text.split(","))
    except ValueError:
        corners = ()
    if len(corners) != 8 or not all(map(math.isfinite, corners)):
        raise OptionError(
            f"a chart has four corners X,Y,X,Y,X,Y,X,Y, got {format_value(text)}",
            hint="give them in pixels, clockwise from dark skin",
        )
    return corners


def for_each(
    values: Sequence[Value], count: int, option: str
) -> tuple[Value | None, ...]:
    """Return a value for each of ``count`` photographs: none, one for all, or one for
    each.
    """
    if len(values) not in (0, 1, count):
        raise OptionError(
            f"{option} must be given once, or for each --also, got {len(values)} for "
            f"{count}"
        )
    if not values:
        return (None,) * count
    return tuple(values) * (count // len(values))


balance = options.choice(
    "--balance",
    *("light", "camera", "none"),
    help="White of further photographs: that of their light, as in the pictures of "
    "'relight'; the same by a factor for each channel; or that of the cube's light.",
)
noise = click.option(
    "--noise",
    metavar="SHARE[,FLOOR]",
    type=options.Parsed(parse_noise),
    help="Standard deviation of linear RGB in photographs, such as 0.5%,0.0005.",
)


def photographed_colour(
    cube: Cube,
    source: ColourSource,
    further: Sequence[Further],
    noise: tuple[float, float] | None,
    balance: str,
) -> PhotographedColour:
    """Return one colour, with those under other lights as they are written; they are
    in the space of the first.

    The noise is by default that of rounding to 8-bit codes if a colour is one.
    """
    import numpy as np

    from uplift.extras.colour.colour_source import HEX
    from uplift.extras.photographs.answers import prepare
    from uplift.extras.photographs.colour import PhotographedColour
    from uplift.extras.photographs.photograph import photograph, rounding_noise

    if not source.single:
        raise OptionError(
            "--also needs one colour",
            hint="convert images with 'uplift texture --also', and tables in Python",
        )
    if noise is None:
        is_code = any(HEX.fullmatch(photo.text) for photo in further) or source.encoded
        noise = rounding_noise(LARGEST_CODE) if is_code else (0.0, 0.0)
    sensor = cube.data.sensor
    photographs = [
        photograph(sensor, photo.light, balance=balance) for photo in further
    ]
    colours = []
    for photo in further:
        stated = replace(source, words=(photo.text,), path=None, xyz=None)
        (rgb,) = stated.blocks(sensor)
        if not np.isfinite(rgb).all():
            raise ColourError(
                f"a colour must be finite, got {format_value(photo.text)}",
                hint="write for example A:#9a3020",
            )
        colours.append(rgb[0])
    prepared = prepare(cube, photographs, noise)
    return PhotographedColour(prepared, np.concatenate(colours))


def also(what: str, is_what: Callable[[str], bool], help: str) -> options.Decorator:
    """``--also``, with ``what`` after the light."""
    parse = partial(parse_further, what=what, is_what=is_what)
    return options.repeatable(
        "--also", "also", help, metavar=f"LIGHT:{what}", type=options.Parsed(parse)
    )
