"""``uplift slices``: write a cube as OpenEXR and as a contact sheet."""

from __future__ import annotations

import click

from ..completion import complete_cube
from ..options import force_option
from ..output.console import say


@click.command("slices")
@click.argument("cube", metavar="CUBE", shell_complete=complete_cube)
@click.option("-o", "--output", "out", metavar="FILE", type=click.Path(), help="Slices to write, as .exr.")
@click.option("--plot", "sheet", metavar="FILE", type=click.Path(), help="Contact sheet to write, as .exr or .png.")
@force_option
def command(cube: str, out: str | None, sheet: str | None, force: bool) -> None:
    """Write the blue slices of a cube as images.

    The file of --output has one part per blue slice and one pixel per node. Red increases to the right, green upwards.
    Channels are lattice RGB, target RGB, fitting distance, ΔE00, status, atlas entry, round (with debug information)
    and every coefficient. -1 stands for no entry or no round.

    --plot tiles all slices into one image for any viewer: lattice RGB, fitting distance, status and round, with
    legends.

    \b
    Examples:
      uplift slices macbeth-32.uplift -o macbeth-32.exr --plot macbeth-32.png
      uplift slices macbeth-32.uplift --plot sheet.png
      uplift slices macbeth-32.uplift -o macbeth-32.exr --plot sheet.exr --force
    """
    if out is None and sheet is None:
        raise click.UsageError("Nothing to write: give --output FILE, --plot FILE, or both.")
    from uplift.common.files import check_outputs
    from uplift.cube import read
    from uplift.io.exr import check_slices, write_slices
    from uplift.viz.sheet import check_sheet, write_sheet

    check_outputs((out, sheet), inputs=[cube], force=force)
    if out is not None:
        check_slices(out, force=force)
    if sheet is not None:
        check_sheet(sheet, force=force)
    data = read(cube)
    if out is not None:
        write_slices(data, out, force=force)
        say(f"{out}: {data.lattice.dim} blue slices")
    if sheet is not None:
        write_sheet(data, sheet, force=force)
        say(f"{sheet}: contact sheet")
