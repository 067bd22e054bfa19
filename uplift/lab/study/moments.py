"""Loss of trigonometric moments: four techniques and several counts, measured on atlases.

Every measured spectrum is reduced to its moments, reconstructed, and compared with the measurement, as in Tódová 2020,
*Constrained Spectral Uplifting*, table 4.1 and appendix B.1.
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

__all__ = ["MomentsResult", "MomentsStudy", "fine_grid", "study_moments"]

DEFAULT_MAX_MOMENTS, MAX_MOMENTS = 15, 32
"""Largest number of moments above the zeroth: in the thesis, and of cosines that a 5 nm grid still resolves."""
MEASURES = ("delta_e_76_D65", *(f"delta_e_00_{name}" for name in REPORT_LIGHTS), "rms")
"""Error measures: ΔE76 under D65 as in the thesis, ΔE00 under every light, rms difference of the spectra."""
ALL_ATLASES = "all"
"""Name of the group of all entries."""
STEP = 1.0
"""Distance in nm of the samples that moments are computed from."""


@dataclass(frozen=True, eq=False)
class MomentsStudy:
    """Errors of every entry for every technique and number of moments.

    Parameters
    ----------
    names : tuple of str
        Names of the E entries.
    atlases : tuple of str
        Atlas of each entry.
    measured : ndarray, shape (E, N)
        Reflectances at the wavelengths of `fine_grid`.
    errors : ndarray, shape (4, max_moments + 1, E, len(MEASURES))
        Errors, by the order of `TECHNIQUES` and by moments from 0.
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

    def rows(self, group: str = ALL_ATLASES) -> NDArray[np.intp]:
        """Find the entries of a group.

        Parameters
        ----------
        group : str, optional
            One of `groups`.

        Returns
        -------
        ndarray
            Indices of the entries.
        """
        return np.array([row for row, atlas in enumerate(self.atlases) if group in (ALL_ATLASES, atlas)])

    def result(self, technique: Technique, moments: int, group: str = ALL_ATLASES) -> MomentsResult:
        """Summarise the errors of a group for one technique and number of moments.

        Parameters
        ----------
        technique : Technique
            One of `TECHNIQUES`.
        moments : int
            Number of moments above the zeroth, 0 to `max_moments`.
        group : str, optional
            One of `groups`.

        Returns
        -------
        MomentsResult
            Mean and largest errors.
        """
        rows = self.rows(group)
        errors = self.errors[TECHNIQUES.index(technique), moments, rows]
        worst = int(rows[errors[:, 0].argmax()])
        return MomentsResult(group, technique, moments, errors.mean(axis=0), errors.max(axis=0), worst)

    def results(self) -> Iterator[MomentsResult]:
        """Yield the result of every group, technique and number of moments."""
        for group in self.groups:
            for technique in TECHNIQUES:
                for moments in range(self.max_moments + 1):
                    yield self.result(technique, moments, group)


@dataclass(frozen=True, eq=False)
class MomentsResult:
    """Errors of a group for one technique and number of moments.

    Parameters
    ----------
    group : str
        Name of the group.
    technique : Technique
        The technique.
    moments : int
        Number of moments above the zeroth.
    mean, max : ndarray, shape (len(MEASURES),)
        Mean and largest error.
    worst : int
        Index of the entry with the largest ΔE76.
    """

    group: str
    technique: Technique
    moments: int
    mean: Array
    max: Array
    worst: int

    @property
    def floats(self) -> int:
        """Numbers stored per spectrum."""
        return self.technique.floats(self.moments)


def fine_grid() -> Array:
    """Make the wavelengths that moments are computed from.

    Returns
    -------
    ndarray, shape (401,)
        380–780 nm at 1 nm.
    """
    return np.arange(observer.START, observer.END + STEP / 2, STEP)


def study_moments(
    atlases: Mapping[str, Atlas],
    max_moments: int = DEFAULT_MAX_MOMENTS,
    progress: ProgressCallback = ignore_progress,
) -> MomentsStudy:
    """Reduce every entry to 0 … ``max_moments`` moments, and reconstruct it, by all four techniques.

    Parameters
    ----------
    atlases : mapping of str to Atlas
        Measurements by name.
    max_moments : int, optional
        Largest number of moments above the zeroth, 0 to `MAX_MOMENTS`.
    progress : callable, optional
        Called with the stage ``"reconstructions"``.

    Returns
    -------
    MomentsStudy
        The errors.

    Raises
    ------
    OptionError
        ``max_moments`` is out of range.
    AtlasError
        No entries, or two entries with one name.

    Warns
    -----
    UpliftWarning
        An entry was clipped to [0, 1].
    """
    if not 0 <= max_moments <= MAX_MOMENTS:
        raise OptionError(
            f"max_moments must be in [0, {MAX_MOMENTS}], got {max_moments}",
            code="moments-out-of-range",
            hint=f"the thesis has {DEFAULT_MAX_MOMENTS}",
        )
    atlas = merge(atlases.values())
    if not atlas.entries:
        raise AtlasError("the atlases have no entries", code="empty-atlas", hint="name an atlas with reflectances")
    measured = on_grid(atlas, fine_grid())
    errors_of = _error_function(measured)
    counts = max_moments + 1
    errors = np.empty((len(TECHNIQUES), counts, len(measured), len(MEASURES)))
    for row, technique in enumerate(TECHNIQUES):
        moments = technique.moments(measured, fine_grid(), max_moments)
        for count in range(counts):
            reconstructed = technique.reconstruct(moments[:, : count + 1], observer.grid())
            errors[row, count] = errors_of(reconstructed)
            progress(Progress("reconstructions", row * counts + count + 1, len(TECHNIQUES) * counts))
    origins = tuple(name for name, each in atlases.items() for _ in each.entries)
    return MomentsStudy(atlas.names, origins, measured, errors)


def _error_function(measured: Array) -> Callable[[Array], Array]:
    """Make the function from reconstructions (E, 81) on the grid of the observer to errors (E, len(MEASURES))."""
    original = measured[:, :: round(observer.STEP / STEP)]
    lights = [observer.light(name) for name in REPORT_LIGHTS]
    expected = [_lab(light, original) for light in lights]

    def errors(reconstructed: Array) -> Array:
        actual = [_lab(light, reconstructed) for light in lights]
        delta_e = [delta_e_2000(one, other) for one, other in zip(actual, expected, strict=True)]
        rms = np.sqrt(((reconstructed - original) ** 2).mean(axis=1))
        return np.stack([delta_e_1976(actual[0], expected[0]), *delta_e, rms], axis=1)

    return errors


def _lab(light: Light, reflectance: Array) -> Array:
    return lab(reflectance @ light.xyz.T, light.white)
