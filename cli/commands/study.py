"""``uplift study``: measurements of models, solver and errors."""

from __future__ import annotations

import click

from .study_held_out import held_out
from .study_moments import moments
from .study_sensitivity import sensitivity
from .study_stability import stability


@click.group("study")
def command() -> None:
    """Measure the accuracy of the models, the reliability of the solver, and the propagation of errors.

    \b
    Examples:
      uplift study moments
      uplift study moments --atlas paints.txt --output paints --format json
      uplift study held-out --atlas paints.txt
      uplift study stability --quick
      uplift study sensitivity cubes/moments-16-macbeth.uplift
    """


command.add_command(moments)
command.add_command(held_out)
command.add_command(stability)
command.add_command(sensitivity)
