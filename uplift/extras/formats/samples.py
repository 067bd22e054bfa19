"""One spectrum of a file: its samples in order of wavelength, without
missing values.
"""

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass

import numpy as np
from numpy.typing import ArrayLike

from uplift.atlas.atlas import USED, VISIBLE
from uplift.atlas.document import SourceLocation
from uplift.common.arrays import Array, Mask
from uplift.extras.formats.quantities import Quantity

MARKERS = (-999.0, -9999.0, -99999.0)
"""Numbers for missing values."""
HUGE = 1e30
"""Magnitude from which numbers stand for missing values, such as −1.23e34."""


@dataclass(frozen=True, eq=False)
class Spectrum:
    """One spectrum of a file, not validated."""

    name: str
    """Name of the entry."""
    wavelengths: Sequence[float] | Array
    values: Sequence[float] | Array
    """(N,) Wavelengths in nm, ascending or descending, and values in units of the file.
    """
    _: KW_ONLY
    line: int | None = None
    """First line of the spectrum in the file."""
    description: str = ""
    date: str = ""
    """Statements of the file about the measurement."""
    quantity: Quantity | None = None
    """Quantity that the file states of this spectrum."""


@dataclass(frozen=True, eq=False)
class Samples:
    """Samples of a spectrum in ascending order, without missing ones; or why it is
    skipped.
    """

    spectrum: Spectrum
    nm: Array
    values: Array
    notes: tuple[str, ...] = ()
    skipped: str = ""

    def used(self) -> "Samples":
        """Return the samples in the range that a cube uses."""
        inside = (self.nm >= USED[0]) & (self.nm <= USED[1]) & np.isfinite(self.values)
        return Samples(self.spectrum, self.nm[inside], self.values[inside])


def is_missing(values: ArrayLike) -> Mask:
    """Return where values are marks of missing ones."""
    values = np.asarray(values, dtype=float)
    absent = ~(np.abs(values) < HUGE)
    if values.min(initial=0) <= max(MARKERS):
        absent |= np.isin(values, MARKERS)
    return absent


def in_order(spectrum: Spectrum, location: SourceLocation, missing: str) -> Samples:
    """Sort the samples of a spectrum by wavelength, and leave out missing values as
    ``missing`` has it.
    """
    nm = np.asarray(spectrum.wavelengths, dtype=float)
    values = np.asarray(spectrum.values, dtype=float)
    notes = list[str]()
    if nm.ndim != 1 or nm.shape != values.shape:
        return Samples(spectrum, nm, values)  # an entry refuses them
    falls = nm[1:] < nm[:-1]
    if falls.any():
        notes.append(
            "descending, reversed"
            if falls.all()
            else "not in order of wavelength, sorted"
        )
        order = np.argsort(nm, kind="stable")
        nm = nm[order]
        values = values[order]
    absent = is_missing(values)
    # A large table has millions of values, and few are missing.
    is_whole = not absent.any() and np.ptp(np.searchsorted(nm, VISIBLE)) > 0
    if is_whole:
        return Samples(spectrum, nm, values, tuple(notes))
    is_used = (nm >= USED[0]) & (nm <= USED[1])
    is_visible = (nm >= VISIBLE[0]) & (nm <= VISIBLE[1])
    if not (is_visible & ~absent).any():
        reason = f"no values within {VISIBLE[0]:g}–{VISIBLE[1]:g} nm"
        return Samples(spectrum, nm, values, skipped=reason)
    if (absent & ~is_used).any():
        notes.append(f"missing values outside {USED[0]:g}–{USED[1]:g} nm left out")
    inside = np.flatnonzero(absent & is_used)
    if len(inside):
        problem = f"missing value at {nm[inside[0]]:g} nm"
        if missing == "skip":
            return Samples(spectrum, nm, values, skipped=problem)
        if missing == "refuse":
            hint = "measure it again, or pass missing='interpolate' or missing='skip'"
            raise location.at(spectrum.line, spectrum.name).error(
                problem, hint, code="missing-value"
            )
        notes.append("missing values interpolated")
    return Samples(spectrum, nm[~absent], values[~absent], tuple(notes))
