"""``uplift study``: measurements behind the choices that the models make."""

from __future__ import annotations

import click

from .study_held_out import held_out
from .study_moments import moments


@click.group("study")
def command() -> None:
    """Measure on atlases what the choices behind the models are worth.

    \b
    Examples:
      uplift study moments
      uplift study moments --atlas paints.txt --output paints --format json
      uplift study held-out --atlas paints.txt
    """


command.add_command(moments)
command.add_command(held_out)
