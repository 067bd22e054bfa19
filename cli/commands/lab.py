"""``uplift lab``: measurements of models, and designs of spectra."""

import click

from ..command import LazyGroup

SUMMARIES = {
    "study": "Measure models, solver, and the propagation of errors.",
    "compare": "Compare representations of spectra by error and cost.",
    "wavelengths": "Choose the wavelengths at which a renderer samples.",
    "palette": "Design the unknown spectra of a palette.",
    "bounds": "Compute the bounds of all reflectances of a colour.",
    "diff": "Compare the answers of two cubes.",
}


@click.command(
    "lab",
    cls=LazyGroup,
    summaries=SUMMARIES,
    help="""Study models and solver, compare representations and cubes, and compute
    bounds and designs of spectra.

    \b
    Examples:
      uplift lab bounds '#8a2a20'
      uplift lab diff macbeth-32.uplift sRGB
      uplift lab study moments
    """,
)
def command() -> None:
    """Hold the subcommands."""
