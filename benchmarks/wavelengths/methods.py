"""The project's wavelengths against Meyer's and even ones, on all shipped materials and on unseen halves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from benchmarks.page import table
from uplift.common.arrays import Array
from uplift.scene.wavelengths import METHODS, ColourErrors, RenderSetup, choose, evaluate, make_setup

OURS, EVEN = "optimised", "fitted"
"""Ours in full, and with wavelengths that are even."""
OTHERS = ("meyer", "uniform", "bins")
COUNTS = range(4, 17)
SMOOTH, SPIKY = ("A", "B", "C", "D65"), ("FL2", "FL7", "FL11")

Found = Mapping[tuple[str, int], ColourErrors]
"""By method and number of wavelengths."""


@dataclass(frozen=True, eq=False)
class Comparison:
    """Errors on all materials, ours fitted to them, and on every second one, ours fitted to the others."""

    lights: tuple[str, ...]
    seen: Found
    unseen: Found


def compare(materials: Array, lights: tuple[str, ...]) -> Comparison:
    """All methods at every count, under some lights at once."""
    whole = make_setup(materials, lights)
    odd = np.arange(len(materials)) % 2 == 1
    seen, unseen = {}, {}
    for count in COUNTS:
        for method in METHODS:
            seen[method, count] = choose(whole, count=count, method=method).errors
            unseen[method, count] = _unseen(whole, odd, method, count)
    return Comparison(lights, seen, unseen)


def _unseen(whole: RenderSetup, odd: Array, method: str, count: int) -> ColourErrors:
    """Those that know no materials see only what is asked, which flatters Meyer's allocation."""
    asked = whole.only(odd)
    return evaluate(asked, METHODS[method](asked if method in OTHERS else whole.only(~odd), count))


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


def summary(comparisons: Sequence[Comparison], materials: int) -> str:
    """The factors, and what a mean of 1 takes."""
    rows = []
    for comparison in comparisons:
        for name, found in (("unseen", comparison.unseen), ("all", comparison.seen)):
            moved = np.array([found[EVEN, count].mean / found[OURS, count].mean for count in COUNTS])
            rows.append(
                [
                    ", ".join(comparison.lights),
                    name,
                    _range(factors(found)),
                    _range(moved),
                    *(_fewest(found, method) for method in METHODS),
                ]
            )
    head = ["lights", "materials", "best other / optimised", "fitted / optimised"]
    return table(
        "In short",
        f"The {materials} entries of `atlases/`. *unseen*: fitted to every other entry, judged by the rest; *all*: "
        "fitted to all and judged by all. Ratios of mean ΔE00, 4 to 16 wavelengths: median (least at so many–most); "
        "*best other* is that of Meyer's, uniform and bins. Then the fewest of 4 to 16 wavelengths whose mean is at "
        "most 1; – where 16 do not reach it.",
        [*head, *METHODS],
        rows,
    )


def _range(ratios: Array) -> str:
    least = int(ratios.argmin())
    return f"{np.median(ratios):.1f} ({ratios[least]:.1f} at {COUNTS[least]}–{ratios.max():.1f})"


def _fewest(found: Found, method: str) -> str:
    return next((str(count) for count in COUNTS if found[method, count].mean <= 1), "–")


def _cell(errors: ColourErrors) -> str:
    return f"{errors.mean:.3f} / {errors.p95:.2f} / {errors.max:.2f}"
