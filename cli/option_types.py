"""Types of the values of options, and the names that a shell completes for them:
numbers, lights, spaces, cubes, atlases and files.
"""

import math
from collections.abc import Callable, Iterable
from functools import partial
from itertools import chain
from typing import Any

import click
from click.shell_completion import CompletionItem

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
"""Key of the context's ``meta`` under which parsed texts are kept: some name files,
such as those of lamps, and the others do no harm.
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
            known = "not a whole number"
            if self.word:
                known = f"neither a whole number nor '{self.word}'"
            self.fail(f"{format_value(value)} is {known}.", param, ctx)
        return super().convert(number, param, ctx)

    def _describe_range(self) -> str:
        return "" if (self.min, self.max) == (None, None) else super()._describe_range()


class Parsed(click.ParamType):  # type: ignore[type-arg]
    """A text that a function parses, which may raise `UpliftError`. A shell completes
    its ``names``, and ``files``.
    """

    name = "text"

    def __init__(
        self,
        function: Callable[[str], Any] = str,
        names: Callable[[], Iterable[str]] = tuple,
        *,
        files: bool = True,
    ) -> None:
        self.function = function
        self.names = names
        self.files = files

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> Any:
        """Return what the function makes of the text."""
        if ctx is not None:
            texts = (value, value.rpartition(":")[0])
            ctx.meta.setdefault(INPUTS, []).extend(texts)
        return self.function(value)

    def shell_complete(
        self, ctx: click.Context, param: click.Parameter, incomplete: str
    ) -> list[CompletionItem]:
        """Return the names that begin with a text in upper or lower case."""
        # first: bash drops the items before it
        items = [CompletionItem(incomplete, type="file")] * self.files
        for name in self.names():
            if name.lower().startswith(incomplete.lower()):
                items.append(CompletionItem(name))
        return items


class Checked(Parsed):
    """A text that a function of `uplift_cli.inputs` checks."""

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> Any:
        """Return the text."""
        self.function(value)
        return value


class OutputFile(Checked):
    """The name of a file or folder that a command writes."""


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


def _atlases() -> list[str]:
    from uplift.atlas.sources import shipped_atlases

    return [atlas.name for atlas in shipped_atlases()]


def _cubes() -> Iterable[str]:
    from uplift.lookup.cube import PACKAGED

    return PACKAGED


def _table_names(*kinds: str) -> Iterable[str]:
    from uplift.colorimetry.tables import names

    return chain.from_iterable(map(names, kinds))


def _lights() -> Iterable[str]:
    from uplift.colorimetry.illuminants import COMMON_NAMES

    return chain(COMMON_NAMES, _table_names("illuminant"))


_spaces = partial(_table_names, "RGB space")
NUMBER = Number()
WHOLE = Whole()
WHOLE_OR_AUTO = Whole(word="auto")
WAVELENGTHS = Parsed(parse_wavelengths, files=False)
ATLAS = Checked(str, _atlases)
CUBE = Checked(str, _cubes)
LIGHT = Parsed(distinct_light, _lights)
OBSERVER = Checked(str, partial(_table_names, "observer", "camera"))
SPACE = Checked(str, _spaces, files=False)
INPUT_SPACE = Checked(find_input_space, _spaces, files=False)
OUTPUT = OutputFile(str)
PAGE = OutputFile(check_page)
PLOT = OutputFile(check_plot)
FIGURE_PAGE = OutputFile(check_figure_page)
