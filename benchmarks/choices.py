"""Choices of the design, and the sets of measured materials whose errors they were made
with.

A figure is *optimistic* if a choice behind its method was made with the set that it is
measured on.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import chain

from benchmarks.materials import MIXTURE, SHIPPED
from uplift.lab.study.held_out import HALF, LOCAL_LINEAR, NO_ATLAS

CHOSEN_ON = ("rawtoaces", "babelcolor", "pmc", "tcs", "vs")
OURS = HALF
OURS_SMOOTH = f"{HALF}, smooth prior"
ALONE, ALONE_SMOOTH = NO_ATLAS, f"{NO_ATLAS}, smooth prior"
"""Methods: cubes of moments with and without an atlas."""
MARK = " ○"
"""Follows an optimistic figure on a page."""


@dataclass(frozen=True)
class Choice:
    """A choice of the design, the sets whose errors it was made with, and the methods
    that depend on it.
    """

    choice: str
    sets: tuple[str, ...]
    methods: tuple[str, ...]


CHOICES = (
    Choice(
        "metric, phase and start of smooth spectra",
        ("rawtoaces",),
        (OURS, OURS_SMOOTH, ALONE, ALONE_SMOOTH),
    ),
    Choice(
        "weights of entries: lights, ends, curvature", CHOSEN_ON, (OURS, OURS_SMOOTH)
    ),
    Choice("weight of smooth multipliers of entries", SHIPPED, (OURS, OURS_SMOOTH)),
    Choice(
        "kriging: metric, noise, median, default, corners",
        (*SHIPPED, "munsell"),
        (OURS, OURS_SMOOTH),
    ),
    Choice("standard errors: few entries", (*SHIPPED, "munsell"), (OURS, OURS_SMOOTH)),
    Choice(
        "learnt prior: length, spreads, noise, bounds, relevance",
        (*SHIPPED, "munsell"),
        (OURS, ALONE),
    ),
    Choice(
        "local-linear regression: regressors, criterion and ridge",
        ("rawtoaces", "cie2017"),
        (LOCAL_LINEAR,),
    ),
)


def is_optimistic(sets: Iterable[str], method: str) -> bool:
    """Whether a choice behind a method was made with one of the sets."""
    names = set(
        chain.from_iterable((SHIPPED if name == MIXTURE else (name,)) for name in sets)
    )
    return any(
        names & {*choice.sets} and method in choice.methods for choice in CHOICES
    )


def mark(sets: Iterable[str], method: str) -> str:
    """Return the mark of a figure of a method on the sets, empty if it is not
    optimistic.
    """
    return MARK if is_optimistic(sets, method) else ""
