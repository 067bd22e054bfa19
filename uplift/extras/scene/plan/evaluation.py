"""Colour errors on test colours under the lights of the scene: of any XYZ, of few
wavelengths, of RGB times light.
"""

import contextlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from uplift.colorimetry.delta_e import delta_e_2000, delta_e_2000_weights, lab_jacobian
from uplift.colorimetry.observer import DEFAULT_OBSERVER, illuminant_spd
from uplift.common.arrays import Array, Indices, Mask
from uplift.common.errors import OptionError
from uplift.common.progress import Progress, ProgressCallback
from uplift.extras.papers.representations import samples
from uplift.extras.papers.representations.registry import all_representations
from uplift.extras.papers.representations.samples import Representation
from uplift.extras.papers.wavelengths.choice import choose
from uplift.extras.papers.wavelengths.sampling import (
    RenderSetup,
    Sampling,
    interp_curves,
)
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
MAX_MEYER = 12
"""Meyer's wavelengths that are tried; more take long."""
FAMILIES = ("PS", "PF", "RS", "RE", "CS", "GQ", "LM")
"""Representations that are tried: no models, which cubes have, and none with noise."""


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


UNMEASURED = ErrorSummary(())


@dataclass(frozen=True, eq=False)
class Rendering:
    """Numbers that a renderer traces in place of a spectrum, and the ``error`` of the
    spectra of the reference.

    ``samples`` of a ray, ``operations`` of a product of light and surface with its
    share in the sum to XYZ, numbers of a ``surface``, and ``xyz``, from reflectances
    (n, W) at ``wavelengths`` (W,) in nm to XYZ (K, n, 3) under the lights. ``sampling``
    is None for representations that are not wavelengths.
    """

    name: str
    samples: float
    operations: float
    surface: float
    wavelengths: Array
    xyz: Callable[[Array], Array]
    sampling: Sampling | None = None
    error: ErrorSummary = UNMEASURED

    @classmethod
    def of_sampling(cls, name: str, sampling: Sampling) -> "Rendering":
        """Return the rendering with the wavelengths of a sampling, rounded to `DIGITS`
        and all distinct.
        """
        count = len(sampling)
        steps = np.arange(count) / 10**DIGITS
        rounded_nm = np.round(sampling.wavelengths, DIGITS)
        distinct = np.maximum.accumulate(rounded_nm - steps) + steps
        nm = np.round(distinct, DIGITS)
        rounded = replace(sampling, wavelengths=nm)
        return cls(
            f"{count} {name}",
            count,
            SAMPLE_OPERATIONS * count,
            count,
            nm,
            rounded.xyz,
            rounded,
        )


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


def renderings(
    counts: Sequence[int],
    tests: EvaluationSet,
    floor: float,
    progress: ProgressCallback,
    others: str | None,
) -> list[Rendering]:
    """Fit wavelengths, of ``counts`` in ascending order, up to an error of ``floor``;
    all of them if none reaches it.

    Those that do not lower the error are left out. Meyer's wavelengths and other
    representations follow for an observer of that name, ``others``, unless another
    rendering costs no more and is as accurate.
    """

    def measured(rendering: Rendering) -> Rendering:
        nm = rendering.wavelengths
        xyz = rendering.xyz(tests.reference.reflectance(tests.rgb, nm))
        return replace(rendering, error=tests.error(xyz))

    def numbers(rendering: Rendering) -> tuple[float, ...]:
        costs = rendering.samples, rendering.operations, rendering.surface
        return *costs, max(rendering.error.quantile, floor)

    setup = tests.setup.only(tests.subsample(FEW))
    full = Sampling(setup.wavelengths, setup.cmfs, setup.lights, setup.powers)
    kept = list[Rendering]()
    for done, count in enumerate((*counts, None)):
        progress(Progress("wavelengths", done, len(counts)))
        sampling = full if count is None else choose(setup, count=count).sampling
        rendering = measured(Rendering.of_sampling("wavelengths", sampling))
        if not kept or rendering.error.quantile < kept[-1].error.quantile:
            kept.append(rendering)
        if kept[-1].error.quantile <= floor:
            break
    for other in _others(setup, tests, others) if others else ():
        if other.samples < kept[-1].samples:
            rendering = measured(other)
            rows = np.array([*map(numbers, kept), numbers(rendering)])
            if not dominated(rows[-1:], rows[:-1])[0]:
                kept.append(rendering)
    return kept


def dominated(rows: Array, by: Array) -> Mask:
    """Rows (m, k) for which a row of ``by`` (f, k) is nowhere larger."""
    return np.asarray((by[:, None] <= rows).all(axis=2).any(axis=0))


def _others(
    setup: RenderSetup, tests: EvaluationSet, observer_name: str
) -> Iterator[Rendering]:
    """Meyer's wavelengths, and representations, which are defined for one observer."""
    for count in range(4, MAX_MEYER + 1):
        with contextlib.suppress(OptionError):  # no rule of this order
            sampling = choose(setup, count=count, method="meyer").sampling
            yield Rendering.of_sampling("wavelengths of Meyer", sampling)
    if observer_name != DEFAULT_OBSERVER:
        return
    powers = np.stack(
        [illuminant_spd(light, step=samples.STEP) for light in setup.illuminants]
    )
    powers /= powers @ samples.xyz_weights()[:, 1:2]
    surfaces = interp_curves(
        samples.wavelengths(), setup.wavelengths, setup.reflectances
    )
    for representation in all_representations(powers, surfaces):
        if representation.name[:2] in FAMILIES:
            light, surface = representation.numbers(powers, surfaces)
            xyz = partial(_represented_xyz, representation, powers, tests)
            yield Rendering(
                representation.name,
                light,
                surface + 6 * light,
                surface,
                samples.wavelengths(),
                xyz,
            )


def _represented_xyz(
    representation: Representation,
    powers: Array,
    tests: EvaluationSet,
    reflectances: Array,
) -> Array:
    """XYZ (K, n, 3) of dense reflectances (n, 401): those of the 5 nm table, and what
    the representation changes.
    """
    represented = representation.reflected(powers, reflectances)
    exact = (powers[:, None] * reflectances) @ samples.xyz_weights()
    return tests.xyz(reflectances[:, :: samples.TABLE_STRIDE]) + represented - exact
