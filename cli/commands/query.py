"""``uplift query``: ask a cube for spectra."""

from __future__ import annotations

import re
import warnings
from collections.abc import Iterable
from typing import TYPE_CHECKING

import click

from uplift.common.errors import UpliftWarning

from ..output.query_output import WRITERS
from ..params.options import (
    cube_option,
    fill_option,
    force_option,
    format_option,
    out_of_gamut_option,
    primaries_option,
    wavelengths_option,
)
from ..params.primaries import parse_primaries
from ..params.wavelengths import parse_wavelengths

if TYPE_CHECKING:
    from uplift.colorimetry.gamut import GamutMapped
    from uplift.common.arrays import Array
    from uplift.lookup import Cube, QueryResult

NEGATIVE = re.compile(r"-\.?\d")


class QueryCommand(click.Command):
    """Takes '-0.1' for a number, not for an option: the error should speak of the colour."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        return super().parse_args(ctx, [f" {arg}" if NEGATIVE.match(arg) else arg for arg in args])


@click.command("query", cls=QueryCommand)
@click.argument("colour", nargs=-1)
@cube_option()
@click.option(
    "--input", "input_path", metavar="FILE", help="CSV of colours, a line each; '-' is standard input."
)
@click.option("--8bit", "codes", is_flag=True, help="Numbers are encoded 8-bit codes, 0 to 255.")
@wavelengths_option()
@click.option(
    "--mode",
    type=click.Choice(("spectra", "moments", "refined", "nearest")),
    default="spectra",
    show_default=True,
    help="Interpolate spectra (exact), coefficients (fast), coefficients and refine them, or take the nearest node.",
)
@primaries_option(
    "Display that linear RGB are of: a space by name, or x,y of red, green, blue and white. [default: the cube's]"
)
@out_of_gamut_option()
@fill_option()
@format_option("table", "json", "csv")
@click.option("--plot", "plot_path", metavar="PNG", help="Draw the spectra into a picture.")
@force_option()
def command(
    colour: tuple[str, ...],
    cube_path: str | None,
    input_path: str | None,
    codes: bool,
    wavelengths: str | None,
    mode: str,
    primaries: str | None,
    way: str,
    fill: bool,
    style: str,
    plot_path: str | None,
    force: bool,
) -> None:
    """Ask a cube for the spectrum of a COLOUR: R G B, '#rrggbb', or '-' for lines on standard input.

    Numbers are linear RGB from 0 to 1 in the cube's space; hex colours, and numbers with --8bit, are
    encoded as the space has it. With --primaries they are of another display.

    \b
    Examples:
      uplift query 0.8 0.2 0.1
      uplift query --cube macbeth-32.uplift '#cc3319' --plot red.png
      uplift query --8bit 204 51 25 --wavelengths 400:700:10 --format json
      uplift query --input colours.csv --format csv > spectra.csv
      uplift query 1.4 0.3 -0.1 --out-of-gamut desaturate
      uplift query --primaries P3-D65 0.2 0.9 0.3 --out-of-gamut desaturate
      echo 0.5,0.5,0.5 | uplift query - --format json
    """
    from uplift.colorimetry.gamut import conversion, map_to_gamut
    from uplift.common.files import check_output
    from uplift.lookup import load, query

    if plot_path is not None:
        check_output(plot_path, force=force)
    cube = load(cube_path)
    bounded = way == "error" and primaries is None
    rgb = _colours(colour, input_path, cube, codes=codes, bounded=bounded)
    if primaries is not None:
        rgb = rgb @ conversion(parse_primaries(primaries), cube.data.sensor).T
    moved = map_to_gamut(rgb, cube.data.sensor, way)
    _tell(moved, way)
    if fill:
        cube = _filled(cube, moved.rgb)
    found: Iterable[QueryResult] = query(
        cube, moved.rgb, parse_wavelengths(wavelengths), mode, asked=moved.requested
    )
    if plot_path is not None:
        from uplift.viz.spectra import plot_spectra

        found = list(found)
        plot_spectra(cube, found, plot_path, force=force)
    WRITERS[style](cube, found, bool(colour) and colour != ("-",))


def _tell(moved: GamutMapped, way: str) -> None:
    """Colours that were moved are said: how many, and how far."""
    if moved.count:
        told = (
            f"{moved.count} of {len(moved.rgb)} colours lie outside [0, 1]: moved inside ({way}), "
            f"a component by up to {moved.max_change:.3g}"
        )
        warnings.warn(told, UpliftWarning, stacklevel=1)


def _filled(cube: Cube, rgb: Array) -> Cube:
    """The cube with what the colours lack; how many they are is said."""
    outside = int((~cube.holds(rgb)).sum())
    if outside:
        told = f"{outside} of {len(rgb)} colours are none of the cube's scene: filled from the package's own cube"
        warnings.warn(told, UpliftWarning, stacklevel=1)
    return cube.fill_missing(rgb)


def _colours(words: tuple[str, ...], path: str | None, cube: Cube, *, codes: bool, bounded: bool) -> Array:
    from uplift.common.errors import ColourError

    from ..params.colours import from_arguments, from_table

    if words == ("-",):
        words, path = (), path or "-"
    if bool(words) == (path is not None):
        raise click.UsageError("Give one colour, or --input FILE, or '-'. See 'uplift query --help'.")
    if path is None:
        return from_arguments(words, cube, codes=codes)
    try:
        with click.open_file(path, encoding="utf-8-sig") as file:
            return from_table(
                file, "standard input" if path == "-" else path, cube, codes=codes, bounded=bounded
            )
    except OSError as error:
        raise ColourError(f"{path}: {error.strerror}", hint="name a CSV file of colours") from error
