"""``uplift bounds``: what reflectances of one colour can do under other lights."""

from __future__ import annotations

from typing import Any

import click

from uplift.colorimetry.lights import RELIGHT_LIGHTS

from ..output.bounds_output import write_bounds
from ..params.options import force_option, format_option, light_option
from ..params.plots import plot_option
from .query import ColourCommand, ask, colour_options


@click.command("bounds", cls=ColourCommand)
@colour_options()
@light_option("Illuminant under which the bounds are shown", " ".join(RELIGHT_LIGHTS))
@format_option("table", "json", "csv")
@plot_option("--plot", "plot_path", "Plot the bounds")
@click.option(
    "--html",
    metavar="FILE",
    help="Write a page on which the colour under each --light is dragged within its bounds, for a file of looks.",
)
@force_option()
def command(
    lights: tuple[str, ...], style: str, plot_path: str | None, html: str | None, force: bool, **colours: Any
) -> None:
    """Compute the bounds of all reflectances of a COLOUR: R G B, '#rrggbb', or '-' for lines on standard input.

    RGB does not identify a material: others of the same colour may differ under another light. Under each --light, the
    bounds are the largest ΔE00 of any reflectance of the colour from the answer of the cube, and the ranges of L*, a*
    and b*.

    \b
    Examples:
      uplift bounds '#8a2a20'
      uplift bounds '#8a2a20' --light A --light FL11 --plot bounds.png
      uplift bounds '#8a2a20' --light A --light FL11 --html red.html
      uplift bounds --cube macbeth-32.uplift 0.8 0.2 0.1 --format json

    The page of --html shows the bounds of one colour and a spectrum for every choice in them; it writes the TOML for
    'uplift build --look'.
    """
    from uplift.common.files import check_outputs

    check_outputs((plot_path, html), inputs=(colours["cube_path"], colours["input_path"]), force=force)
    answers, results, single = ask(lights=lights or RELIGHT_LIGHTS, **colours)
    if html is not None and not single:
        raise click.UsageError("--html shows one colour: give it on the command line.")
    blocks = ((block, answers.bounds(block, single=single)) for block in results)
    write_bounds(answers.cube, blocks, style, plot_path, html, single=single, force=force)
    answers.warn()
