"""Choices of the design, and the sets of materials whose errors they were made with.

A figure is *optimistic* if a choice behind its method was made with the set that it is
measured on.
"""

from collections.abc import Iterable
from dataclasses import dataclass

from benchmarks.materials import MIXTURE, SHIPPED
from uplift.lab.study.held_out import HALF, LOCAL_LINEAR, NO_ATLAS
from uplift.lab.study.rivals import LIBRARY_REGRESSION, MAPS, METAMER_MEAN

CHOSEN_ON = ("rawtoaces", "babelcolor", "pmc", "tcs", "vs")
MEASURED = (*SHIPPED, "munsell")
OURS = HALF
OURS_SMOOTH = f"{HALF}, smooth prior"
WITH_ATLAS = (OURS, OURS_SMOOTH)
ALONE = NO_ATLAS
ALONE_SMOOTH = f"{NO_ATLAS}, smooth prior"
"""Methods: cubes of moments with and without an atlas."""
MARK = " ○"
"""Follows an optimistic figure on a page."""


@dataclass(frozen=True)
class Choice:
    """A choice, the sets it was made with, and the methods that depend on it."""

    choice: str
    sets: tuple[str, ...]
    methods: tuple[str, ...]


CHOICES = (
    Choice(
        "metric, phase and start of smooth spectra",
        ("rawtoaces",),
        (OURS, OURS_SMOOTH, ALONE, ALONE_SMOOTH),
    ),
    Choice("weights of entries: lights, ends, curvature", CHOSEN_ON, WITH_ATLAS),
    Choice("weight of smooth multipliers of entries", SHIPPED, WITH_ATLAS),
    Choice("kriging: metric, noise, median, default, corners", MEASURED, WITH_ATLAS),
    Choice("standard errors: few entries", MEASURED, WITH_ATLAS),
    Choice(
        "learnt prior: length, spreads, noise, bounds, relevance",
        MEASURED,
        (OURS, ALONE),
    ),
    Choice(
        "local-linear regression: regressors, criterion and ridge",
        ("rawtoaces", "cie2017"),
        (LOCAL_LINEAR, LIBRARY_REGRESSION),
    ),
    Choice("matrix and root polynomials: criterion", MEASURED, MAPS),
    Choice(
        "mean of metamers: number of spectra, mean of spectra",
        ("macbeth", "tcs", "cie2017", "rawtoaces"),
        (METAMER_MEAN,),
    ),
)


def is_optimistic(sets: Iterable[str], method: str) -> bool:
    """Whether a choice behind a method was made with one of the sets."""
    names = {*sets}
    if MIXTURE in names:
        names.update(SHIPPED)
    return any(
        method in choice.methods and not names.isdisjoint(choice.sets)
        for choice in CHOICES
    )


def mark(sets: Iterable[str], method: str) -> str:
    """Return the mark of a figure of a method on the sets, or an empty text."""
    return MARK if is_optimistic(sets, method) else ""
