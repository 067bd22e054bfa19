"""Colours and order of the families of representations."""

from __future__ import annotations

from collections.abc import Iterable

from uplift.viz.figure import OTHER

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


def family_colour(family: str) -> str:
    """``#rrggbb`` of a family."""
    return COLOURS.get(family, OTHER)


def family_colours(families: Iterable[str]) -> dict[str, str]:
    """Colours of the given families in the order of `COLOURS`, unknown families last."""
    present = set(families)
    names = [*(family for family in COLOURS if family in present), *sorted(present - COLOURS.keys())]
    return {name: family_colour(name) for name in names}
