"""Types of the values of options: numbers, texts that are parsed, lights and files."""

import math
from collections.abc import Callable
from typing import Any

import click

from uplift.common.text import format_value, parse_float, parse_whole

from .inputs import (
    check_figure_page,
    check_page,
    check_plot,
    find_input_space,
    find_light,
    parse_wavelengths,
)

INPUTS = "uplift.inputs"
"""Key of the context's ``meta`` under which files of lamps are kept: those that name no
file do no harm.
"""

LIGHTS = "uplift.lights"
"""Key under which the lights of the command are kept."""


class Number(click.ParamType):  # type: ignore[type-arg]
    """A finite number; the library checks its range."""

    name = "float"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float:
        """Return a finite number."""
        try:
            number = parse_float(value) if isinstance(value, str) else float(value)
        except ValueError:
            number = math.nan
        if not math.isfinite(number):
            self.fail(f"{format_value(value)} is not a finite number.", param, ctx)
        return number


class Whole(click.IntRange):
    """A whole number in ASCII digits that fits into 64 bits, in a range, or a ``word``
    in place of it.
    """

    def __init__(
        self, min: int | None = None, max: int | None = None, *, word: str = ""
    ) -> None:
        super().__init__(min, max)
        self.word = word

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> Any:
        """Return a whole number, or the word."""
        if self.word and value == self.word:
            return value
        try:
            number = parse_whole(value) if isinstance(value, str) else value
        except ValueError:
            known = (
                f"neither a whole number nor '{self.word}'"
                if self.word
                else "not a whole number"
            )
            self.fail(f"{format_value(value)} is {known}.", param, ctx)
        return super().convert(number, param, ctx)

    def _describe_range(self) -> str:
        return "" if (self.min, self.max) == (None, None) else super()._describe_range()


class Parsed(click.ParamType):  # type: ignore[type-arg]
    """A text that a function parses, which may raise `UpliftError`."""

    name = "text"

    def __init__(self, function: Callable[[str], Any]) -> None:
        self.function = function

    def convert(self, value: Any, *_: Any) -> Any:
        """Return what the function makes of the text."""
        return self.function(value)


class Checked(Parsed):
    """A text that a function of `uplift_cli.inputs` checks."""

    def convert(self, value: Any, *_: Any) -> Any:
        """Return the text."""
        self.function(value)
        return value


def distinct_light(text: str) -> Any:
    """Return the name of an illuminant, or the lamp of a file. Two lamps of a command
    must not have one name.
    """
    from uplift.colorimetry.observer import check_distinct

    context = click.get_current_context(silent=True)
    lights = [] if context is None else context.meta.setdefault(LIGHTS, [])
    lights.append(find_light(text))
    check_distinct(lights)
    return lights[-1]


class Light(Parsed):
    """The name of an illuminant, or a file of a lamp, which is kept among the inputs of
    the command.
    """

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> Any:
        """Return the name, or the lamp."""
        if ctx is not None:
            ctx.meta.setdefault(INPUTS, []).extend((value, value.rpartition(":")[0]))
        return super().convert(value, param, ctx)


class OutputFile(Checked):
    """The name of a file or folder that a command writes."""


NUMBER = Number()
WHOLE = Whole()
WHOLE_OR_AUTO = Whole(word="auto")
WAVELENGTHS = Parsed(parse_wavelengths)
LIGHT = Light(distinct_light)
INPUT_SPACE = Checked(find_input_space)
OUTPUT = OutputFile(str)
PAGE = OutputFile(check_page)
PLOT = OutputFile(check_plot)
FIGURE_PAGE = OutputFile(check_figure_page)
