"""Colour errors on test colours under the lights of the scene: of any XYZ, of few wavelengths, of RGB times light."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from uplift.colorimetry import Light, Sensor, delta_e_2000, lab
from uplift.colorimetry.delta_e import delta_e_2000_weights, lab_jacobian
from uplift.common.arrays import Array, Indices
from uplift.common.progress import Progress, ProgressCallback
from uplift.lookup import Cube
from uplift.scene.wavelengths import Sampling, choose, make_setup

TEXTURES, MATERIALS = "textures", "materials"
WORST_DELTA_E = 100.0
"""ΔE00 of colours that are not finite: the difference between black and white."""
FEW = 200
"""Colours of each group that wavelengths are fitted to."""
DIGITS = 2
"""Decimals of a wavelength in nm, so that the measured wavelengths are those of the command line."""


@dataclass(frozen=True)
class GroupError:
    """ΔE00 of a group under one light: weighted mean, the quantile of the scene, and the largest."""

    group: str
    light: str
    mean: float
    quantile: float
    largest: float


@dataclass(frozen=True)
class ErrorSummary:
    """Errors of a candidate: one part for every group under every light."""

    parts: tuple[GroupError, ...]

    @property
    def worst(self) -> GroupError:
        """The part of the largest quantile, which decides."""
        return max(self.parts, key=lambda part: part.quantile)

    @property
    def quantile(self) -> float:
        """Quantile of the worst part, ΔE00."""
        return self.worst.quantile


@dataclass(frozen=True, eq=False)
class Rendering:
    """Wavelengths that a renderer traces, and the ``error`` of the spectra of the reference there."""

    sampling: Sampling
    error: ErrorSummary

    @property
    def name(self) -> str:
        """Short text."""
        return f"{len(self.sampling)} wavelengths"


@dataclass(frozen=True, eq=False)
class EvaluationSet:
    """Test colours with their reference spectra, and the lights to compare them under, on the grid of the spectra.

    Linear RGB (n, 3), reference spectra (n, N), and weights (n,) whose sum is 1 in each group, a slice of the rows with
    one statistic. ``quantile`` is the share of the colours whose largest ΔE00 is the error of a group.
    """

    rgb: Array
    reflectances: Array
    weights: Array
    groups: Mapping[str, slice]
    lights: tuple[Light, ...]
    quantile: float

    @cached_property
    def lab(self) -> list[Array]:
        """CIE L*a*b* (n, 3) of the reference spectra under each light."""
        return [lab(xyz, light.white) for xyz, light in zip(self.xyz(self.reflectances), self.lights, strict=True)]

    def xyz(self, reflectances: Array) -> Array:
        """XYZ (K, n, 3) of reflectances (n, N) on the grid of the lights, where white has Y = 1."""
        return np.stack([reflectances @ light.xyz.T for light in self.lights])

    def subsample(self, count: int) -> Indices:
        """Rows of at most ``count`` colours of each group, drawn at equal steps of the cumulative weight."""
        found = []
        for rows in self.groups.values():
            drawn, size = np.arange(rows.start, rows.stop), rows.stop - rows.start
            if size > count:
                steps = np.searchsorted(np.cumsum(self.weights[rows]), (np.arange(count) + 0.5) / count)
                drawn = drawn[np.unique(np.minimum(steps, size - 1))]
            found.append(drawn)
        return np.concatenate(found)

    def error(self, xyz: Sequence[Array] | Array) -> ErrorSummary:
        """Errors of XYZ (n, 3) under each light, where white has Y = 1."""
        parts = []
        for light, reference, values in zip(self.lights, self.lab, xyz, strict=True):
            difference = delta_e_2000(reference, lab(values, light.white))
            delta_e = np.where(np.isfinite(difference), difference, WORST_DELTA_E)
            for name, rows in self.groups.items():
                errors, weights = delta_e[rows], self.weights[rows]
                quantile = np.quantile(errors, self.quantile, weights=weights, method="inverted_cdf")
                mean, largest = float(errors @ weights), float(errors.max())
                parts.append(GroupError(name, light.name, mean, float(quantile), largest))
        return ErrorSummary(tuple(parts))

    def matrices(self) -> Array:
        """Matrices (K, 3, 3) from linear RGB to XYZ under each light: least squares of small differences in ΔE00."""
        weight = np.sqrt(self.weights)[:, None, None]
        found = []
        for light, reference, xyz in zip(self.lights, self.lab, self.xyz(self.reflectances), strict=True):
            # ΔE00 ≈ |F (M r − x)|
            factor = weight * (delta_e_2000_weights(reference) @ lab_jacobian(xyz, light.white))
            design = np.einsum("nij,nl->nijl", factor, self.rgb).reshape(-1, 9)
            target = np.einsum("nij,nj->ni", factor, xyz).ravel()
            found.append(np.linalg.lstsq(design, target, rcond=None)[0].reshape(3, 3))
        return np.stack(found)


def renderings(
    counts: Sequence[int],
    sensor: Sensor,
    tests: EvaluationSet,
    reference: Cube,
    floor: float,
    progress: ProgressCallback,
) -> list[Rendering]:
    """Fit wavelengths, of ``counts`` in ascending order, up to an error of ``floor``; without it, all wavelengths.

    Those that do not lower the error are left out.
    """
    fitted, lights = tests.reflectances[tests.subsample(FEW)], [light.name for light in tests.lights]
    setup = make_setup(fitted, lights, wavelengths=sensor.wavelengths, observer_name=sensor.observer)
    found, smallest = list[Rendering](), np.inf
    for done, count in enumerate((*counts, None)):
        progress(Progress("wavelengths", done, len(counts)))
        if count is None:
            sampling = Sampling(setup.wavelengths, setup.cmfs, setup.lights, setup.powers)
        else:
            sampling = _rounded(choose(setup, count=count).sampling)
        error = tests.error(sampling.xyz(reference.reflectance(tests.rgb, sampling.wavelengths)))
        if error.quantile < smallest:
            found.append(Rendering(sampling, error))
            smallest = error.quantile
        if smallest <= floor:
            break
    return found


def _rounded(sampling: Sampling) -> Sampling:
    """Round wavelengths to `DIGITS`, all distinct."""
    steps = np.arange(len(sampling)) / 10**DIGITS
    distinct = np.maximum.accumulate(np.round(sampling.wavelengths, DIGITS) - steps) + steps
    return replace(sampling, wavelengths=np.round(distinct, DIGITS))
