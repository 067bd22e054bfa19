"""Colour errors on test colours under the lights of the scene: of any XYZ, of few
wavelengths, of RGB times light.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000, delta_e_2000_weights, lab_jacobian
from uplift.common.arrays import Array, Indices
from uplift.common.progress import Progress, ProgressCallback
from uplift.common.text import pluralise
from uplift.extras.papers.wavelengths.choice import choose
from uplift.extras.papers.wavelengths.sampling import RenderSetup, Sampling
from uplift.lookup.cube import Cube

WORST_DELTA_E = 100.0
"""ΔE00 of colours that are not finite: the difference between black and white."""
FEW = 200
"""Colours of each group that wavelengths are fitted to."""
DIGITS = 2
"""Decimals of a wavelength in nm, so that the measured wavelengths are those of the
command line.
"""
SAMPLE_OPERATIONS = 7
"""Operations for a product of light and surface at one wavelength, and its share in the
sum to XYZ.
"""


@dataclass(frozen=True)
class GroupError:
    """ΔE00 of a group under one light: weighted mean, the quantile of the scene, and
    the largest.
    """

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

    @property
    def quantiles(self) -> Array:
        """Quantiles of all parts."""
        return np.array([part.quantile for part in self.parts])


UNMEASURED = ErrorSummary(())


@dataclass(frozen=True, eq=False)
class Rendering:
    """Wavelengths that a renderer traces in place of a spectrum, and the ``error`` of
    the spectra of the reference.
    """

    sampling: Sampling
    error: ErrorSummary = UNMEASURED

    @property
    def name(self) -> str:
        """Short text."""
        return pluralise(self.samples, "wavelength")

    @property
    def samples(self) -> int:
        """Numbers of a ray, and of a surface."""
        return len(self.sampling)

    @property
    def operations(self) -> int:
        """Operations of all products of light and surface, and of the sum to XYZ."""
        return SAMPLE_OPERATIONS * self.samples


@dataclass(frozen=True, eq=False)
class EvaluationSet:
    """Test colours: n spectra under the lights of the scene, linear RGB (n, 3), and
    weights (n,).

    The spectra are those of the ``reference``, or measured. Weights have the sum 1 in
    each group, a slice of the rows with one statistic. ``quantile`` is the share of the
    colours whose largest ΔE00 is the error of a group.
    """

    reference: Cube
    setup: RenderSetup
    rgb: Array
    weights: Array
    groups: Mapping[str, slice]
    quantile: float

    def xyz(self, reflectances: Array) -> Array:
        """XYZ (K, n, 3) of reflectances (n, N) on the grid of the lights, where white
        has Y = 1.
        """
        return replace(self.setup, reflectances=reflectances).xyz

    def subsample(self, count: int) -> Indices:
        """Rows of at most ``count`` colours of each group, drawn at equal steps of the
        cumulative weight.
        """
        subsamples = []
        for rows in self.groups.values():
            drawn = np.arange(rows.start, rows.stop)
            size = rows.stop - rows.start
            if size > count:
                steps = np.searchsorted(
                    np.cumsum(self.weights[rows]), (np.arange(count) + 0.5) / count
                )
                drawn = drawn[np.unique(np.minimum(steps, size - 1))]
            subsamples.append(drawn)
        return np.concatenate(subsamples)

    def error(self, xyz: Array) -> ErrorSummary:
        """Errors of XYZ (K, n, 3) under the lights, where white has Y = 1."""
        parts = []
        differences = delta_e_2000(self.setup.lab, self.setup.to_lab(xyz))
        for light, difference in zip(self.setup.lights, differences, strict=True):
            delta_e = np.where(np.isfinite(difference), difference, WORST_DELTA_E)
            for name, rows in self.groups.items():
                errors = delta_e[rows]
                weights = self.weights[rows]
                quantile = np.quantile(
                    errors, self.quantile, weights=weights, method="inverted_cdf"
                )
                values = map(float, (errors @ weights, quantile, errors.max()))
                parts.append(GroupError(name, light, *values))
        return ErrorSummary(tuple(parts))

    def matrices(self) -> Array:
        """Matrices (K, 3, 3) from linear RGB to XYZ under each light: least squares of
        small differences in ΔE00.
        """
        xyz = self.setup.xyz
        whites = self.setup.whites[:, None]
        # ΔE00 ≈ |F (M r − x)|
        factors = delta_e_2000_weights(self.setup.lab) @ lab_jacobian(xyz, whites)
        factors *= np.sqrt(self.weights)[:, None, None]
        designs = np.einsum("knij,nl->knijl", factors, self.rgb).reshape(
            len(xyz), -1, 9
        )
        targets = np.einsum("knij,knj->kni", factors, xyz).reshape(len(xyz), -1)
        pairs = zip(designs, targets, strict=True)
        return np.stack(
            [np.linalg.lstsq(*pair, rcond=None)[0].reshape(3, 3) for pair in pairs]
        )


def fit_renderings(
    counts: Sequence[int],
    tests: EvaluationSet,
    floor: float,
    progress: ProgressCallback,
) -> list[Rendering]:
    """Fit wavelengths, of ``counts`` in ascending order, up to an error of ``floor``;
    all of them if none reaches it. Those that do not lower the error are left out.
    """
    setup = tests.setup.only(tests.subsample(FEW))
    everything = Sampling(setup.wavelengths, setup.cmfs, setup.lights, setup.powers)
    kept = list[Rendering]()
    for done, count in enumerate((*counts, None)):
        progress(Progress("wavelengths", done, len(counts)))
        chosen = everything if count is None else choose(setup, count=count).sampling
        sampling = _rounded(chosen)
        spectra = tests.reference.reflectance(tests.rgb, sampling.wavelengths)
        error = tests.error(sampling.xyz(spectra))
        if not kept or error.quantile < kept[-1].error.quantile:
            kept.append(Rendering(sampling, error))
        if kept[-1].error.quantile <= floor:
            break
    return kept


def _rounded(sampling: Sampling) -> Sampling:
    """Round wavelengths to `DIGITS`, all distinct."""
    steps = np.arange(len(sampling)) / 10**DIGITS
    rounded = np.round(sampling.wavelengths, DIGITS)
    distinct = np.maximum.accumulate(rounded - steps) + steps
    return replace(sampling, wavelengths=np.round(distinct, DIGITS))
