"""Types of the values of a palette spec: numbers, names, colours and bounds, with their checks."""

from __future__ import annotations

import math
import re
from typing import Annotated, Any

from pydantic import AfterValidator, Field, PlainValidator

from uplift.colorimetry.written_colour import MAX_NUMBER, WrittenColour, is_number, parse_colour
from uplift.common.errors import ColourError
from uplift.common.spec_file import problem
from uplift.common.text import format_value

NAME = re.compile(r"[^\W_][\w .+-]*(?<! )")
"""Names appear in tables, plots and atlases."""


def _parse_colour(value: Any) -> WrittenColour:
    try:
        return parse_colour(value)
    except ColourError as error:
        raise problem(error.code, error.problem, error.hint) from error


def _parse_bounds(value: Any) -> tuple[float, float]:
    if value is False:
        return -math.inf, math.inf
    is_pair = isinstance(value, list) and len(value) == 2
    if not is_pair or not all(is_number(each) or each in (-math.inf, math.inf) for each in value):
        raise problem("invalid-bounds", f"must be [low, high] or false, got {format_value(value)}")
    if not value[0] < value[1]:
        raise problem("invalid-bounds", f"must be ascending, got {format_value(value)}", "swap the numbers")
    return float(value[0]), float(value[1])


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
Colour = Annotated[WrittenColour, PlainValidator(_parse_colour)]
Bounds = Annotated[tuple[float, float], PlainValidator(_parse_bounds)]
TrueFlag = Annotated[bool, PlainValidator(_check_true)]
