"""Validation of measured reflectances."""

from __future__ import annotations

import numpy as np

from uplift.atlas.document import SourceLocation
from uplift.common.arrays import Array

VISIBLE = (400.0, 700.0)
"""Range in nm that every entry must cover. Wavelengths outside have little effect on colour."""

LOWEST, HIGHEST = -0.05, 2.0
"""Limits of reflectance. Noise is slightly below 0, fluorescent whites are above 1; other values have a wrong scale."""

LONGEST = 1e6
"""Largest wavelength in nm, a millimetre. Larger values would overflow in interpolation."""

SLACK = 1e-6
"""Tolerance in nm for the ends of a range, as start + n × increment is rounded."""


MAX_NAME = 1000
"""Characters of a name."""


def check_name(name: str, location: SourceLocation) -> None:
    """Check that a name is one line of text without surrounding blanks. Raise `AtlasError`."""
    if not name.strip():
        raise location.error("an entry needs a name", "give every entry a unique name", code="name-missing")
    if name != name.strip() or len(name.splitlines()) != 1 or "\0" in name:
        raise location.error(
            "the name has line breaks or surrounding blanks",
            "give the entry a name of one line",
            code="invalid-name",
        )
    if len(name) > MAX_NAME or (not name.isascii() and name != name.encode(errors="ignore").decode()):
        raise location.error(
            f"the name must have at most {MAX_NAME} characters, all of them valid Unicode",
            "give the entry a shorter name",
            code="invalid-name",
        )


def check_spectrum(wavelengths: Array, values: Array, location: SourceLocation) -> None:
    """Check wavelengths (N,) in nm and values (N,) in units of 1. Raise `AtlasError`."""
    _check_shapes(wavelengths, values, location)
    _check_finite(wavelengths, values, location)
    _check_ascending(wavelengths, location)
    _check_coverage(wavelengths, location)
    _check_scale(wavelengths, values, location)


def _check_shapes(wavelengths: Array, values: Array, location: SourceLocation) -> None:
    if wavelengths.ndim != 1 or wavelengths.shape != values.shape:
        problem = f"wavelengths and values must have the same shape (N,), got {wavelengths.shape} and {values.shape}"
        raise location.error(problem, "give one wavelength for every value", code="shape-mismatch")
    if len(wavelengths) < 2:
        problem = f"an entry needs at least 2 samples, got {len(wavelengths)}"
        raise location.error(problem, "add the missing samples", code="too-few-samples")


def _check_finite(wavelengths: Array, values: Array, location: SourceLocation) -> None:
    bad = np.flatnonzero(~(np.isfinite(wavelengths) & np.isfinite(values)))
    if len(bad):
        i = bad[0]
        problem = f"sample {i + 1} is not finite: {values[i]:g} at {wavelengths[i]:g} nm"
        raise location.error(problem, "replace it by the measured value or remove the entry", code="sample-not-finite")


def _check_ascending(wavelengths: Array, location: SourceLocation) -> None:
    if wavelengths[0] <= 0 or wavelengths[-1] > LONGEST:
        outside = wavelengths[0] if wavelengths[0] <= 0 else wavelengths[-1]
        problem = f"wavelengths must be in (0, {LONGEST:g}] nm, got {outside:g}"
        raise location.error(problem, "give wavelengths in nm", code="wavelength-out-of-range")
    bad = np.flatnonzero(np.diff(wavelengths) < SLACK)
    if len(bad):
        i = bad[0]
        problem = f"wavelengths must ascend, got {wavelengths[i]:g} nm, then {wavelengths[i + 1]:g} nm"
        raise location.error(
            problem, "sort the samples by wavelength, each wavelength once", code="wavelengths-not-ascending"
        )


def _check_coverage(wavelengths: Array, location: SourceLocation) -> None:
    first, last = wavelengths[0], wavelengths[-1]
    if first > VISIBLE[0] + SLACK or last < VISIBLE[1] - SLACK:
        problem = f"an entry must cover {VISIBLE[0]:g}–{VISIBLE[1]:g} nm, got {first:g}–{last:g} nm"
        raise location.error(
            problem, "add the missing samples and give wavelengths in nm", code="visible-range-not-covered"
        )


def _check_scale(wavelengths: Array, values: Array, location: SourceLocation) -> None:
    bad = np.flatnonzero((values > HIGHEST) | (values < LOWEST))
    if len(bad):
        i = bad[0]
        problem = f"reflectance must be in [{LOWEST:g}, {HIGHEST:g}], got {values[i]:g} at {wavelengths[i]:g} nm"
        hint = "the scale (in atlas text 'Maximum sample value') is probably missing or wrong"
        raise location.error(problem, hint, code="reflectance-out-of-range")
