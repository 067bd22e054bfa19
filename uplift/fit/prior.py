"""The prior: the spectrum expected at a colour before it is fitted, and the standard error of that expectation."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields

import numpy as np
from numpy.typing import NDArray

from uplift.colorimetry.delta_e import delta_e_spectra, rgb_to_lab
from uplift.colorimetry.expected_error import LENGTH, ExpectedError, expected_error
from uplift.colorimetry.sensor import Light, Sensor
from uplift.common.arrays import Array, Mask
from uplift.fit.base import Base
from uplift.fit.corner_share import CornerShare
from uplift.fit.entries import FittedEntries
from uplift.fit.kriging import Kernel, Kriging, kernel_sums, krige
from uplift.fit.learn_kernel import DEFAULT, MIN_ENTRIES, learn_kernel, visible_change
from uplift.fit.problem import Problem
from uplift.fit.smooth import NO_FREEDOM, TABLE, Smooth, smooth
from uplift.fit.unrealisable import unrealisable
from uplift.models import Model, evaluate

MAX_PASSES = 32
MARGIN = 1e-3
"""Linear RGB between the starts of unrealisable colours and the boundary, where spectra become boxes."""
BLOCK_POINTS = 1 << 15
"""Points processed at a time."""
DETERMINED = Kernel(length=6.0, nugget=0.0)
"""Kernel where the colour alone determines the spectrum: it only chooses among solutions."""
NEIGHBOURHOOD = Kernel(length=LENGTH, nugget=0.0)
"""Weights of `ExpectedError`."""
SHRINK = 0.7
"""Factor of a deviation that leaves the space of valid coefficients or is `STEEP`, repeated until neither holds."""
MAX_SHRINKS = 16
STEEP = 100
"""Multipliers that a deviation must not exceed: beyond them a spectrum is nearly a box, which small changes of its
coefficients reshape."""


@dataclass(frozen=True, eq=False, repr=False)
class Prior:
    """Base spectra and, with an atlas, the interpolated deviation of its entries from them.

    Parameters
    ----------
    model : Model
        Spectrum model.
    sensor : Sensor
        RGB space of the colours.
    base : Base
        Spectra expected far from all entries.
    kriging : Kriging, optional
        Deviation of the coefficients of the atlas entries; None without an atlas.
    errors : ExpectedError, optional
        Expected squares of ΔE00; None for an atlas of fewer than 8 entries.
    left_out : ndarray, shape (E, N), optional
        Reflectance expected at the colour of each entry without it, in the order of the entries; None likewise.
    """

    model: Model
    sensor: Sensor
    base: Base
    kriging: Kriging | None = None
    errors: ExpectedError | None = None
    left_out: Array | None = None

    def __call__(self, rgb: Array) -> Array:
        """Multipliers (n, C) to start from at linear RGB (n, 3); at an entry, nearly those of the entry."""
        coefficients = self.base.coefficients(rgb)
        if self.kriging is None:
            return self.model.from_storage(coefficients)
        return _bounded(self.model, coefficients, self.kriging(rgb_to_lab(self.sensor, rgb)))

    @property
    def corner_share(self) -> CornerShare:
        """Share of an entry in the start of the corners of its cell, the rest is the prior; see `Starts`.

        Entries of an atlas with a small nugget are predicted by others. Materials of such an atlas between its entries
        are nearer to the prior, and only half of an entry's own deviation is expected at the corners. Corners of coarse
        lattices whose colour is another one start from the prior alone.
        """
        if self.kriging is None:
            return CornerShare(near=1.0)
        return CornerShare(near=(1 + min(self.kriging.kernel.nugget / DEFAULT.nugget, 1)) / 2)

    def describe(self) -> dict[str, float]:
        """Return the learnt parameters of the kriging, for the provenance of cubes.

        Returns
        -------
        dict
            ``length`` in CIE L*a*b* and ``nugget``, see `Kernel`, and ``error_bound``, in standard errors, if there are
            any; empty without an atlas.
        """
        bound = {} if self.errors is None else {"error_bound": self.errors.radii.ratio}
        return {} if self.kriging is None else asdict(self.kriging.kernel) | bound

    def standard_error(self, rgb: Array) -> Array | None:
        """Return the difference that 68 % of measurements are expected to have from answers.

        Parameters
        ----------
        rgb : ndarray, shape (n, 3)
            Linear RGB.

        Returns
        -------
        ndarray, shape (n,), or None
            ΔE00; None if the atlas is too small to estimate it.
        """
        if self.errors is None:
            return None
        lab = rgb_to_lab(self.sensor, rgb)
        sums = kernel_sums(lab, self.errors.locations, self.errors.columns, NEIGHBOURHOOD)
        squares = self.errors.combine(*sums)[:, 0] + self.errors.floor
        return np.asarray(self.errors.radii.standard * np.sqrt(squares))

    def standard_errors(self, problem: Problem) -> NDArray[np.float32] | None:
        """Return the standard error of every lattice point.

        Parameters
        ----------
        problem : Problem
            The lattice and its active points.

        Returns
        -------
        ndarray of float32, shape (dim³,), or None
            ΔE00, 0 at inactive points; None if the atlas is too small to estimate it.
        """
        if self.errors is None:
            return None
        lattice, active = problem.lattice, problem.points
        errors = np.zeros(lattice.size, dtype=np.float32)
        for first in range(0, len(active), BLOCK_POINTS):
            points = active[first : first + BLOCK_POINTS]
            errors[points] = self.standard_error(lattice.target(points))
        return errors


def smooth_base(problem: Problem, sensor: Sensor) -> Smooth:
    """Make the base of smooth spectra.

    Parameters
    ----------
    problem : Problem
        Spectrum model and solver.
    sensor : Sensor
        RGB space of the colours.

    Returns
    -------
    Smooth
        Smooth spectra of the realisable colours.
    """
    return smooth(problem.model, problem.forward, outside=unrealisable(TABLE, sensor, MARGIN))


def fit_prior(
    problem: Problem,
    sensor: Sensor,
    entries: FittedEntries,
    lights: Sequence[Light],
    error_light: Light,
    base: Base | None = None,
) -> Prior:
    """Fit the prior to atlas entries. The order of the entries does not change the rounding of sums.

    Parameters
    ----------
    problem : Problem
        Spectrum model and solver.
    sensor : Sensor
        RGB space of the colours.
    entries : FittedEntries
        Atlas entries.
    lights : sequence of Light
        Lights under which the prior should predict the colours of materials.
    error_light : Light
        Light of the standard errors.
    base : Base, optional
        Spectra expected far from all entries. Smooth spectra by default.

    Returns
    -------
    Prior
        The prior.
    """
    model, base = problem.model, base or smooth_base(problem, sensor)
    if not len(entries):
        return Prior(model, sensor, base)
    order = np.lexsort(entries.rgb.T)
    entries = FittedEntries(*(getattr(entries, key.name)[order] for key in fields(FittedEntries)))
    locations, expected = rgb_to_lab(sensor, entries.rgb), base.coefficients(entries.rgb)
    deviations = model.to_storage(entries.multipliers) - expected
    kernel = _kernel(problem, lights, entries.measured, locations, deviations)
    kriging, errors = krige(locations, deviations, kernel)
    if len(entries) < MIN_ENTRIES:
        return Prior(model, sensor, base, kriging)
    start = _bounded(model, expected, deviations - errors)
    left_out = problem.solve(entries.rgb, start, MAX_PASSES).multipliers
    spectra = evaluate(model, left_out, sensor.wavelengths)
    missed = delta_e_spectra(error_light, spectra, entries.measured)
    expected_errors = expected_error(locations, missed, entries.error)
    return Prior(model, sensor, base, kriging, expected_errors, spectra[np.argsort(order)])


def _kernel(problem: Problem, lights: Sequence[Light], measured: Array, locations: Array, deviations: Array) -> Kernel:
    """Learn the kernel, unless the colour alone determines the spectrum."""
    if problem.model.count == NO_FREEDOM:
        return DETERMINED
    visible = visible_change(problem.model, problem.forward, lights, measured)
    return learn_kernel(locations, deviations, visible)


def _bounded(model: Model, expected: Array, deviation: Array) -> Array:
    """Multipliers (n, C) of expected coefficients plus their deviation (n, C), shrunk as little as is necessary."""
    multipliers, usable = _try(model, expected + deviation)
    share = 1.0
    for _ in range(MAX_SHRINKS):
        outside = np.flatnonzero(~usable)
        if not outside.size:
            return multipliers
        share *= SHRINK
        multipliers[outside], usable[outside] = _try(model, expected[outside] + share * deviation[outside])
    multipliers[~usable] = model.from_storage(expected[~usable])
    return multipliers


def _try(model: Model, coefficients: Array) -> tuple[Array, Mask]:
    """Multipliers (n, C), and which rows are valid and not `STEEP`."""
    multipliers, valid = model.try_from_storage(coefficients)
    return multipliers, valid & (np.abs(multipliers).max(axis=1, initial=0) <= STEEP)
