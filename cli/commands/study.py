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
      uplift study moments --atlas paints.csv --output moments-paints --format json
      uplift study held-out --atlas paints.csv
      uplift study stability --quick
      uplift study sensitivity macbeth-32.uplift
    """


command.add_command(moments)
command.add_command(held_out)
command.add_command(stability)
command.add_command(sensitivity)
