"""Spectra as the reader of a format returns them, and their conversion to an `Atlas`: order, scale and quantity."""

import contextlib
import warnings
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import KW_ONLY, dataclass, field, replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from uplift.atlas.atlas import HIGHEST, LOWEST, SLACK, USED, VISIBLE, Atlas, Entry, Header, SkippedEntry, Source
from uplift.atlas.document import EXPORT, Document, SourceLocation, truncate
from uplift.atlas.statements import PERCENT, Quantity, Scale
from uplift.common.arrays import Array, Mask
from uplift.common.errors import AtlasError, UpliftWarning, needs_package
from uplift.common.text import listed, pluralise, printable

Measured = Literal["auto", "percent", "fraction"]
Missing = Literal["refuse", "interpolate", "skip"]
MISSING: tuple[Missing, ...] = ("refuse", "interpolate", "skip")
"""What becomes of an entry with a missing value."""
MEASURED: tuple[Measured, ...] = ("auto", "percent", "fraction")
"""Scales of measured values; ``auto`` takes the scale that the file states or, failing that, decides by the values."""
GIVEN = {"percent": "percent", "fraction": "0 to 1"}
WHICH_SCALE = "pass measured='percent' or measured='fraction'"
DARKEST = 1.0
"""A row of a table in percent whose values are all below this number is darker than any common material."""
JUMP, FLOOR = 30.0, 0.1
"""Ratio of neighbouring samples that no reflectance has, and the smallest divisor in units of the table."""
MARKERS = (-999.0, -9999.0, -99999.0)
"""Numbers for missing values."""
HUGE = 1e30
"""Magnitude from which numbers stand for missing values, such as −1.23e34."""
COARSE = 20.0
"""Largest step in nm at which neighbours are alike."""
ODD = 10.0
"""Ratio of a value to both of its neighbours that is likely to be a slip."""


@dataclass(frozen=True, eq=False)
class Spectrum:
    """One spectrum of a file, not validated."""

    name: str
    """Name of the entry."""
    wavelengths: Sequence[float] | Array
    values: Sequence[float] | Array
    """(N,) Wavelengths in nm, ascending or descending, and values in units of the file."""
    _: KW_ONLY
    line: int | None = None
    """First line of the spectrum in the file."""
    description: str = ""
    date: str = ""
    """Statements of the file about the measurement."""
    quantity: Quantity | None = None
    """Quantity that the file states of this spectrum."""


@dataclass(frozen=True, eq=False)
class Measurements:
    """Content of a file."""

    spectra: tuple[Spectrum, ...]
    """Reflectances."""
    _: KW_ONLY
    skipped: tuple[SkippedEntry, ...] = ()
    """Other spectra."""
    scales: tuple[Scale, ...] = ()
    """Scales that the file states."""
    header: Header = field(default_factory=Header)
    """Statements of the file about itself."""
    notes: tuple[str, ...] = ()
    """How the content was understood."""
    quantity: Quantity | None = None
    """Quantity that the file states of all spectra that state none."""


@dataclass(frozen=True, eq=False)
class Samples:
    """Samples of a spectrum in ascending order, without missing ones; or why it is skipped."""

    spectrum: Spectrum
    nm: Array
    values: Array
    notes: tuple[str, ...] = ()
    skipped: str = ""

    def used(self) -> "Samples":
        """Return the samples in the range that a cube uses."""
        inside = (self.nm >= USED[0]) & (self.nm <= USED[1]) & np.isfinite(self.values)
        return replace(self, nm=self.nm[inside], values=self.values[inside])


def to_atlas(
    document: Document, measurements: Measurements, format_name: str, measured: str = "auto", missing: str = "refuse"
) -> Atlas:
    """Make entries of the reflectances of a file: in order of wavelength, without missing values, in units of 1."""
    reflectances, skipped = _reflectances(document, measurements)
    samples = [_in_order(spectrum, document.location, missing) for spectrum in reflectances]
    kept = [each for each in samples if not each.skipped]
    if kept:
        left_out = [each for each in samples if each.skipped]
        skipped += [
            SkippedEntry(each.spectrum.name, each.skipped, document.path, each.spectrum.line) for each in left_out
        ]
    else:  # the error of an entry states what is wrong
        kept = samples
    # One scale for all spectra: a dark one alone does not show whether it is in percent.
    scale, scale_note = _scale(document.location, measurements.scales, kept, measured)
    entries = [_entry(each, scale, document) for each in kept]
    counts = Counter(note for each in kept for note in each.notes)
    changes = [f"{count} of {pluralise(len(entries), 'entry')}: {note}" for note, count in counts.items()]
    notes = (*measurements.notes, *changes, scale_note) if entries else ()
    safe = tuple(map(printable, notes))
    source = Source(document.name, document.digest, measurements.header, format_name, measured, safe, missing=missing)
    return Atlas(tuple(entries), (*measurements.skipped, *skipped), (source,))


def _reflectances(document: Document, measurements: Measurements) -> tuple[list[Spectrum], list[SkippedEntry]]:
    """Separate reflectances from other spectra. Raise `AtlasError` if none may be a reflectance."""
    kept, skipped = list[Spectrum](), list[SkippedEntry]()
    refusals = list[AtlasError]()
    for spectrum in measurements.spectra:
        quantity = spectrum.quantity or measurements.quantity
        if quantity is None or quantity.is_reflectance:
            kept.append(spectrum)
        else:
            reason = f"it is {quantity.name}, not reflectance"
            skipped.append(SkippedEntry(spectrum.name, reason, document.path, spectrum.line))
            refusals.append(wrong_quantity(quantity, document.location.at(spectrum.line)))
    if refusals and not kept:
        raise refusals[0]
    return kept, skipped


def _in_order(spectrum: Spectrum, location: SourceLocation, missing: str) -> Samples:
    """Sort the samples of a spectrum by wavelength, and leave out missing values as ``missing`` has it."""
    nm = np.asarray(spectrum.wavelengths, dtype=float)
    values = np.asarray(spectrum.values, dtype=float)
    notes = list[str]()
    if nm.ndim != 1 or nm.shape != values.shape:
        return Samples(spectrum, nm, values)  # an entry refuses them
    steps = np.diff(nm)
    if (steps < 0).any():
        notes.append("descending, reversed" if (steps < 0).all() else "not in order of wavelength, sorted")
        order = np.argsort(nm, kind="stable")
        nm, values = nm[order], values[order]
    absent = is_missing(values)
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
            raise location.at(spectrum.line, spectrum.name).error(problem, hint, code="missing-value")
        notes.append("missing values interpolated")
    return Samples(spectrum, nm[~absent], values[~absent], tuple(notes))


def _entry(samples: Samples, scale: float, document: Document) -> Entry:
    """Make an entry of samples on a scale. Invalid ones outside the range that is used are cut off."""
    spectrum, nm, scaled = samples.spectrum, samples.nm, samples.values / scale
    location = document.location.at(spectrum.line, spectrum.name)
    outside = (scaled > HIGHEST) | (scaled < LOWEST)
    if nm.shape == scaled.shape and nm.ndim == 1:
        invalid = outside.copy()
        invalid[1:] |= np.diff(nm) < SLACK
        first = np.flatnonzero(invalid & (nm < USED[0])).max(initial=-1) + 1
        last = np.flatnonzero(invalid & (nm > USED[1])).min(initial=len(nm))
        nm, scaled, outside = nm[first:last], scaled[first:last], outside[first:last]
    if scale != 1 and outside.any():  # an entry would name the scaled value, which is not in the file
        at = int(np.argmax(outside))
        limits = f"[{LOWEST * scale:g}, {HIGHEST * scale:g}] on the scale to {scale:g}"
        problem = f"values must be in {limits}, got {scaled[at] * scale:g} at {nm[at]:g} nm"
        raise location.error(problem, "correct the value, or the scale")
    stated = {key: getattr(spectrum, key) for key in ("description", "date", "line")}
    return Entry(spectrum.name, nm, scaled, path=document.path, **stated)


def warn_of_odd(entries: Sequence[Entry]) -> None:
    """Warn of values that are ten times both neighbours, or a tenth."""
    for entry in entries:
        values = np.maximum(entry.values, FLOOR / PERCENT)
        before, value, after = values[:-2], values[1:-1], values[2:]
        above = value > ODD * np.maximum(before, after)
        below = value * ODD < np.minimum(before, after)
        is_near = entry.wavelengths[2:] - entry.wavelengths[:-2] <= 2 * COARSE
        for at in np.flatnonzero((above | below) & is_near & (np.maximum(value, before) > FLOOR))[:1] + 1:
            problem = f"{entry.values[at]:g} at {entry.wavelengths[at]:g} nm is far from both of its neighbours"
            warning = UpliftWarning(problem, code="odd-value", path=entry.path, line=entry.line, entry=entry.name)
            warnings.warn(warning, stacklevel=3)


def is_missing(values: ArrayLike) -> Mask:
    """Return where values are marks of missing ones."""
    values = np.asarray(values, dtype=float)
    return ~(np.abs(values) < HUGE) | np.isin(values, MARKERS)


def not_used_note(labels: Iterable[str]) -> tuple[str, ...]:
    """Return the note about columns that are not spectra; none without labels."""
    names = [truncate(label) or "(no label)" for label in labels]
    return (f"not used: {listed(names)}",) if names else ()


def wrong_quantity(quantity: Quantity, location: SourceLocation) -> AtlasError:
    """Create the error for values that are not reflectances."""
    hint = "measure the reflectance, or correct the statement if it is wrong: a cube holds reflectances"
    if quantity.of_light:
        hint = "it is read by read_lamps(): an atlas holds reflectances"
    problem = f"the file states {quantity.name} ('{truncate(quantity.text)}'), not reflectance"
    return location.error(problem, hint, code="not-reflectance")


@contextlib.contextmanager
def parsed_by(library: str, kind: str, document: Document) -> Iterator[None]:
    """Import and run another library's reader; its exceptions, which a damaged file may cause, become `AtlasError`."""
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        try:
            with needs_package(kind, AtlasError):
                yield
        except (AtlasError, MemoryError):
            raise
        except Exception as error:
            reason = truncate(str(error)) or type(error).__name__
            problem = f"{kind} are read by {library}, which reports: {reason}"
            raise document.location.error(problem, EXPORT) from error


def _scale(
    location: SourceLocation, stated: Sequence[Scale], samples: Sequence[Samples], measured: str
) -> tuple[float, str]:
    """Return the divisor of all values, and a note about it. What is stated wins over what the values suggest."""
    if measured != "auto":
        return PERCENT if measured == "percent" else 1.0, f"scale: {GIVEN[measured]}, as given"
    used = [each.used() for each in samples]
    highest = [float(each.values.max(initial=0)) for each in used]
    top = max(highest, default=0.0)
    first = stated[0] if stated else None
    if first is not None:
        others = [scale for scale in stated if scale.divisor != first.divisor]
        if others:
            problem = f"the file states two scales: '{truncate(first.text)}' and '{truncate(others[0].text)}'"
            raise location.error(problem, WHICH_SCALE, code="scales-contradict")
        if top > HIGHEST * first.divisor and first.divisor == 1:
            problem = f"the file states '{truncate(first.text)}', and has values up to {top:g}"
            raise location.error(problem, WHICH_SCALE, code="scales-contradict")
        if first.divisor == PERCENT and top <= DARKEST and samples:
            problem = f"no value exceeds {top:g} percent, as the file states '{truncate(first.text)}'"
            hint = "pass measured='fraction' if they are from 0 to 1"
            warnings.warn(UpliftWarning(problem, code="dark-percent", path=location.path, hint=hint), stacklevel=4)
        return first.divisor, f"scale: 0 to {first.divisor:g}, as stated: '{truncate(first.text)}'"
    if top > HIGHEST:
        _check_one_scale(location, used, highest)
        problem = f"values up to {top:g} are read as percent and divided by 100"
        entry = used[int(np.argmax(highest))].spectrum.name
        warnings.warn(UpliftWarning(problem, code="values-in-percent", path=location.path, entry=entry), stacklevel=4)
        return PERCENT, f"scale: percent, by values up to {top:g}"
    everything = np.concatenate([np.empty(0), *(each.values for each in used)])
    if (everything > 1).sum() * 2 > len(everything):
        problem = f"most values exceed 1, up to {top:g}, and no scale is stated"
        raise location.error(problem, WHICH_SCALE, code="scale-not-stated")
    return 1.0, f"scale: 0 to 1, assumed: none is stated, and the largest value is {top:g}"


def _check_one_scale(location: SourceLocation, samples: Sequence[Samples], highest: Sequence[float]) -> None:
    """Raise `AtlasError` for a row in units of 1 among rows in percent, or the reverse, or within one row."""
    problem, odd = "", samples[0].spectrum
    # A row that never exceeds 1, where others are in percent, is in units of 1, or the reverse; the minority is named.
    dark = [row for row, top in enumerate(highest) if top <= DARKEST]
    if dark:
        light = [row for row, top in enumerate(highest) if top > HIGHEST]
        (row, *_), (usual, *_) = sorted((dark, light), key=len)
        odd = samples[row].spectrum
        name = truncate(samples[usual].spectrum.name)
        problem = f"values up to {highest[row]:g}, where '{name}' has up to {highest[usual]:g}"
    for each in samples:
        # Neighbours that differ by more than JUMP, one of them within [0, 1], and the other one in percent.
        low = np.minimum(each.values[:-1], each.values[1:])
        high = np.maximum(each.values[:-1], each.values[1:])
        jumps = np.flatnonzero((low <= DARKEST) & (high > HIGHEST) & (high / JUMP > np.maximum(low, FLOOR)))
        if len(jumps):
            at = jumps[0]
            odd = each.spectrum
            problem = f"{each.values[at]:g}, then {each.values[at + 1]:g}, at {each.nm[at + 1]:g} nm"
            break
    if problem:
        raise location.at(odd.line, odd.name).error(
            f"mixed scales of percent and 0 to 1: {problem}",
            "correct the row, or pass measured='percent' or measured='fraction' if it is right",
            code="mixed-scales",
        )
