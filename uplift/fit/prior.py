"""The prior: what is believed of a colour's spectrum before it is fitted, and how far that can be trusted."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from uplift.colorimetry.delta_e import delta_e_spectra, rgb_to_lab
from uplift.colorimetry.sensor import Light, Sensor
from uplift.common.arrays import Array
from uplift.fit.entries import FittedEntries
from uplift.fit.kriging import Kriging, Uncertainty, krige, uncertainty
from uplift.fit.problem import Problem
from uplift.fit.smooth import TABLE, Smooth, smooth
from uplift.fit.unrealisable import unrealisable
from uplift.models import evaluate

FEWEST = 8
"""Entries that it takes to say anything of errors."""
PASSES = 32
MARGIN = 1e-3
"""Linear RGB that starts of unrealisable colours keep from the boundary, where spectra turn into boxes."""
BLOCK = 1 << 15
"""Points worked on at a time."""


@dataclass(frozen=True, eq=False)
class Prior:
    """Smooth spectra and, with an atlas, how its entries deviate from them."""

    sensor: Sensor
    smooth: Smooth
    kriging: Kriging | None = None
    uncertainty: Uncertainty | None = None

    def __call__(self, rgb: Array) -> Array:
        """Multipliers (n, C) to start from at linear RGB (n, 3); at an entry's colour, the entry's own."""
        start = self.smooth(rgb)
        return start if self.kriging is None else start + self.kriging(rgb_to_lab(self.sensor, rgb))

    def standard_error(self, rgb: Array) -> Array | None:
        """ΔE00 (n,) by which answers at linear RGB (n, 3) miss measurements, as a root mean square.

        None where there are too few entries to learn it from.
        """
        return None if self.uncertainty is None else self.uncertainty(rgb_to_lab(self.sensor, rgb))

    def standard_errors(self, problem: Problem) -> NDArray[np.float32] | None:
        """`standard_error` (n,) of the points of a problem, block by block; 0 of points not wanted."""
        if self.uncertainty is None:
            return None
        lattice, wanted = problem.lattice, problem.points
        errors = np.zeros(lattice.size, dtype=np.float32)
        for first in range(0, len(wanted), BLOCK):
            points = wanted[first : first + BLOCK]
            errors[points] = self.standard_error(lattice.target(points))
        return errors


def fit_prior(problem: Problem, sensor: Sensor, entries: FittedEntries, light: Light) -> Prior:
    """Learn from the atlas; errors are ΔE00 under ``light``. Sums round alike in whatever order the entries come."""
    plain = smooth(problem.model, problem.forward, beyond=unrealisable(TABLE, sensor, MARGIN))
    if not len(entries.rgb):
        return Prior(sensor, plain)
    order = np.lexsort(entries.rgb.T)
    entries = FittedEntries(*(getattr(entries, key.name)[order] for key in fields(FittedEntries)))
    places = rgb_to_lab(sensor, entries.rgb)
    kriging, without = krige(places, entries.multipliers - plain(entries.rgb))
    if len(entries.rgb) < FEWEST:
        return Prior(sensor, plain, kriging)
    left_out = problem.solve(entries.rgb, plain(entries.rgb) + without, PASSES).multipliers
    spectra = evaluate(problem.model, left_out, sensor.wavelengths)
    missed = delta_e_spectra(light, spectra, entries.measured)
    return Prior(sensor, plain, kriging, uncertainty(places, missed, entries.error))
