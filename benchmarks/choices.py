"""Choices of the design, and the sets of materials whose errors they were made with.

A figure is *optimistic* if a choice behind its method was made with the set that it is
measured on.
"""

from collections.abc import Iterable

from benchmarks import Row
from benchmarks.materials import MIXTURE, SHIPPED
from uplift.lab.methods.colour_maps import MAPS
from uplift.lab.study.held_out import (
    HALF,
    LIBRARY_REGRESSION,
    LOCAL_LINEAR,
    METAMER_MEAN,
    NO_ATLAS,
)

MEASURED = [*SHIPPED, "munsell"]
POOLED = "all shipped"
"""Set of the errors of all shipped sets, each without its family."""
ALONE_SMOOTH = f"{NO_ATLAS}, smooth prior"
WITH_ATLAS = [HALF]
CUBES = [HALF, NO_ATLAS, ALONE_SMOOTH]
MARK = " ○"
"""Follows an optimistic figure on a page."""


def _choice(choice: str, sets: Iterable[str], methods: Iterable[str]) -> Row:
    return {"choice": choice, "sets": list(sets), "methods": list(methods)}


CHOICES = [
    _choice("metric, phase and start of smooth spectra", ["rawtoaces"], CUBES),
    _choice(
        "weights of entries: lights, ends, curvature",
        ["rawtoaces", "babelcolor", "pmc", "tcs", "vs"],
        WITH_ATLAS,
    ),
    _choice("weight of smooth multipliers of entries", SHIPPED, WITH_ATLAS),
    _choice("kriging: metric, noise, median, default, corners", MEASURED, WITH_ATLAS),
    _choice("standard errors: few entries", MEASURED, WITH_ATLAS),
    _choice(
        "learnt prior: length, spreads, noise, bounds, relevance",
        MEASURED,
        [HALF, NO_ATLAS],
    ),
    _choice(
        "local-linear regression: regressors, criterion and ridge",
        ["rawtoaces", "cie2017"],
        [LOCAL_LINEAR, LIBRARY_REGRESSION],
    ),
    _choice("matrix and root polynomials: criterion", MEASURED, MAPS),
    _choice(
        "mean of metamers: number of spectra, mean of spectra",
        ["macbeth", "tcs", "cie2017", "rawtoaces"],
        [METAMER_MEAN],
    ),
]
"""Choices, the sets they were made with, and the methods that depend on them."""


def mark(name: str, method: str) -> str:
    """Return the mark of a figure of a method on a set, or an empty text."""
    sets = set(SHIPPED if name in (MIXTURE, POOLED) else [name])
    for choice in CHOICES:
        if method in choice["methods"] and not sets.isdisjoint(choice["sets"]):
            return MARK
    return ""
