"""Recommendation of the cheapest representation that is accurate enough."""

from __future__ import annotations

import math

from uplift.common.errors import OptionError
from uplift.lab.comparison.measure import Comparison, RepresentationResult


def check_target(target: float) -> float:
    """Check the largest ΔE00 that a representation may have.

    Parameters
    ----------
    target : float
        Limit of the 97.5 % quantile of ΔE00.

    Returns
    -------
    float
        The limit.

    Raises
    ------
    OptionError
        If it is not a positive number.

    Examples
    --------
    >>> check_target(1.0)
    1.0
    """
    if not (math.isfinite(target) and target > 0):
        raise OptionError(f"target must be a positive ΔE00, got {target:g}", code="target-not-positive")
    return target


def cheapest(comparison: Comparison, lights: str, target: float) -> RepresentationResult | None:
    """Choose the representation that stores least among those accurate enough under a set of lights.

    Of equally small ones the smaller light, then the smaller error decides. Times are not considered: among
    representations of equal size they depend on other work of the machine.

    Parameters
    ----------
    comparison : Comparison
        The comparison.
    lights : str
        Name of the set of lights.
    target : float
        Largest 97.5 % quantile of ΔE00.

    Returns
    -------
    RepresentationResult or None
        None if none is accurate enough.

    Raises
    ------
    OptionError
        If the target is not a positive number.
    """
    check_target(target)
    sufficient = [result for result in comparison.of(lights) if result.statistics.q97_5 <= target]
    return min(
        sufficient,
        key=lambda result: (result.floats, result.light_floats, result.statistics.q97_5),
        default=None,
    )


def most_accurate(comparison: Comparison, lights: str) -> RepresentationResult:
    """Choose the representation of the smallest 97.5 % quantile under a set of lights.

    Parameters
    ----------
    comparison : Comparison
        The comparison.
    lights : str
        Name of the set of lights.

    Returns
    -------
    RepresentationResult
        Its result.
    """
    return min(comparison.of(lights), key=lambda result: result.statistics.q97_5)
