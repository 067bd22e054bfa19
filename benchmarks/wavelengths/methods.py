"""The project's wavelengths against Meyer's and even ones, on all shipped materials and on unseen halves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from benchmarks.page import table
from uplift.sensor import Array
from uplift.wavelengths import METHODS, Errors, Setting, choose, judge, set_up

OURS, EVEN = "optimised", "fitted"
"""Ours in full, and with wavelengths that are even."""
OTHERS = ("meyer", "uniform", "bins")
COUNTS = range(4, 17)
SMOOTH, SPIKY = ("A", "B", "C", "D65"), ("FL2", "FL7", "FL11")

Found = Mapping[tuple[str, int], Errors]
"""By method and number of wavelengths."""


@dataclass(frozen=True, eq=False)
class Comparison:
    """Errors on all materials, ours fitted to them, and on every second one, ours fitted to the others."""

    lights: tuple[str, ...]
    seen: Found
    unseen: Found


def compare(materials: Array, lights: tuple[str, ...]) -> Comparison:
    """All methods at every count, under some lights at once."""
    whole = set_up(materials, lights)
    odd = np.arange(len(materials)) % 2 == 1
    seen, unseen = {}, {}
    for count in COUNTS:
        for method in METHODS:
            seen[method, count] = choose(whole, count=count, method=method).errors
            unseen[method, count] = _unseen(whole, odd, method, count)
    return Comparison(lights, seen, unseen)


def _unseen(whole: Setting, odd: Array, method: str, count: int) -> Errors:
    """Those that know no materials see only what is asked, which flatters Meyer's allocation."""
    asked = whole.only(odd)
    return judge(asked, METHODS[method](asked if method in OTHERS else whole.only(~odd), count))


def factors(found: Found) -> Array:
    """By how much the best of the other methods errs more in the mean, at every count."""
    return np.array(
        [min(found[other, count].mean for other in OTHERS) / found[OURS, count].mean for count in COUNTS]
    )


def section(title: str, found: Found, words: str) -> str:
    """A table of mean, 95 % and largest ΔE00."""
    rows = []
    for count, factor in zip(COUNTS, factors(found), strict=True):
        cells = [_cell(found[method, count]) for method in METHODS]
        rows.append([str(count), *cells, f"{factor:.1f}"])
    return table(title, words, ["wavelengths", *METHODS, "best other / optimised"], rows)


def told(found: Found) -> str:
    """The factors in a few words."""
    by = factors(found)
    return f"{np.median(by):.1f} times in the median, {by.min():.1f} at least (at {COUNTS[int(by.argmin())]})"


def moved(found: Found) -> str:
    """What moving the wavelengths gains beside weights and powers."""
    by = np.array([found[EVEN, count].mean / found[OURS, count].mean for count in COUNTS])
    return f"{np.median(by):.1f} times in the median, {by.min():.2f} to {by.max():.1f}"


def reached(found: Found, target: float) -> str:
    """The fewest wavelengths of each method whose mean stays under a target."""
    parts = []
    for method in METHODS:
        counts = [count for count in COUNTS if found[method, count].mean <= target]
        parts.append(f"{method} {min(counts) if counts else f'more than {COUNTS[-1]}'}")
    return ", ".join(parts)


def _cell(errors: Errors) -> str:
    return f"{errors.mean:.3f} / {errors.p95:.2f} / {errors.max:.2f}"
