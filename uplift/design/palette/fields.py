"""Types of the values of a palette spec: numbers, names, colours and bounds, with their checks."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from pydantic import AfterValidator, Field, PlainValidator

from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.common.quoting import format_value
from uplift.common.spec_file import problem

MAX_NUMBER = 1e6
"""Larger numbers are typing errors, and make the equations ill-conditioned."""
NAME = re.compile(r"[^\W_][\w .+-]*(?<! )")
"""Names appear in tables, plots and atlases."""


@dataclass(frozen=True)
class SpecColour:
    """A colour as written in a spec: 8-bit ``codes``, or ``linear`` RGB."""

    codes: tuple[int, ...] = ()
    linear: tuple[float, ...] = ()

    def rgb(self, sensor: Sensor) -> Array:
        """Linear RGB (3,) in the space of a sensor."""
        return sensor.decode(self.codes) if self.codes else np.array(self.linear)


def _parse_colour(value: Any) -> SpecColour:
    if isinstance(value, str) and re.fullmatch("#[0-9a-fA-F]{6}", value):
        return SpecColour(codes=tuple(bytes.fromhex(value[1:])))
    if isinstance(value, list) and len(value) == 3 and all(map(_is_number, value)):
        return SpecColour(linear=tuple(map(float, value)))
    text = f"must be '#rrggbb' or three linear numbers, got {format_value(value)}"
    raise problem("invalid-colour", text, "write '#cc3319' or [0.6, 0.03, 0.01]")


def _parse_bounds(value: Any) -> tuple[float, float]:
    if value is False:
        return -math.inf, math.inf
    is_pair = isinstance(value, list) and len(value) == 2
    if not is_pair or not all(_is_number(each) or each in (-math.inf, math.inf) for each in value):
        raise problem("invalid-bounds", f"must be [low, high] or false, got {format_value(value)}")
    if not value[0] < value[1]:
        raise problem("invalid-bounds", f"must be ascending, got {format_value(value)}", "swap the numbers")
    return float(value[0]), float(value[1])


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= MAX_NUMBER


def _check_name(name: str) -> str:
    if not NAME.fullmatch(name):
        text = f"must consist of letters, digits, spaces and .+-_, got {format_value(name)}"
        raise problem("invalid-name", text, "begin with a letter or digit, and do not end with a space")
    return name


def _check_true(value: Any) -> bool:
    if value is not True:
        raise problem("invalid-value", f"must be true, got {format_value(value)}", "leave it out otherwise")
    return True


Number = Annotated[float, Field(strict=True, ge=-MAX_NUMBER, le=MAX_NUMBER, allow_inf_nan=False)]
NonNegative = Annotated[float, Field(strict=True, ge=0, le=MAX_NUMBER, allow_inf_nan=False)]
Name = Annotated[str, AfterValidator(_check_name)]
Colour = Annotated[SpecColour, PlainValidator(_parse_colour)]
Bounds = Annotated[tuple[float, float], PlainValidator(_parse_bounds)]
TrueFlag = Annotated[bool, PlainValidator(_check_true)]
