"""Answers compared with those expected: ΔE00 under lights, and spectra.

Reports, checks, diffs and the conformance of other programs query other colours and
state other limits; all of them compare by these functions.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000, delta_e_spectra, lab
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array, Indices


def mean_p95_max(errors: Array) -> dict[str, float]:
    """Summarise errors by the mean, the value that 95 % stay within, and the largest
    value.
    """
    return {
        "mean": float(errors.mean()),
        "p95": float(np.quantile(errors, 0.95)),
        "max": float(errors.max()),
    }


@dataclass(frozen=True, eq=False)
class Comparison:
    """Differences between n answers and those expected, under L lights."""

    lights: tuple[str, ...]
    """Names of the lights."""
    delta_e: Array
    """(n, L) ΔE00; NaN where one of the two is missing."""

    @property
    def worst(self) -> Array:
        """(n,) largest ΔE00 under any light."""
        return self.delta_e.max(axis=1)

    @property
    def answered(self) -> Array:
        """(m, L) ΔE00 of the answers that are not missing."""
        return self.delta_e[~np.isnan(self.delta_e).any(axis=1)]

    @property
    def largest(self) -> float:
        """Largest ΔE00 of all, 0 of none."""
        return float(self.answered.max(initial=0.0))

    def by_light(self) -> list[dict[str, float]]:
        """Return the ΔE00 of each answer by the name of the light."""
        return [dict(zip(self.lights, row, strict=True)) for row in self.delta_e]

    def worst_light(self, row: int) -> str:
        """Return the light under which an answer differs most."""
        return self.lights[int(self.delta_e[row].argmax())]

    def worst_rows(self, count: int) -> Indices:
        """Return the rows of the largest ΔE00, largest first."""
        return np.argsort(-self.worst, kind="stable")[:count]

    def rows(self, tolerance: float | None = None) -> list[dict[str, Any]]:
        """Summarise the ΔE00 under each light, and count those above a tolerance."""
        rows = []
        for light, delta_e in zip(self.lights, self.answered.T, strict=True):
            if delta_e.size:
                row = {"light": light, **mean_p95_max(delta_e)}
                if tolerance is not None:
                    row["moved"] = int((delta_e > tolerance).sum())
                rows.append(row)
        return rows


@dataclass(frozen=True, eq=False)
class SpectraComparison(Comparison):
    """Differences between spectra, which have a reflectance at N wavelengths."""

    expected: Array
    """(n, N)."""
    answers: Array
    """(n, N)."""

    @property
    def rms(self) -> Array:
        """(n,) rms difference over wavelength."""
        return rms_difference(self.answers, self.expected)

    @property
    def deviation(self) -> Array:
        """(n,) largest absolute difference at any wavelength."""
        return np.abs(self.answers - self.expected).max(axis=1)

    def __getitem__(self, rows: Any) -> Self:
        arrays = (self.delta_e[rows], self.expected[rows], self.answers[rows])
        return type(self)(self.lights, *arrays)


def compare_spectra(
    expected: Array, answers: Array, lights: Sequence[Light]
) -> SpectraComparison:
    """Compare reflectances (n, N) at the wavelengths of the lights."""
    names = tuple(light.name for light in lights)
    delta_e = delta_e_under(lights, answers, expected)
    return SpectraComparison(names, delta_e, expected, answers)


def compare_colours(expected: Array, answers: Array, light: Light) -> Comparison:
    """Compare XYZ (n, 3) under a light."""
    delta_e = delta_e_2000(lab(answers, light.white), lab(expected, light.white))
    return Comparison((light.name,), delta_e[:, None])


def delta_e_under(lights: Iterable[Light], first: Array, second: Array) -> Array:
    """Compute ΔE00 (n, L) under lights between reflectances (n, N)."""
    return np.stack([delta_e_spectra(light, first, second) for light in lights], axis=1)


def rms_difference(first: Array, second: Array) -> Array:
    """Compute the rms difference (n,) between reflectances (n, N)."""
    return np.sqrt(((first - second) ** 2).mean(axis=1))
