"""Loss of trigonometric moments: four techniques and several counts, measured on
atlases.

Every measured spectrum is reduced to its moments, reconstructed, and compared with the
measurement, as in Tódová 2020, *Constrained Spectral Uplifting*, table 4.1, sections
2.2.1 and 4.1.1, and appendix B.1.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product, starmap

import numpy as np
from numpy.typing import ArrayLike

from uplift.atlas.atlas import Atlas, merge
from uplift.atlas.resampling import on_grid
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_1976, lab
from uplift.common.arrays import Array, Complex
from uplift.common.errors import AtlasError, OptionError
from uplift.common.progress import ProgressCallback, ignore_progress, reported
from uplift.extras.colour.light_sets import REPORT_LIGHTS
from uplift.extras.papers.representations import samples
from uplift.extras.report.comparison import compare_spectra
from uplift.lab.runner import Row, named_lights
from uplift.lab.study.unmirrored import fourier_basis, try_complex_multipliers
from uplift.models import duality
from uplift.models.moments import Moments


@dataclass(frozen=True)
class Technique:
    """A mapping of the spectrum to the circle.

    ``mirrored``: map [start, end] nm to the half circle [−π, 0] and mirror it, which
    makes the moments real.
        Otherwise the range covers the circle [−π, π], and its two ends meet.
    ``warp``: name of the warp of the phase towards wavelengths to which the eye is
    sensitive, or ``none``.
    """

    mirrored: bool
    warp: str

    @property
    def warped(self) -> bool:
        """Whether the phase is warped."""
        return self.warp != "none"

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
        half = Moments(warp=self.warp).phase(wavelengths)
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
        solve = duality.try_multipliers if self.mirrored else try_complex_multipliers
        multipliers = duality.multipliers_from_moments(moments, solve)
        waves = fourier_basis(self.phase(wavelengths), moments.shape[1])
        return 0.5 + np.arctan((multipliers @ waves.T).real) / np.pi


TECHNIQUES = tuple(starmap(Technique, product((True, False), ("vision", "none"))))
"""The techniques of the thesis, in the order of its tables."""
MAX_MOMENTS = 32
"""Largest number of cosines that a 5 nm grid still resolves."""
MEASURES = ("delta_e_76_D65", *(f"delta_e_00_{name}" for name in REPORT_LIGHTS), "rms")
"""Error measures: ΔE76 under D65 as in the thesis, ΔE00 under every light, rms
difference of the spectra.
"""
ALL_ATLASES = "all"
"""Name of the group of all entries."""


@dataclass(frozen=True, eq=False)
class MomentsStudy:
    """Errors of every entry for every technique and number of moments.

    ``names``, ``atlases``: names and atlases of the E entries. ``measured`` (E, N):
    reflectances at `uplift.extras.papers.representations.samples.wavelengths`.
    ``errors`` (T, max_moments + 1, E, len(MEASURES)): errors, by the order of the
    techniques and by moments from 0.
    """

    names: tuple[str, ...]
    atlases: tuple[str, ...]
    measured: Array
    techniques: tuple[Technique, ...]
    errors: Array

    def rows(self) -> list[Row]:
        """Return mean and maximum of every measure for all entries and for those of
        each atlas, by technique and count.
        """
        groups = {ALL_ATLASES: np.arange(len(self.names))}
        for atlas in dict.fromkeys(self.atlases):
            groups[atlas] = np.flatnonzero(np.array(self.atlases) == atlas)
        rows = []
        cases = product(groups, self.techniques, range(self.errors.shape[1]))
        for group, technique, moments in cases:
            members = groups[group]
            errors = self.errors[self.techniques.index(technique), moments, members]
            row: Row = {
                "atlas": group,
                "entries": len(members),
                "mirrored": technique.mirrored,
                "warped": technique.warped,
                "moments": moments,
                "floats": technique.floats(moments),
            }
            for name, values in zip(MEASURES, errors.T, strict=True):
                row[f"{name}_mean"] = float(values.mean())
                row[f"{name}_max"] = float(values.max())
            rows.append(row | {"worst": self.names[members[errors[:, 0].argmax()]]})
        return rows


def study_moments(
    atlases: Mapping[str, Atlas],
    max_moments: int = 15,
    techniques: tuple[Technique, ...] = TECHNIQUES,
    progress: ProgressCallback = ignore_progress,
) -> MomentsStudy:
    """Reduce every entry to 0 … ``max_moments`` moments, and reconstruct it, by several
    techniques.
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
    lights = list(named_lights(REPORT_LIGHTS).values())
    d65 = lights[0]
    counts = max_moments + 1
    errors = []
    cases = list(product(techniques, range(counts)))
    for technique, count in reported(cases, "reconstructions", progress):
        moments = technique.moments(measured, samples.wavelengths(), count)
        spectra = technique.reconstruct(moments, observer.grid())
        colours = [lab(each @ d65.xyz.T, d65.white) for each in (spectra, original)]
        found = compare_spectra(original, spectra, lights)
        columns = [delta_e_1976(*colours), found.delta_e, found.rms]
        errors.append(np.column_stack(columns))
    shape = (len(techniques), counts, len(measured), len(MEASURES))
    origins: list[str] = []
    for name, entries in atlases.items():
        origins += [name] * len(entries)
    by_case = np.reshape(errors, shape)
    return MomentsStudy(atlas.names, tuple(origins), measured, techniques, by_case)
