"""Options that several commands share."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import click

from uplift.common.text import format_value, parse_whole

from .completion import (
    complete_atlas,
    complete_cube,
    complete_illuminant,
    complete_observer,
    complete_space,
)
from .number_types import NUMBER, Whole

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]

OUTPUT_FORMAT = "uplift.output-format"
"""Key of the context's ``meta`` under which ``--format`` is kept."""


class LatticeDim(click.ParamType):  # type: ignore[type-arg]
    """A whole number or 'auto'."""

    name = "dim"

    def convert(self, value: str | int, param: click.Parameter | None, ctx: click.Context | None) -> int | str:
        """Return a whole number or 'auto'."""
        if value == "auto" or isinstance(value, int):
            return value
        try:
            return parse_whole(value)
        except ValueError:
            self.fail(f"{format_value(value)} is neither a whole number nor 'auto'", param, ctx)


def cube_option() -> Decorator:
    """``--cube`` as ``cube_path``."""
    return click.option(
        "--cube",
        "cube_path",
        metavar="FILE",
        help="Cube file, or ACEScg for the packaged ACEScg cube. [default: the packaged sRGB cube]",
        shell_complete=complete_cube,
    )


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


def scale_option() -> Decorator:
    """``--scale``: names of `uplift.atlas.MEASURED`, which is not imported here."""
    return click.option(
        "--scale",
        type=click.Choice(("auto", "percent", "fraction")),
        default="auto",
        show_default=True,
        help="Scale of measured values. auto: as the atlas file states, or else by its values.",
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


def _repeatable(help: str, default: str) -> str:
    return f"{help}; repeatable." + (f" [default: {default}]" if default else "")


def output_folder_option() -> Decorator:
    """``--output`` of commands that write several files."""
    return click.option("-o", "--output", metavar="DIR", help="Folder for tables and plots.")


def input_option() -> Decorator:
    """``--input`` as ``input_path``."""
    return click.option(
        "--input", "input_path", metavar="FILE", help="CSV of colours, one per line; '-' is standard input."
    )


def encoded_option() -> Decorator:
    """``--encoded``."""
    return click.option("--encoded", is_flag=True, help="Numbers are encoded 8-bit codes from 0 to 255.")


def stacked(*decorators: Decorator) -> Decorator:
    """Combine decorators, the first one outermost."""

    def decorate(function: Callable[..., Any]) -> Callable[..., Any]:
        for each in reversed(decorators):
            function = each(function)
        return function

    return decorate


def xyz_options(help: str) -> Decorator:
    """``--xyz``, and ``--xy`` with ``--luminance``."""
    return stacked(
        click.option("--xyz", type=NUMBER, nargs=3, metavar="X Y Z", help=help),
        click.option(
            "--xy", type=NUMBER, nargs=2, metavar="X Y", help="Colour by chromaticity, with --luminance, as for --xyz."
        ),
        click.option("--luminance", type=NUMBER, metavar="Y", help="Luminance of --xy, where white has 1."),
    )


def fill_option() -> Decorator:
    """``--fill-missing``."""
    return click.option(
        "--fill-missing",
        is_flag=True,
        help="Take colours that a cube built with --scene lacks from the packaged cube.",
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


def input_space_option(subject: str, default: str = "as the file states") -> Decorator:
    """``--input-space``: text for `uplift.colorimetry.spaces.find_space`."""
    return click.option(
        "--input-space",
        metavar="NAME",
        shell_complete=complete_space,
        help=f"RGB space of {subject}: a name of OpenColorIO or colour-science such as ACEScg or lin_rec2020, or x,y "
        f"of red, green, blue and white. [default: {default}]",
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


def atlas_folders_option() -> Decorator:
    """``--atlas-dir`` as ``folders``."""
    help = _repeatable("Folder to search for atlases", "")
    return click.option("--atlas-dir", "folders", multiple=True, metavar="DIR", help=help)


def format_option(*choices: str) -> Decorator:
    """``--format`` as ``style``; the first choice is the default."""
    return click.option(
        "--format",
        "style",
        type=click.Choice(choices),
        default=choices[0],
        show_default=True,
        callback=_remember_format,
        help="Output format.",
    )


def _remember_format(ctx: click.Context, param: click.Parameter, value: str) -> str:
    """Keep the format where the main command finds it if it has an error to report."""
    ctx.meta[OUTPUT_FORMAT] = value
    return value


def wavelengths_option() -> Decorator:
    """``--wavelengths``, to be parsed by `.wavelengths.parse_wavelengths`."""
    return click.option(
        "--wavelengths",
        metavar="NM",
        help="Wavelengths as START:END:STEP or a list such as 450,550,650. [default: those of the cube]",
    )


def sensor_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """``--space``, ``--illuminant`` and ``--observer``; the observer stays None for the default of the library."""
    space = click.option(
        "--space",
        default="sRGB",
        show_default=True,
        help="RGB space by its name in colour-science or OpenColorIO, such as ACEScg; or camera: raw values.",
        shell_complete=complete_space,
    )
    illuminant = click.option(
        "--illuminant",
        default="D65",
        show_default=True,
        help="Illuminant under which RGB are defined.",
        shell_complete=complete_illuminant,
    )
    observer = click.option(
        "--observer",
        help="Standard observer, or with --space camera a camera: name or CSV file of sensitivities. "
        "[default: CIE 1931 2 Degree Standard Observer]",
        shell_complete=complete_observer,
    )
    return space(illuminant(observer(function)))


def coefficients_option() -> Decorator:
    """``--coefficients``."""
    return click.option(
        "--coefficients",
        type=Whole(),
        default=9,
        show_default=True,
        metavar="N",
        help="Coefficients per spectrum, 3 to 17.",
    )


def force_option() -> Decorator:
    """``--force``."""
    return click.option("--force", is_flag=True, help="Replace existing files.")


def quiet_option() -> Decorator:
    """``--quiet``."""
    return click.option("-q", "--quiet", is_flag=True, help="Print only warnings and errors.")


def verbose_option() -> Decorator:
    """``--verbose``."""
    return click.option("-v", "--verbose", is_flag=True, help="Print a line for every round and improvement step.")
