"""Fuzz target: numbers of all options of the command line."""

from __future__ import annotations

import math
from pathlib import Path

import click
from uplift_cli.params.wavelengths import parse_wavelengths

from tests.cli.test_numbers import OPTIONS
from tests.fuzz.mutate import NUMBERS, Random, mutate
from tests.fuzz.target import Target
from uplift.colorimetry.spaces import find_space
from uplift.common.errors import OptionError, UpliftError

SEEDS = (
    b"32",
    b"0.5",
    b"1e-4",
    b"auto",
    b"380:780:5",
    b"450,550,650",
    b"0.68,0.32 0.265,0.69 0.15,0.06 0.3127,0.329",
)
TOKENS = (
    b":",
    b",",
    b" ",
    b".",
    b"e",
    b"-",
    b"+",
    b"_",
    b"0" * 5000,
    b"1e308",
    b"5e-324",
    b"\xef\xbc\x91",
    *NUMBERS,
)


def _generate(random: Random, path: Path) -> None:
    content = SEEDS[random.integers(len(SEEDS))]
    path.write_bytes(content if random.random() < 0.1 else mutate(content, random, TOKENS))


def _use(path: Path) -> None:
    """Parse the text as every option does; it is rejected if none accepts it."""
    text = path.read_bytes().decode("utf-8", "replace")
    accepted, error = 0, OptionError("no options")
    for parse in (parse_wavelengths, find_space):
        try:
            parse(text)
            accepted += 1
        except UpliftError as refused:
            error = refused
    for _, option in OPTIONS:
        try:
            value = option.type.convert(text, option, None)
        except click.BadParameter as refused:
            if not refused.message.isprintable() or len(refused.message) > 300:
                raise ValueError("a message of several lines, or a long one") from refused
            continue
        accepted += 1
        if value != "auto" and not math.isfinite(value):
            raise ValueError(f"{option.name} is {value}")
    if not accepted:
        raise error


TARGET = Target("numbers of options", _generate, _use)
