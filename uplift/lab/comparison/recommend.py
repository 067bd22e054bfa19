"""Model no more than a scene needs: the cheapest representation that is near enough."""

from __future__ import annotations

import math

from uplift.common.errors import OptionError
from uplift.lab.comparison.measure import Comparison, RepresentationResult


def check_target(target: float) -> float:
    """The target, if it is one. Raises `OptionError`."""
    if not (math.isfinite(target) and target > 0):
        raise OptionError(f"a target of {target:g} is none", hint="give a ΔE00 above 0")
    return target


def cheapest(found: Comparison, lights: str, target: float) -> RepresentationResult | None:
    """Under a set of lights, of all whose 97.5 % quantile stays within the target the one that stores least of a
    surface, then of a light, then the nearest; None where none stays within it. Raises `OptionError`.

    Times have no say: those of equal size differ by what a machine does besides."""
    check_target(target)
    near = [row for row in found.of(lights) if row.statistics.q97_5 <= target]
    return min(near, key=lambda row: (row.floats, row.light_floats, row.statistics.q97_5), default=None)


def nearest(found: Comparison, lights: str) -> RepresentationResult:
    """The one whose 97.5 % quantile is least."""
    return min(found.of(lights), key=lambda row: row.statistics.q97_5)
