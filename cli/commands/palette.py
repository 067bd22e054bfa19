"""``uplift palette``: design lights and materials for given colours."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from ..output.console import say
from ..output.palette_page import read_picture, write_page
from ..output.palette_tables import PRINTERS
from ..params.options import force_option, format_option
from ..params.plots import plot_option

if TYPE_CHECKING:
    from uplift.design.palette import Design


@click.command("palette")
@click.argument("spec", metavar="SPEC.toml", type=click.Path())
@click.option(
    "-o", "--output", metavar="FILE", help="Write the designed materials as an atlas; CSV if FILE ends in .csv."
)
@plot_option("--plot", "matrix_path", "Plot the matrix of colours")
@plot_option("--plot-spectra", "spectra_path", "Plot the spectra of lights and materials")
@click.option("--html", metavar="HTML", help="Write a page that shows the materials under any mixture of the lights.")
@click.option(
    "--image",
    metavar="FILE",
    help="Picture for the page: an 8-bit image of labels, or EXR channels with the names of the materials.",
)
@click.option(
    "--label",
    "labels",
    multiple=True,
    metavar="NAME=#RRGGBB",
    help="Colour of a material in --image; repeatable. [default: greys 1, 2, …]",
)
@format_option("table", "json")
@force_option()
def command(
    spec: str,
    output: str | None,
    matrix_path: str | None,
    spectra_path: str | None,
    html: str | None,
    image: str | None,
    labels: tuple[str, ...],
    style: str,
    force: bool,
) -> None:
    """Design the unknown spectra of a palette of lights and materials, and print the matrix of their colours.

    SPEC.toml lists lights and materials, given or to be designed, and the colours that materials must have.
    Several cells may share one colour that is free (docs/palette.md).

    A cell of the matrix shows the requested colour, the colour of the designed spectra and the colour of the factor
    model, with ΔE00 between the first and the second and between the second and the third. Goals that no spectra can
    meet are listed with the requirements to relax. JSON output has all spectra.

    \b
    Examples:
      uplift palette metamers.toml
      uplift palette metamers.toml --plot matrix.png --plot-spectra spectra.png
      uplift palette metamers.toml -o designed.txt
      uplift palette engine.toml --html engine.html
      uplift palette vanish.toml --format json > vanish.json
    """
    from uplift.common.files import check_outputs
    from uplift.design.palette import design, matrix, read_palette, standard_model, unmet_goals

    palette = read_palette(spec)
    outputs = (output, matrix_path, spectra_path, html)
    check_outputs(outputs, inputs=(*palette.sources, image), force=force)
    picture = read_picture(palette, html, image, labels)
    solution = design(palette, standard_model(palette.sensor, palette.count))
    PRINTERS[style](solution, matrix(solution), unmet_goals(solution))
    _write(solution, output, matrix_path, spectra_path, force=force)
    if html is not None:
        write_page(solution, spec, picture, html, force=force)


def _write(
    design: Design, atlas: str | None, matrix_path: str | None, spectra_path: str | None, *, force: bool
) -> None:
    from uplift.design.palette import matrix, plot_matrix, plot_spectra, write_designed

    if atlas is not None:
        count = write_designed(design, atlas, force=force)
        say(f"{atlas}: {count} designed materials", err=True)
    if matrix_path is not None:
        plot_matrix(design, matrix(design), matrix_path, force=force)
        say(f"{matrix_path}: matrix of colours", err=True)
    if spectra_path is not None:
        plot_spectra(design, spectra_path, force=force)
        say(f"{spectra_path}: spectra", err=True)
