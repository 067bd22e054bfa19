"""``uplift slices``: write a cube as OpenEXR and as a contact sheet."""

from pathlib import Path

import click

from uplift.common.text import pluralise

from .. import options
from ..output.console import say
from ..outputs import check_outputs


def _check_sheet(path: str) -> None:
    from uplift.extras.pages.figure import check_suffix
    from uplift.extras.pages.sheet import FORMATS

    check_suffix(path, FORMATS)


SHEET = options.OutputFile(_check_sheet)


@click.command(
    "slices",
    help="""Write the blue slices of a cube as images.

    The file of --output has one part per blue slice and one pixel per node. Red
    increases to the right, green upwards. Channels are lattice RGB, target RGB, fitting
    distance, ΔE00, status, atlas entry, standard error, round (with debug information)
    and every coefficient. -1 stands for no entry or no round.

    --plot tiles all slices into one image for any viewer: lattice RGB, fitting
    distance, status and, where the cube has them, standard error and round, with
    legends.

    \b
    Examples:
      uplift slices macbeth-32.uplift
      uplift slices macbeth-32.uplift --plot sheet.png
      uplift slices macbeth-32.uplift -o macbeth.exr --plot sheet.exr --force

    With --plot alone, only the contact sheet is written.
    """,
)
@options.cube_argument
@options.output(
    help="Slices to write, as .exr. [default: CUBE's name with .exr, in the current "
    "folder]"
)
@click.option(
    "--plot",
    "sheet",
    metavar="FILE",
    type=SHEET,
    help="Contact sheet to write, as .exr or .png.",
)
@options.force
def command(cube: str, output: str | None, sheet: str | None, force: bool) -> None:
    if output is None and sheet is None:
        output = f"{Path(cube).stem}.exr"
    from uplift.cube.file import read
    from uplift.extras.images.slices import write_slices
    from uplift.extras.pages.sheet import write_sheet
    from uplift.lookup.cube import find_file

    check_outputs(output, sheet)
    data = read(find_file(cube))
    if output is not None:
        write_slices(data, output, force=force)
        say(f"{output}: {pluralise(data.lattice.dim, 'blue slice')}")
    if sheet is not None:
        write_sheet(data, sheet, force=force)
        say(f"{sheet}: contact sheet")
