"""``uplift slices``: write a cube, or an emission table, as OpenEXR and as a contact sheet."""

from __future__ import annotations

import click

from ..output.console import say
from ..params.completion import complete_cube
from ..params.options import force_option


@click.command("slices")
@click.argument("cube", metavar="CUBE", shell_complete=complete_cube)
@click.option("-o", "--output", "out", metavar="FILE", type=click.Path(), help="Slices to write, as .exr.")
@click.option("--plot", "sheet", metavar="FILE", type=click.Path(), help="Contact sheet to write, as .exr or .png.")
@force_option()
def command(cube: str, out: str | None, sheet: str | None, force: bool) -> None:
    """Write the blue slices of a cube as images.

    The file of --output has one part per blue slice and one pixel per node. Red increases to the right, green upwards.
    Channels are lattice RGB, target RGB, fitting distance, ΔE00, status, atlas entry, round (with debug information)
    and every coefficient. -1 stands for no entry or no round.

    --plot tiles all slices into one image for any viewer: lattice RGB, fitting distance, status and round, with
    legends.

    CUBE can also be an emission table, or the packaged one, named emission. The file is then one image over the CIE
    1976 chromaticity diagram, at luminance 1: linear RGB, expected error, lamp, and power at wavelengths. The sheet has
    diagrams of colours, expected errors and lamps.

    \b
    Examples:
      uplift slices macbeth-32.uplift -o macbeth-32.exr --plot macbeth-32.png
      uplift slices macbeth-32.uplift --plot sheet.png
      uplift slices macbeth-32.uplift -o macbeth-32.exr --plot sheet.exr --force
      uplift slices emission -o emission.exr --plot emission.png
    """
    if out is None and sheet is None:
        raise click.UsageError("Nothing to write: give --output FILE, --plot FILE, or both.")
    from uplift.common.files import check_outputs
    from uplift.io.slices import check_slices
    from uplift.lights.lookup import names_emission_table
    from uplift.viz.sheet import check_sheet

    check_outputs((out, sheet), inputs=[cube], force=force)
    if out is not None:
        check_slices(out, force=force)
    if sheet is not None:
        check_sheet(sheet, force=force)
    write = _write_lights if names_emission_table(cube) else _write_cube
    write(cube, out, sheet, force=force)


def _write_cube(cube: str, out: str | None, sheet: str | None, *, force: bool) -> None:
    from uplift.cube import read
    from uplift.io.slices import write_slices
    from uplift.viz.sheet import write_sheet

    data = read(cube)
    if out is not None:
        write_slices(data, out, force=force)
        say(f"{out}: {data.lattice.dim} blue slices")
    if sheet is not None:
        write_sheet(data, sheet, force=force)
        say(f"{sheet}: contact sheet")


def _write_lights(cube: str, out: str | None, sheet: str | None, *, force: bool) -> None:
    from uplift.io.slices import write_light_slices
    from uplift.lights.lookup import load_emission
    from uplift.viz.sheet import write_light_sheet

    table = load_emission(cube)
    if out is not None:
        write_light_slices(table, out, force=force)
        say(f"{out}: chromaticity diagram")
    if sheet is not None:
        write_light_sheet(table, sheet, force=force)
        say(f"{sheet}: contact sheet")
