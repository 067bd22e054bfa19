"""``uplift samples``: copy the files of the examples into a folder."""

import click

from uplift.common.text import pluralise

from .. import options
from ..output.console import say


@click.command("samples")
@click.argument("folder", metavar="[FOLDER]", default=".", type=click.Path())
@options.force
def command(folder: str, force: bool) -> None:
    """Copy the files of the examples into FOLDER, by default the current one: images, scenes, palettes, measurements.

    All commands in the documentation and in these help texts run in such a folder. Files that are there already stay as
    they are. The pictures are in the public domain; paints.csv and fabrics.csv are two of the shipped atlases.

    \b
    Examples:
      uplift samples
      uplift samples first-steps
      uplift samples --force
    """
    from uplift.samples import copy_samples

    copies = copy_samples(folder, force=force)
    say(f"{folder}: {pluralise(len(copies), 'sample file')}")
