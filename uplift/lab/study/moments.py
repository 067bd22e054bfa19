"""What the moments of a spectrum keep of it: four techniques, several counts, measured on atlases.

Tódová 2020, table 4.1 and appendix B.1: every measured spectrum is reduced to its plain trigonometric moments,
reconstructed from them, and the two are compared.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from uplift.atlas import Atlas, merge, on_grid
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_1976, delta_e_2000, lab
from uplift.colorimetry.lights import REPORT_LIGHTS
from uplift.colorimetry.sensor import Light
from uplift.common.arrays import Array
from uplift.common.errors import AtlasError, OptionError
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.lab.study.technique import TECHNIQUES, Technique

DEFAULT_MAX_MOMENTS, MAX_MOMENTS = 15, 32
"""Moments beside the zeroth: as many as the thesis has; more waves than that the 5 nm grid hardly shows."""
MEASURES = ("delta_e_76_D65", *(f"delta_e_00_{name}" for name in REPORT_LIGHTS), "rms")
"""ΔE76 under D65 (the thesis's measure), ΔE00 under every light, rms difference of the spectra."""
ALL_ATLASES = "all"
"""The name of all atlases together."""
STEP = 1.0
"""nm between the samples that moments are taken from."""


@dataclass(frozen=True, eq=False)
class MomentsStudy:
    """Errors of every entry, by every technique, with every count of moments.

    Parameters
    ----------
    names : (E,) of the entries.
    atlases : (E,) the atlas that each comes from.
    measured : (E, N) reflectance on the wavelengths of `fine_grid`.
    errors : (4, most + 1, E, len(MEASURES)); techniques as in `TECHNIQUES`, moments from 0.
    """

    names: tuple[str, ...]
    atlases: tuple[str, ...]
    measured: Array
    errors: Array

    @property
    def most(self) -> int:
        return self.errors.shape[1] - 1

    @property
    def groups(self) -> tuple[str, ...]:
        """All entries together, and every atlas."""
        return (ALL_ATLASES, *dict.fromkeys(self.atlases))

    def rows(self, group: str = ALL_ATLASES) -> NDArray[np.intp]:
        """Which entries are of a group."""
        return np.array([row for row, atlas in enumerate(self.atlases) if group in (ALL_ATLASES, atlas)])

    def of(self, technique: Technique, moments: int, group: str = ALL_ATLASES) -> MomentsResult:
        """What a technique did to a group with so many moments."""
        rows = self.rows(group)
        errors = self.errors[TECHNIQUES.index(technique), moments, rows]
        worst = int(rows[errors[:, 0].argmax()])
        return MomentsResult(group, technique, moments, errors.mean(axis=0), errors.max(axis=0), worst)

    def results(self) -> Iterator[MomentsResult]:
        """Every group, technique and count."""
        for group in self.groups:
            for technique in TECHNIQUES:
                for moments in range(self.most + 1):
                    yield self.of(technique, moments, group)


@dataclass(frozen=True, eq=False)
class MomentsResult:
    """Mean and largest error over a group, in the order of `MEASURES`; ``worst`` is the entry of the largest ΔE76."""

    group: str
    technique: Technique
    moments: int
    mean: Array
    most: Array
    worst: int

    @property
    def floats(self) -> int:
        return self.technique.floats(self.moments)


def fine_grid() -> Array:
    """(401,) wavelengths that moments are taken from: 380–780 nm at 1 nm."""
    return np.arange(observer.START, observer.END + STEP / 2, STEP)


def study_moments(
    atlases: Mapping[str, Atlas],
    most: int = DEFAULT_MAX_MOMENTS,
    progress: ProgressCallback = ignore_progress,
) -> MomentsStudy:
    """Reduce every entry of the atlases to 0 … ``most`` moments and back, by all four techniques.

    ``progress`` hears how many of how many reconstructions are done. An `UpliftWarning` names every entry that
    had to be clipped to [0, 1].

    Raises
    ------
    OptionError : ``most`` outside 0 to 32.
    AtlasError : no entries, or two of one name.
    """
    if not 0 <= most <= MAX_MOMENTS:
        raise OptionError(f"{most} moments are out of range", hint=f"take 0 to {MAX_MOMENTS}")
    spectra = merge(atlases.values())
    if not spectra.entries:
        raise AtlasError("no entries to study", hint="name an atlas that holds reflectances")
    measured = on_grid(spectra, fine_grid())
    compare = _comparer(measured)
    errors = np.empty((len(TECHNIQUES), most + 1, len(measured), len(MEASURES)))
    for row, technique in enumerate(TECHNIQUES):
        moments = technique.moments(measured, fine_grid(), most)
        for count in range(most + 1):
            found = technique.reconstruct(moments[:, : count + 1], observer.grid())
            errors[row, count] = compare(found)
            progress(Progress("reconstructions", row * (most + 1) + count + 1, len(TECHNIQUES) * (most + 1)))
    homes = [name for name, atlas in atlases.items() for _ in atlas.entries]
    return MomentsStudy(spectra.names, tuple(homes), measured, errors)


def _comparer(measured: Array) -> Callable[[Array], Array]:
    """The function that takes reconstructions (E, 81) on the observer's grid to errors (E, len(MEASURES))."""
    original = measured[:, :: round(observer.STEP / STEP)]
    lights = [observer.light(name) for name in REPORT_LIGHTS]
    labs = [_lab(light, original) for light in lights]

    def compare(found: Array) -> Array:
        seen = [_lab(light, found) for light in lights]
        apart = [delta_e_2000(one, other) for one, other in zip(seen, labs, strict=True)]
        rms = np.sqrt(((found - original) ** 2).mean(axis=1))
        return np.stack([delta_e_1976(seen[0], labs[0]), *apart, rms], axis=1)

    return compare


def _lab(light: Light, reflectance: Array) -> Array:
    return lab(reflectance @ light.xyz.T, light.white)
