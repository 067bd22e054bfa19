"""How families of representations look in every picture, and the order they have."""

from __future__ import annotations

from collections.abc import Iterable

from uplift.lab.comparison.measure import RepresentationResult

COLOURS = {
    "point sampling": "#1f6fb4",
    "point sampling, filtered": "#35a7d8",
    "Riemann sums": "#d98200",
    "enhanced Riemann sums": "#8c4a00",
    "Sun's composite": "#c8323f",
    "Gaussian quadrature": "#12897b",
    "trigonometric moments": "#7b4fa3",
    "sigmoid": "#d05fa2",
    "linear model (PCA)": "#5a5a5a",
    "hero wavelengths": "#5b8c1f",
}
OTHER = "#444444"
"""Of a family that is not among them."""


def colour(family: str) -> str:
    """``#rrggbb``."""
    return COLOURS.get(family, OTHER)


def families(rows: Iterable[RepresentationResult]) -> dict[str, str]:
    """Those of the rows, with their colours, in the order of `COLOURS`."""
    there = {row.family for row in rows}
    named = [family for family in COLOURS if family in there]
    return {family: colour(family) for family in [*named, *sorted(there - COLOURS.keys())]}


def heading(title: str) -> str:
    """A set's title where a line begins with it."""
    return title[:1].upper() + title[1:]
