"""``uplift palette``: design lights and materials for the colours that they shall make."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from ..output.palette_page import page_options, read_picture, write_page
from ..output.palette_tables import PRINTERS
from ..params.options import force_option, format_option

if TYPE_CHECKING:
    from uplift.design.palette import Design


@click.command("palette")
@click.argument("spec", metavar="SPEC.toml", type=click.Path())
@click.option(
    "--atlas", metavar="OUT", help="Write the designed materials as an atlas: text, or CSV for .csv."
)
@click.option("--matrix", "matrix_path", metavar="PNG", help="Draw the matrix of colours.")
@click.option("--spectra", "spectra_path", metavar="PNG", help="Draw the spectra of lights and materials.")
@page_options
@format_option("table", "json")
@force_option()
def command(
    spec: str,
    atlas: str | None,
    matrix_path: str | None,
    spectra_path: str | None,
    html: str | None,
    image: str | None,
    labels: tuple[str, ...],
    style: str,
    force: bool,
) -> None:
    """Design what is open in a palette of lights and materials, and print the matrix of their colours.

    SPEC.toml names lights and materials, given or to be designed, and colours that materials shall have under lights:
    their own, or ones that several share freely (docs/palette.md). A cell shows the colour wanted, that of the spectra
    found, and that of the factor model, with ΔE00 from the first to the second and from the second to the third.
    Wishes that no spectra fulfil are named, with what to relax. JSON holds all spectra.

    \b
    Examples:
      uplift palette docs/palette/metamers.toml
      uplift palette docs/palette/metamers.toml --matrix matrix.png --spectra spectra.png
      uplift palette docs/palette/metamers.toml --atlas paints.txt
      uplift palette docs/palette-dial/engine.toml --html engine.html
      uplift palette docs/palette/vanish.toml --format json > vanish.json
    """
    from uplift.common.files import check_output
    from uplift.design.palette import design, matrix, read_palette, standard_model, unmet_goals

    for path in (atlas, matrix_path, spectra_path, html):
        if path is not None:
            check_output(path, force=force)
    palette = read_palette(spec)
    picture = read_picture(palette, html, image, labels)
    found = design(palette, standard_model(palette.sensor, palette.count))
    colours = matrix(found)
    PRINTERS[style](found, colours, unmet_goals(found))
    _write(found, atlas, matrix_path, spectra_path, force=force)
    if html is not None:
        write_page(found, spec, picture, html, force=force)


def _write(
    found: Design, atlas: str | None, matrix_path: str | None, spectra_path: str | None, *, force: bool
) -> None:
    from uplift.design.palette import matrix, plot_matrix, plot_spectra, write_designed

    if atlas is not None:
        count = write_designed(found, atlas, force=force)
        click.echo(f"{atlas}: {count} designed materials", err=True)
    if matrix_path is not None:
        plot_matrix(found, matrix(found), matrix_path, force=force)
        click.echo(f"{matrix_path}: matrix of colours", err=True)
    if spectra_path is not None:
        plot_spectra(found, spectra_path, force=force)
        click.echo(f"{spectra_path}: spectra", err=True)
