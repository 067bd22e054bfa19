"""The prior: the spectrum expected at a colour before it is fitted, and the standard
error of that expectation.

p(x) = s(x) + k(x) d(x), the base spectrum and the kriged deviation of the entries from
it (docs/mathematics.md, 7). Moments are linear in the spectrum, and so is the colour
under another light: deviations are those of coefficients.
"""

from dataclasses import dataclass, replace

import numpy as np

from uplift.colorimetry.delta_e import delta_e_spectra, rgb_to_lab
from uplift.colorimetry.likely_errors import LENGTH, ExpectedError, expected_error
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array, Mask, largest
from uplift.fit.base import Base, learn_base
from uplift.fit.entries import FittedEntries
from uplift.fit.kernel_learning import MIN_ENTRIES, learn_kriging, visible_change
from uplift.fit.kriging import Kernel, Kriging, kernel_sums, krige
from uplift.fit.problem import Problem
from uplift.lattice.lattice import Lattice
from uplift.models.brightness import brightness
from uplift.models.duality import MAX_MULTIPLIER
from uplift.models.model import Model, evaluate, reflectance
from uplift.models.moments import Moments, moment_matrix

MAX_PASSES = 32
DETERMINED = Kernel(length=6.0, noise=1e-3)
"""Kernel where the colour alone determines the spectrum: it only chooses among
solutions.
"""
FRACTIONS = np.multiply.accumulate(np.full(16, 0.7))
"""Parts of a deviation that are tried where all of it leaves the space of valid
coefficients or is `STEEP`. The largest that does neither counts.
"""
STEEP = 100
"""Multipliers that a deviation must not exceed: beyond them a spectrum is nearly a box,
which small changes of its coefficients reshape.
"""

FLAT_CHROMA = (4.0, 12.0)
"""CIE L*a*b* chroma up to which, and to the cells of greys, `Prior.with_flat_greys`
applies, and where it has ended.
"""
FLAT_LEVELS = (5e-5, 1 - 5e-5)
"""Limits of flat reflectances, as 0 and 1 have no multipliers."""


@dataclass(frozen=True, eq=False, repr=False)
class Prior:
    """Base spectra and, with an atlas, the kriged deviation of its entries from them.

    ``errors`` are the expected squares of ΔE00, and ``left_out`` (E, N) the
    reflectances expected at the colours of the entries without them, in their order;
    both None for an atlas of fewer than 8 entries. ``shares`` (3, C) are the
    coefficients of spectra of the primaries that sum to 1, after `with_flat_greys`,
    else None. ``surprise`` (E,) is the largest ΔE00 between each entry and what is
    expected without it, under the lights of the build; None likewise.
    """

    model: Model
    sensor: Sensor
    base: Base
    kriging: Kriging | None = None
    errors: ExpectedError | None = None
    left_out: Array | None = None
    shares: Array | None = None
    surprise: Array | None = None

    def __call__(self, rgb: Array) -> Array:
        """Multipliers (n, C) expected at linear RGB (n, 3)."""
        coefficients = self.base.coefficients(rgb)
        if self.kriging is None:
            return self.model.from_storage(coefficients)
        # c = s(x) + k d(x), as multipliers
        deviation = brightness(rgb) * self.kriging(rgb_to_lab(self.sensor, rgb))
        return _bounded(self.model, coefficients, deviation)

    def at_nodes(self, lattice: Lattice, rgb: Array) -> Array:
        """Multipliers (n, C) expected at nodes that are fitted to linear RGB (n, 3)."""
        multipliers = self(rgb)
        if self.shares is None:
            return multipliers
        chroma = np.hypot(*rgb_to_lab(self.sensor, rgb)[:, 1:].T)
        weight = np.maximum(
            np.interp(chroma, FLAT_CHROMA, (1, 0)),
            np.ptp(lattice.to_steps(rgb), axis=1) < 1.5,
        )
        near = weight > 0
        grey = np.clip(self.sensor.grey(rgb), *FLAT_LEVELS)
        # y + Σ (x_i − y) b_i with Σ b_i = 1, of the grey y of x: flat for greys, linear
        # in x and so flat between nodes
        flat = grey[near, :1] * self.model.constant()
        deviation = (rgb - grey)[near] @ self.shares
        start = _bounded(self.model, flat, deviation, MAX_MULTIPLIER)
        multipliers[near] = blended(self.model, start, multipliers[near], weight[near])
        return multipliers

    def with_flat_greys(self) -> "Prior":
        """Return a prior that expects flat spectra at and near greys; itself for models
        that have no choice.

        Mallett & Yuksel 2019, "Spectral primary decomposition for rendering with sRGB
        reflectance".
        """
        if self.model.is_determined or not isinstance(self.model, Moments):
            return self
        primaries = reflectance(
            self.model, self.base.coefficients(np.eye(3)), self.sensor.wavelengths
        )
        shares = primaries / primaries.sum(axis=0)
        return replace(
            self, shares=shares @ moment_matrix(self.model, self.sensor.wavelengths)
        )

    def standard_error(self, rgb: Array) -> Array | None:
        """ΔE00 (n,) within which 68 % of measurements are expected to lie from answers
        to linear RGB (n, 3).

        None if the atlas is too small to estimate it.
        """
        if self.errors is None:
            return None
        # As many columns as kriging has, so that one program is compiled for both
        errors = self.errors
        used = errors.columns.shape[1]
        columns = np.pad(errors.columns, ((0, 0), (0, self.model.count - used)))
        lab = rgb_to_lab(self.sensor, rgb)
        kernel = Kernel(LENGTH, 0.0)
        none = np.zeros(len(columns))
        sums, nearest = kernel_sums(lab, errors.locations, columns, kernel, none)
        # Expected square v(x) Σ k e² / Σ k + f, and the learnt radius of 68 % in its
        # root
        spread = errors.combine(sums[:, :used], np.exp(nearest / -LENGTH))[:, 0]
        standard, _ = errors.radii
        return standard * np.sqrt(spread + errors.floor)


def fit_prior(
    problem: Problem,
    entries: FittedEntries,
    base: Base | None = None,
    trust: float | None = None,
) -> Prior:
    """Fit the prior to atlas entries; the base is that of smooth spectra by default.

    The trust in the atlas is learnt if it is not given. The order of the entries does
    not change the rounding of sums.
    """
    model = problem.model
    sensor = problem.sensor
    base = base or learn_base(problem)[0]
    if not len(entries.rgb):
        return Prior(model, sensor, base)
    order = np.lexsort(entries.rgb.T)
    entries = entries.rows(order)
    locations = rgb_to_lab(sensor, entries.rgb)
    deviations, expected = deviations_of(model, base, entries)
    if model.is_determined:
        kriging, errors = krige(locations, deviations, DETERMINED)
    else:
        factor = brightness(entries.rgb)[:, None, None]
        visible = visible_change(problem, entries.measured) * factor
        kriging, errors = learn_kriging(locations, deviations, visible, trust)
    if len(entries.rgb) < MIN_ENTRIES:
        return Prior(model, sensor, base, kriging)
    # Each entry as the others predict it: its deviation less its leave-one-out error,
    # moved to its exact colour.
    start = _bounded(model, expected, brightness(entries.rgb) * (deviations - errors))
    left_out = problem.solve(entries.rgb, start, MAX_PASSES).multipliers
    spectra = evaluate(model, left_out, sensor.wavelengths)
    missed = delta_e_spectra(problem.light_of_errors, spectra, entries.measured)
    back = np.argsort(order)
    surprise = None
    if problem.lights:
        changes = [
            delta_e_spectra(light, spectra, entries.measured)
            for light in problem.lights
        ]
        surprise = np.max(changes, axis=0)[back]
    return Prior(
        model,
        sensor,
        base,
        kriging,
        errors=expected_error(locations, missed, entries.error),
        left_out=spectra[back],
        surprise=surprise,
    )


def deviations_of(
    model: Model, base: Base, entries: FittedEntries
) -> tuple[Array, Array]:
    """Deviations d_i = (c_i − s(x_i)) / k(x_i) (E, C), relative to the brightening as
    those of families, and s(x_i).
    """
    expected = base.coefficients(entries.rgb)
    deviations = model.to_storage(entries.multipliers) - expected
    return deviations / brightness(entries.rgb), expected


def blended(model: Model, own: Array, expected: Array, weight: Array) -> Array:
    """Multipliers (n, C) of c = w c_own + (1 − w) c_expected, with weights (n,):
    coefficients mix as spectra do.
    """
    multipliers = np.where(weight[:, None] == 1, own, expected)
    mixed = (weight > 0) & (weight < 1)
    share = weight[mixed, None]
    own_coefficients = model.to_storage(own[mixed])
    expected_coefficients = model.to_storage(expected[mixed])
    coefficients = share * own_coefficients + (1 - share) * expected_coefficients
    multipliers[mixed] = model.from_storage(coefficients)
    return multipliers


def _bounded(
    model: Model, expected: Array, deviation: Array, steep: float = STEEP
) -> Array:
    """Multipliers (n, C) of expected coefficients plus their deviation (n, C), shrunk
    as little as is necessary.
    """

    def convert(coefficients: Array) -> tuple[Array, Mask]:
        multipliers, valid = model.try_from_storage(coefficients)
        return multipliers, valid & (largest(np.abs(multipliers)) <= steep)

    multipliers, kept = convert(expected + deviation)
    rows = np.flatnonzero(~kept)
    # c = s + f d with the largest of the fractions f that will do, all of them at once;
    # s alone where none does
    shrunk = expected[rows, None] + FRACTIONS[:, None] * deviation[rows, None]
    trials, kept = convert(shrunk.reshape(-1, model.count))
    trials = trials.reshape(shrunk.shape)
    kept = kept.reshape(shrunk.shape[:2])
    multipliers[rows] = trials[np.arange(len(rows)), kept.argmax(axis=1)]
    none = rows[~kept.any(axis=1)]
    multipliers[none] = model.from_storage(expected[none])
    return multipliers
