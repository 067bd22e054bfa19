"""Notes on the entries of a cube that was just built, printed after its result."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, TypeVar

from uplift.common.errors import UpliftError, UpliftWarning
from uplift.common.text import pluralise

from .console import paragraph
from .diagnostics import hint_for, warn

if TYPE_CHECKING:
    from uplift.lookup.cube import Cube

Made = TypeVar("Made")
NOTES = (
    "entry-clipped",
    "entry-crowded",
    "entry-smoothed",
    "values-in-percent",
)
"""Codes of warnings that state facts of an atlas, and no mistake."""


def collect_notes(make: Callable[[], Made]) -> tuple[Made, list[UpliftWarning]]:
    """Read an atlas or build a cube, and return it with its notes, which are shown at
    once only if that fails.
    """
    notes: list[UpliftWarning] = []
    show = warnings.showwarning

    def collect(message: Warning | str, *rest: Any, **options: Any) -> None:
        if isinstance(message, UpliftWarning) and message.code in NOTES:
            notes.append(message)
        else:
            show(message, *rest, **options)

    with warnings.catch_warnings():
        warnings.showwarning = collect
        try:
            made = make()
        except UpliftError:
            warnings.showwarning = show
            warn(notes)
            raise
    return made, notes


def print_notes(
    cube: Cube, notes: Iterable[UpliftWarning], *, err: bool = False
) -> None:
    """Print the notes of a build and on the entries outside the space of the cube, a
    paragraph for each.
    """
    for note in notes:
        paragraph(note.describe(hint_for(note)), err=err)
    if cube.outside_names:
        paragraph(_describe_outside(cube), err=err)


def _describe_outside(cube: Cube) -> str:
    """Describe the entries outside the RGB space of a cube, with the smallest space
    that holds all entries.
    """
    import numpy as np

    from uplift.colorimetry.observer import grid, smallest_space

    table = cube.data.atlas.with_outside
    spectra = table.spectra.reflectance(np.arange(len(table.names)), grid())
    space = smallest_space(spectra, cube.illuminant, cube.observer)
    count = len(cube.outside_names)
    total = len(table.names) - cube.data.atlas.looks
    kept = f'--space "{space}"' if space else "wider spaces"
    verb = "lies" if count == 1 else "lie"
    return (
        f"{count} of {pluralise(total, 'entry')} {verb} outside {cube.space}: kept "
        f"for {kept}"
    )
