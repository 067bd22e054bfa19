"""What a measured reflectance must satisfy before anything is computed from it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from uplift.atlas.document import SourceLocation

Array = NDArray[np.float64]

VISIBLE = (400.0, 700.0)
"""nm every entry must cover: outside, a reflectance hardly changes a colour; inside, it must be measured."""

LOWEST, HIGHEST = -0.05, 2.0
"""Sensor noise goes a little below 0, fluorescent whites above 1; anything beyond is a wrong scale."""

LONGEST = 1e6
"""nm: a millimetre. What lies beyond is no wavelength, and no number to interpolate with."""

SLACK = 1e-6
"""nm that make no difference: by this a range may miss its end, as start + n × increment rounds."""


def check_name(name: str, place: SourceLocation) -> None:
    """A name must be one line of text without blanks around it. Raises `AtlasError`."""
    if not name.strip():
        raise place.error("an entry has no name", "give every entry a name of its own")
    if name != name.strip() or len(name.splitlines()) != 1 or "\0" in name:
        raise place.error("the name has line breaks or blanks around it", "give the entry a plain name")


def check_spectrum(wavelengths: Array, values: Array, place: SourceLocation) -> None:
    """Wavelengths (N,) nm and values (N,) in units of 1 must make a reflectance. Raises `AtlasError`."""
    _check_shapes(wavelengths, values, place)
    _check_finite(wavelengths, values, place)
    _check_ascending(wavelengths, place)
    _check_coverage(wavelengths, place)
    _check_scale(wavelengths, values, place)


def _check_shapes(wavelengths: Array, values: Array, place: SourceLocation) -> None:
    if wavelengths.ndim != 1 or wavelengths.shape != values.shape:
        shapes = f"{wavelengths.shape} wavelengths for {values.shape} values"
        raise place.error(shapes, "give one wavelength for every value")
    if len(wavelengths) < 2:
        raise place.error(f"{len(wavelengths)} sample(s), at least 2 are needed", "add the missing samples")


def _check_finite(wavelengths: Array, values: Array, place: SourceLocation) -> None:
    bad = np.flatnonzero(~(np.isfinite(wavelengths) & np.isfinite(values)))
    if len(bad):
        i = bad[0]
        problem = f"sample {i + 1} is not finite: {values[i]:g} at {wavelengths[i]:g} nm"
        raise place.error(problem, "replace it by the measured value or remove the entry")


def _check_ascending(wavelengths: Array, place: SourceLocation) -> None:
    if wavelengths[0] <= 0:
        raise place.error(f"wavelength {wavelengths[0]:g} nm is not positive", "give wavelengths in nm")
    if wavelengths[-1] > LONGEST:
        raise place.error(f"wavelength {wavelengths[-1]:g} nm is out of range", "give wavelengths in nm")
    bad = np.flatnonzero(np.diff(wavelengths) < SLACK)
    if len(bad):
        i = bad[0]
        problem = f"wavelengths do not ascend: {wavelengths[i]:g} nm, then {wavelengths[i + 1]:g} nm"
        raise place.error(problem, "sort the samples by wavelength, each wavelength once")


def _check_coverage(wavelengths: Array, place: SourceLocation) -> None:
    first, last = wavelengths[0], wavelengths[-1]
    if first > VISIBLE[0] + SLACK or last < VISIBLE[1] - SLACK:
        problem = f"covers {first:g}–{last:g} nm, not the visible {VISIBLE[0]:g}–{VISIBLE[1]:g} nm"
        raise place.error(problem, "add the missing samples and give wavelengths in nm")


def _check_scale(wavelengths: Array, values: Array, place: SourceLocation) -> None:
    bad = np.flatnonzero((values > HIGHEST) | (values < LOWEST))
    if len(bad):
        i = bad[0]
        problem = f"reflectance {values[i]:g} at {wavelengths[i]:g} nm is out of range"
        hint = "the scale (in atlas text 'Maximum sample value') is probably missing or wrong"
        raise place.error(problem, hint)
