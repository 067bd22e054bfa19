"""Options that several commands share, each defined once."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import click

Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]


def cube_option() -> Decorator:
    return click.option(
        "--cube", "cube_path", metavar="FILE", help="Cube to ask. [default: the package's own, sRGB]"
    )


def fill_option() -> Decorator:
    return click.option(
        "--fill", is_flag=True, help="Answer colours that a --scene cube lacks from the package's own cube."
    )


def out_of_gamut_option(default: str = "error", what: str = "linear RGB") -> Decorator:
    """Names of `uplift.colorimetry.gamut.METHODS`, which is not imported for them."""
    return click.option(
        "--out-of-gamut",
        "way",
        type=click.Choice(("error", "clip", "scale", "desaturate", "desaturate-oklab")),
        default=default,
        show_default=True,
        help=f"What becomes of {what} outside [0, 1]: refused; clipped; made darker; or less saturated, at constant "
        "luminance and dominant wavelength, or at constant lightness and hue of Oklab.",
    )


def primaries_option(help: str) -> Decorator:
    """Its value is for `cli.primaries`."""
    return click.option("--primaries", metavar="SPACE", help=help)


def encoding_option(what: str = "colours are") -> Decorator:
    return click.option(
        "--encoding",
        type=click.Choice(("auto", "linear", "encoded")),
        default="auto",
        show_default=True,
        help=f"What {what} in. auto: whole numbers are encoded as the cube's space has it, floats are linear.",
    )


def atlas_folders_option() -> Decorator:
    return click.option(
        "--atlas-dir", "folders", multiple=True, metavar="DIR", help="Where the atlases lie; may be repeated."
    )


def format_option(*choices: str) -> Decorator:
    return click.option(
        "--format",
        "style",
        type=click.Choice(choices),
        default=choices[0],
        show_default=True,
        help="Output format.",
    )


def wavelengths_option() -> Decorator:
    return click.option(
        "--wavelengths", metavar="NM", help="'START:END:STEP' or a list '450,550,650'. [default: the cube's]"
    )


def sensor_options(function: Callable[..., Any]) -> Callable[..., Any]:
    """--space, --illuminant, --observer; the observer stays None for the library's own default."""
    space = click.option(
        "--space", default="sRGB", show_default=True, help="RGB space, as colour-science names it."
    )
    illuminant = click.option(
        "--illuminant", default="D65", show_default=True, help="Light the RGB are meant under."
    )
    observer = click.option(
        "--observer", help="Standard observer. [default: CIE 1931 2 Degree Standard Observer]"
    )
    return space(illuminant(observer(function)))


def force_option() -> Decorator:
    return click.option("--force", is_flag=True, help="Replace an existing file.")


def verbosity_options(function: Callable[..., Any]) -> Callable[..., Any]:
    quiet = click.option("-q", "--quiet", is_flag=True, help="Say nothing but warnings and errors.")
    verbose = click.option(
        "-v", "--verbose", is_flag=True, help="A line for every round and improvement step."
    )
    return quiet(verbose(function))
