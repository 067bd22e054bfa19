"""Options that several commands share, and the types of their values."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import click

from uplift.common.text import format_value, parse_float, parse_whole

from .completion import complete_atlas, complete_cube, complete_illuminant, complete_observer, complete_space

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]
OUTPUT_FORMAT = "uplift.output-format"
"""Key of the context's ``meta`` under which ``--format`` is kept."""


class Number(click.ParamType):  # type: ignore[type-arg]
    """A finite number; the library checks its range."""

    name = "float"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Return a finite number."""
        try:
            number = parse_float(value) if isinstance(value, str) else float(value)
        except ValueError:
            number = math.nan
        if not math.isfinite(number):
            self.fail(f"{format_value(value)} is not a finite number.", param, ctx)
        return number


class Whole(click.IntRange):
    """A whole number in ASCII digits that fits into 64 bits, in a range."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Return a whole number."""
        try:
            number = parse_whole(value) if isinstance(value, str) else value
        except ValueError:
            self.fail(f"{format_value(value)} is not a whole number.", param, ctx)
        return super().convert(number, param, ctx)


NUMBER = Number()


def stacked(*decorators: Decorator) -> Decorator:
    """Combine decorators, the first one outermost."""

    def decorate(function: Callable[..., Any]) -> Callable[..., Any]:
        for each in reversed(decorators):
            function = each(function)
        return function

    return decorate


def _repeatable(help: str, default: str) -> str:
    return f"{help}; repeatable." + (f" [default: {default}]" if default else "")


def atlas_option(help: str, default: str = "") -> Decorator:
    """``--atlas`` as ``files``."""
    return click.option(
        "--atlas",
        "files",
        multiple=True,
        metavar="FILE",
        help=_repeatable(help, default),
        shell_complete=complete_atlas,
    )


def light_option(help: str, default: str) -> Decorator:
    """``--light`` as ``lights``."""
    return click.option(
        "--light",
        "lights",
        multiple=True,
        metavar="NAME",
        help=_repeatable(help, default),
        shell_complete=complete_illuminant,
    )


def xyz_options(help: str) -> Decorator:
    """``--xyz``, and ``--xy`` with ``--luminance``."""
    return stacked(
        click.option("--xyz", type=NUMBER, nargs=3, metavar="X Y Z", help=help),
        click.option(
            "--xy", type=NUMBER, nargs=2, metavar="X Y", help="Colour by chromaticity, with --luminance, as for --xyz."
        ),
        click.option("--luminance", type=NUMBER, metavar="Y", help="Luminance of --xy, where white has 1."),
    )


def encoding_option(subject: str = "colours") -> Decorator:
    """``--encoding``."""
    return click.option(
        "--encoding",
        type=click.Choice(("auto", "linear", "encoded")),
        default="auto",
        show_default=True,
        help=f"Encoding of {subject}. auto: whole numbers have the transfer function of the cube's space, floats are "
        "linear.",
    )


def input_space_option(subject: str, default: str = "as the file states") -> Decorator:
    """``--input-space``: text for `uplift.colorimetry.spaces.find_space`."""
    return click.option(
        "--input-space",
        metavar="NAME",
        shell_complete=complete_space,
        help=f"RGB space of {subject}: a name of OpenColorIO or colour-science such as ACEScg or lin_rec2020, or x,y "
        f"of red, green, blue and white. [default: {default}]",
    )


def out_of_gamut_option(default: str = "error", subject: str = "linear RGB") -> Decorator:
    """``--out-of-gamut`` as ``method``: names of `uplift.colorimetry.gamut.METHODS`, which is not imported here."""
    return click.option(
        "--out-of-gamut",
        "method",
        type=click.Choice(("error", "clip", "scale", "desaturate", "desaturate-oklab")),
        default=default,
        show_default=True,
        help=f"Treatment of {subject} outside [0, 1]: raise an error, clip, darken, or desaturate at constant "
        "luminance and dominant wavelength or at constant lightness and hue of Oklab.",
    )


def format_option(*choices: str) -> Decorator:
    """``--format`` as ``style``; the first choice is the default."""
    return click.option(
        "--format",
        "style",
        type=click.Choice(choices),
        default=choices[0],
        show_default=True,
        is_eager=True,
        callback=_remember_format,
        help="Output format.",
    )


def _remember_format(ctx: click.Context, param: click.Parameter, value: str) -> str:
    """Keep the format where the main command finds it if it has an error to report."""
    ctx.meta[OUTPUT_FORMAT] = value
    return value


def plot_option(help: str, option: str = "--plot", name: str = "plot_path") -> Decorator:
    """An option for the file of a plot, as ``name``. A suffix other than .png, .svg and .pdf is an error at once."""
    return click.option(option, name, metavar="FILE", callback=_check_suffix, help=f"{help}, as .png, .svg or .pdf.")


def _check_suffix(ctx: click.Context, param: click.Parameter, value: str | None) -> str | None:
    if value is not None:
        from uplift.viz.figure import check_suffix

        check_suffix(value)
    return value


cube_option = click.option(
    "--cube",
    "cube_path",
    metavar="FILE",
    help="Cube file, or ACEScg for the packaged ACEScg cube. [default: the packaged sRGB cube]",
    shell_complete=complete_cube,
)
scale_option = click.option(  # names of uplift.atlas.MEASURED, which is not imported here
    "--scale",
    type=click.Choice(("auto", "percent", "fraction")),
    default="auto",
    show_default=True,
    help="Scale of measured values. auto: as the atlas file states, or else by its values.",
)
coefficients_option = click.option(
    "--coefficients",
    type=Whole(),
    default=9,
    show_default=True,
    metavar="N",
    help="Coefficients per spectrum, 3 to 17.",
)
wavelengths_option = click.option(  # text for inputs.parse_wavelengths
    "--wavelengths",
    metavar="NM",
    help="Wavelengths as START:END:STEP or a list such as 450,550,650. [default: those of the cube]",
)
input_option = click.option(
    "--input", "input_path", metavar="FILE", help="CSV of colours, one per line; '-' is standard input."
)
encoded_option = click.option("--encoded", is_flag=True, help="Numbers are encoded 8-bit codes from 0 to 255.")
fill_option = click.option(
    "--fill-missing", is_flag=True, help="Take colours that a cube built with --scene lacks from the packaged cube."
)
atlas_folders_option = click.option(
    "--atlas-dir", "folders", multiple=True, metavar="DIR", help=_repeatable("Folder to search for atlases", "")
)
output_folder_option = click.option("-o", "--output", metavar="DIR", help="Folder for tables and plots.")
force_option = click.option("--force", is_flag=True, help="Replace existing files.")
quiet_option = click.option("-q", "--quiet", is_flag=True, help="Print only warnings and errors.")
verbose_option = click.option(
    "-v", "--verbose", is_flag=True, help="Print a line for every round and improvement step."
)


sensor_options = stacked(  # the observer stays None for the default of the library
    click.option(
        "--space",
        default="sRGB",
        show_default=True,
        help="RGB space by its name in colour-science or OpenColorIO, such as ACEScg; or camera: raw values.",
        shell_complete=complete_space,
    ),
    click.option(
        "--illuminant",
        default="D65",
        show_default=True,
        help="Illuminant under which RGB are defined.",
        shell_complete=complete_illuminant,
    ),
    click.option(
        "--observer",
        help="Standard observer, or with --space camera a camera: name or CSV file of sensitivities. "
        "[default: CIE 1931 2 Degree Standard Observer]",
        shell_complete=complete_observer,
    ),
)
