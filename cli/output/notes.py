"""Notes on the entries of a cube that was just built, printed after its result."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from uplift.common.errors import UpliftWarning
from uplift.common.text import pluralise

from .console import paragraph
from .diagnostics import hint_for, warn

if TYPE_CHECKING:
    from uplift.lookup import Cube

NOTES = ("entry-clipped", "entry-crowded")
"""Codes of warnings that state facts of an atlas, and no mistake."""


def build_quietly(make: Callable[[], Cube]) -> tuple[Cube, list[UpliftWarning]]:
    """Build a cube, and return it with the warnings of the build, which are not shown."""
    with warnings.catch_warnings(record=True) as caught:
        cube = make()
    return cube, [each.message for each in caught if isinstance(each.message, UpliftWarning)]


def print_notes(cube: Cube, found: Sequence[UpliftWarning], *, err: bool = False) -> None:
    """Print the notes on a cube and on the warnings of its build, one line for each kind; show other warnings."""
    for warning in found:
        if warning.code in NOTES:
            paragraph(warning.describe(hint_for(warning)), err=err)
        else:
            warn([warning])
    if cube.outside_names:
        paragraph(_describe_outside(cube), err=err)


def _describe_outside(cube: Cube) -> str:
    """Describe the entries outside the RGB space of a cube, with the smallest space that holds all entries."""
    import numpy as np

    from uplift.colorimetry.observer import grid, smallest_space

    table = cube.data.atlas.with_outside
    spectra = table.spectra.reflectance(np.arange(len(table.names)), grid())
    space = smallest_space(spectra, cube.illuminant, cube.observer)
    count, total = len(cube.outside_names), len(table.names) - cube.data.atlas.looks
    kept = f'--space "{space}"' if space else "wider spaces"
    verb = "lies" if count == 1 else "lie"
    return f"{count} of {pluralise(total, 'entry')} {verb} outside {cube.space}: kept for {kept}"
