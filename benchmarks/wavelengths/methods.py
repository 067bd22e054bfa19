"""Methods of wavelength selection on all shipped materials and on held-out halves."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.common.arrays import Array
from uplift.scene.wavelengths import METHODS, ColourErrors, RenderSetup, choose, evaluate, make_setup

OPTIMISED, FITTED = "optimised", "fitted"
OTHERS = ("meyer", "uniform", "bins")
"""Methods that are not fitted to materials."""
COUNTS = range(4, 17)
SMOOTH, SPIKY = ("A", "B", "C", "D65"), ("FL2", "FL7", "FL11")

Errors = Mapping[tuple[str, int], ColourErrors]
"""By method and number of wavelengths."""


@dataclass(frozen=True, eq=False)
class Comparison:
    """Errors on all materials, fitted to them, and on every second one, fitted to the others."""

    lights: tuple[str, ...]
    known: Errors
    unseen: Errors

    @property
    def by_materials(self) -> dict[str, Errors]:
        """The two tests by the name of their materials."""
        return {"unseen": self.unseen, "all": self.known}


def compare(materials: Array, lights: tuple[str, ...]) -> Comparison:
    """Evaluate all methods with every number of wavelengths, under several lights at once."""
    setup = make_setup(materials, lights)
    odd = np.arange(len(materials)) % 2 == 1
    keys = [(method, count) for count in COUNTS for method in METHODS]
    known = {(method, count): choose(setup, count=count, method=method).errors for method, count in keys}
    unseen = {(method, count): _held_out(setup, odd, method, count) for method, count in keys}
    return Comparison(lights, known, unseen)


def _held_out(setup: RenderSetup, odd: Array, method: str, count: int) -> ColourErrors:
    """Evaluate on the odd materials. Methods that are not fitted get these, which favours Meyer's allocation."""
    tested = setup.only(odd)
    return evaluate(tested, METHODS[method](tested if method in OTHERS else setup.only(~odd), count))


def gains(errors: Errors) -> Array:
    """Return the ratio of the best other method's mean to the optimised one's, for every number of wavelengths."""
    return np.array(
        [min(errors[other, count].mean for other in OTHERS) / errors[OPTIMISED, count].mean for count in COUNTS]
    )


def rows(comparison: Comparison) -> Iterator[dict[str, Any]]:
    """Yield [mean, 95th percentile, largest] ΔE00 of every method."""
    for materials, errors in comparison.by_materials.items():
        for count, gain in zip(COUNTS, gains(errors).tolist(), strict=True):
            cells = {method: errors[method, count] for method in METHODS}
            yield {
                "lights": ", ".join(comparison.lights),
                "materials": materials,
                "count": count,
                "errors": {name: [float(one.mean), float(one.p95), float(one.max)] for name, one in cells.items()},
                "gain": gain,
            }


def summary(comparison: Comparison) -> Iterator[dict[str, Any]]:
    """Yield the ratios, and the fewest wavelengths for a mean of 1; None if 16 do not reach it."""
    for materials, errors in comparison.by_materials.items():
        fitted = np.array([errors[FITTED, count].mean / errors[OPTIMISED, count].mean for count in COUNTS])
        yield {
            "lights": ", ".join(comparison.lights),
            "materials": materials,
            "other_gain": _ratios(gains(errors)),
            "fitted_gain": _ratios(fitted),
            "needed": {method: _fewest(errors, method) for method in METHODS},
        }


def _ratios(ratios: Array) -> dict[str, float]:
    lowest = int(ratios.argmin())
    return {
        "median": float(np.median(ratios)),
        "min": float(ratios[lowest]),
        "min_count": COUNTS[lowest],
        "max": float(ratios.max()),
    }


def _fewest(errors: Errors, method: str) -> int | None:
    return next((count for count in COUNTS if errors[method, count].mean <= 1), None)
