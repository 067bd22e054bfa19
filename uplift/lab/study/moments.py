"""Loss of trigonometric moments: four techniques and several counts, measured on
atlases.

Every measured spectrum is reduced to its moments, reconstructed, and compared with the
measurement, as in Tódová 2020, *Constrained Spectral Uplifting*, table 4.1, sections
2.2.1 and 4.1.1, and appendix B.1.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product, starmap
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from uplift.atlas import Atlas, merge, on_grid
from uplift.colorimetry import delta_e_1976, delta_e_2000, lab, observer
from uplift.common.arrays import Array, Complex, Indices
from uplift.common.errors import AtlasError, OptionError
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.extras.colour.light_sets import REPORT_LIGHTS
from uplift.extras.scene.representations import samples
from uplift.models import Moments, duality


@dataclass(frozen=True)
class Technique:
    """A mapping of the spectrum to the circle.

    ``mirrored``: map [start, end] nm to the half circle [−π, 0] and mirror it, which
    makes the moments real.
        Otherwise the range covers the circle [−π, π], and its two ends meet.
    ``warped``: warp the phase towards wavelengths to which the eye is sensitive, by the
    ``warp`` of this name.
    """

    mirrored: bool
    warped: bool
    warp: str = "vision"

    @property
    def short(self) -> str:
        """Abbreviation of the thesis: M&W, M&nW, nM&W or nM&nW."""
        return f"{'' if self.mirrored else 'n'}M&{'' if self.warped else 'n'}W"

    @property
    def label(self) -> str:
        """Full name, such as ``mirrored, warped``."""
        mirrored = "mirrored" if self.mirrored else "unmirrored"
        return f"{mirrored}, {'warped' if self.warped else 'unwarped'}"

    def floats(self, moments: int) -> int:
        """Real numbers stored per spectrum."""
        return moments + 1 if self.mirrored else 2 * moments + 1

    def phase(self, wavelengths: ArrayLike) -> Array:
        """Phases (N,) of wavelengths (N,)."""
        half = Moments(warp=self.warp if self.warped else "none").phase(wavelengths)
        return half if self.mirrored else 2 * half + np.pi

    def moments(
        self, reflectance: Array, wavelengths: ArrayLike, moments: int
    ) -> Complex | Array:
        """Moments (n, moments + 1) of reflectances (n, N), exact for the interpolant
        that is linear in the phase.

        Samples within [0, 1] have moments of a reflectance.
        """
        phase = self.phase(wavelengths)
        # Integrals of g exp(−ijφ) dφ by parts, twice: a term of the two ends, and the
        # slopes of g times the change of exp(−ijφ) in each interval.
        orders = np.arange(1, moments + 1)
        turn = np.exp(-1j * phase[:, None] * orders)
        ends = reflectance[:, -1:] * turn[-1] - reflectance[:, :1] * turn[0]
        slopes = np.diff(reflectance, axis=1) / np.diff(phase)
        integrals = np.empty((len(reflectance), moments + 1), dtype=complex)
        integrals[:, 0] = np.trapezoid(reflectance, phase, axis=1)
        integrals[:, 1:] = (
            1j * ends / orders + slopes @ np.diff(turn, axis=0) / orders**2
        )
        on_circle = integrals / np.ptp(phase)
        return np.ascontiguousarray(on_circle.real) if self.mirrored else on_circle

    def reconstruct(self, moments: Complex | Array, wavelengths: ArrayLike) -> Array:
        """Bounded maximum-entropy reflectances (n, N) of moments (n, C)."""
        solve = (
            duality.try_multipliers
            if self.mirrored
            else duality.try_complex_multipliers
        )
        multipliers = duality.multipliers_from_moments(moments, solve)
        waves = duality.fourier_basis(self.phase(wavelengths), moments.shape[1])
        return 0.5 + np.arctan((multipliers @ waves.T).real) / np.pi


TECHNIQUES = tuple(starmap(Technique, product((True, False), repeat=2)))
"""All techniques, in the order of the tables of the thesis."""


MAX_MOMENTS = 32
"""Largest number of cosines that a 5 nm grid still resolves."""
MEASURES = ("delta_e_76_D65", *(f"delta_e_00_{name}" for name in REPORT_LIGHTS), "rms")
"""Error measures: ΔE76 under D65 as in the thesis, ΔE00 under every light, rms
difference of the spectra.
"""
ALL_ATLASES = "all"
"""Name of the group of all entries."""


class MomentsResult(NamedTuple):
    """Mean and largest errors (len(MEASURES),) of a group, and the entry with the
    largest ΔE76.
    """

    mean: Array
    max: Array
    worst: int


@dataclass(frozen=True, eq=False)
class MomentsStudy:
    """Errors of every entry for every technique and number of moments.

    ``names``, ``atlases``: names and atlases of the E entries. ``measured`` (E, N):
    reflectances at `uplift.extras.scene.representations.samples.wavelengths`.
    ``errors`` (4, max_moments + 1, E, len(MEASURES)): errors, by the order of
    `TECHNIQUES` and by moments from 0.
    """

    names: tuple[str, ...]
    atlases: tuple[str, ...]
    measured: Array
    errors: Array

    @property
    def max_moments(self) -> int:
        """Largest number of moments."""
        return self.errors.shape[1] - 1

    @property
    def groups(self) -> tuple[str, ...]:
        """Names of the groups: all entries, and every atlas."""
        return (ALL_ATLASES, *dict.fromkeys(self.atlases))

    def rows(self, group: str = ALL_ATLASES) -> Indices:
        """Entries of a group."""
        atlases = np.array(self.atlases)
        return np.flatnonzero((group == ALL_ATLASES) | (atlases == group))

    def result(
        self, technique: Technique, moments: int, group: str = ALL_ATLASES
    ) -> MomentsResult:
        """Summarise the errors of a group for one technique and number of moments."""
        rows = self.rows(group)
        errors = self.errors[TECHNIQUES.index(technique), moments, rows]
        worst = int(rows[errors[:, 0].argmax()])
        return MomentsResult(errors.mean(axis=0), errors.max(axis=0), worst)

    def curves(self) -> dict[Technique, Array]:
        """Numbers stored, mean and largest ΔE76 (max_moments + 1, 3) of all entries
        together, by technique.
        """
        counts = range(self.max_moments + 1)
        floats = [list(map(technique.floats, counts)) for technique in TECHNIQUES]
        errors = self.errors[..., 0]
        curves = np.stack([floats, errors.mean(axis=2), errors.max(axis=2)], axis=-1)
        return dict(zip(TECHNIQUES, curves, strict=True))

    def records(self) -> list[dict[str, Any]]:
        """Return a flat record for every group, technique and count, with mean and
        maximum of every measure.
        """
        counts = range(self.max_moments + 1)
        return list(starmap(self._record, product(self.groups, TECHNIQUES, counts)))

    def _record(self, group: str, technique: Technique, moments: int) -> dict[str, Any]:
        result = self.result(technique, moments, group)
        errors = {}
        for row, name in enumerate(MEASURES):
            errors[f"{name}_mean"] = float(result.mean[row])
            errors[f"{name}_max"] = float(result.max[row])
        return {
            "atlas": group,
            "entries": len(self.rows(group)),
            "mirrored": technique.mirrored,
            "warped": technique.warped,
            "moments": moments,
            "floats": technique.floats(moments),
            **errors,
            "worst": self.names[result.worst],
        }


def study_moments(
    atlases: Mapping[str, Atlas],
    max_moments: int = 15,
    progress: ProgressCallback = ignore_progress,
) -> MomentsStudy:
    """Reduce every entry to 0 … ``max_moments`` moments, and reconstruct it, by all
    four techniques.
    """
    if not 0 <= max_moments <= MAX_MOMENTS:
        raise OptionError(
            f"max_moments must be in [0, {MAX_MOMENTS}], got {max_moments}"
        )
    atlas = merge(atlases.values())
    if not atlas.entries:
        raise AtlasError(
            "the atlases have no entries",
            code="too-few-entries",
            hint="name an atlas with reflectances",
        )
    measured = on_grid(atlas, samples.wavelengths())
    original = measured[:, :: samples.TABLE_STRIDE]
    lights = [observer.light(name) for name in REPORT_LIGHTS]

    def labs(spectra: Array) -> list[Array]:
        return [lab(spectra @ light.xyz.T, light.white) for light in lights]

    expected = labs(original)
    counts = max_moments + 1
    errors = np.empty((len(TECHNIQUES), counts, len(measured), len(MEASURES)))
    for row, technique in enumerate(TECHNIQUES):
        moments = technique.moments(measured, samples.wavelengths(), max_moments)
        for count in range(counts):
            spectra = technique.reconstruct(moments[:, : count + 1], observer.grid())
            actual = labs(spectra)
            rms = np.sqrt(((spectra - original) ** 2).mean(axis=1))
            delta_e = [
                delta_e_1976(actual[0], expected[0]),
                *map(delta_e_2000, actual, expected),
            ]
            errors[row, count] = np.stack([*delta_e, rms], axis=1)
            done = row * counts + count + 1
            progress(Progress("reconstructions", done, len(TECHNIQUES) * counts))
    origins: list[str] = []
    for name, entries in atlases.items():
        origins += [name] * len(entries)
    return MomentsStudy(atlas.names, tuple(origins), measured, errors)
