"""``uplift samples``: copy the files of the examples into a folder."""

import shlex
from pathlib import Path

import click

from uplift.common.text import pluralise

from .. import options
from ..output.console import paragraph, say


@click.command(
    "samples",
    help="""Copy images, scenes, palettes and measurements into FOLDER, as files to
    try uplift with.

    All commands in the documentation and in these help texts run in that folder, those
    of a help text after 'uplift build --atlas macbeth --dim 32'. Files that are there
    already stay as they are. The pictures are in the public domain; paints.csv and
    fabrics.csv are two of the shipped atlases.

    \b
    Examples:
      uplift samples
      uplift samples first-steps
      uplift samples --force
    """,
)
@click.argument(
    "folder", metavar="[FOLDER]", default="uplift-samples", type=click.Path()
)
@options.force
def command(folder: str, force: bool) -> None:
    from uplift.samples import copy_samples

    copies = copy_samples(folder, force=force)
    paragraph(
        f"{folder}: {pluralise(len(copies), 'sample file')}, with which all examples "
        "run. Try first:"
    )
    for line in _first_commands(Path(folder)):
        say(f"  {line}")


def _first_commands(folder: Path) -> tuple[str, ...]:
    """Return commands that run where the folder was created."""
    wood, paints = (
        shlex.quote(str(folder / name)) for name in ("wood.png", "paints.csv")
    )
    return (
        f"uplift relight {wood} -o wood.html",
        f"uplift build --atlas {paints} -o paints.uplift",
        "uplift query --cube paints.uplift '#da7b2a'",
    )
