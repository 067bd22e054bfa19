"""Spectra as the reader of a format returns them, and their conversion to an `Atlas`:
order, scale and quantity.
"""

import contextlib
import warnings
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import KW_ONLY, dataclass, field
from itertools import chain
from typing import Literal

import numpy as np

from uplift.atlas.atlas import (
    HIGHEST,
    LOWEST,
    SLACK,
    USED,
    Atlas,
    Entry,
    Header,
    SkippedEntry,
    Source,
)
from uplift.atlas.document import EXPORT, Document, SourceLocation, truncate
from uplift.atlas.samples import Samples, Spectrum, in_order
from uplift.atlas.scales import FLOOR, find_scale
from uplift.atlas.statements import PERCENT, Quantity, Scale
from uplift.common.errors import AtlasError, UpliftWarning, needs_package, warn
from uplift.common.text import listed, pluralise, printable

Measured = Literal["auto", "percent", "fraction"]
Missing = Literal["refuse", "interpolate", "skip"]
MISSING: tuple[Missing, ...] = ("refuse", "interpolate", "skip")
"""What becomes of an entry with a missing value."""
MEASURED: tuple[Measured, ...] = ("auto", "percent", "fraction")
"""Scales of measured values; ``auto`` takes the scale that the file states or, failing
that, decides by the values.
"""
COARSE = 20.0
"""Largest step in nm at which neighbours are alike."""
ODD = 10.0
"""Ratio of a value to both of its neighbours that is likely to be a slip."""


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


def to_atlas(
    document: Document,
    measurements: Measurements,
    format_name: str,
    measured: str = "auto",
    missing: str = "refuse",
) -> Atlas:
    """Make entries of the reflectances of a file: in order of wavelength, without
    missing values, in units of 1.
    """
    reflectances, skipped = _reflectances(document, measurements)
    samples = [
        in_order(spectrum, document.location, missing) for spectrum in reflectances
    ]
    kept = [each for each in samples if not each.skipped]
    if kept:
        left_out = [each for each in samples if each.skipped]
        skipped += [
            SkippedEntry(
                each.spectrum.name, each.skipped, document.path, each.spectrum.line
            )
            for each in left_out
        ]
    else:  # the error of an entry states what is wrong
        kept = samples
    # One scale for all spectra: a dark one alone does not show whether it is in
    # percent.
    scale, scale_note = find_scale(
        document.location, measurements.scales, kept, measured
    )
    entries = [_entry(each, scale, document) for each in kept]
    counts = Counter(chain.from_iterable(each.notes for each in kept))
    changes = [
        f"{count} of {pluralise(len(entries), 'entry')}: {note}"
        for note, count in counts.items()
    ]
    notes = (*measurements.notes, *changes, scale_note) if entries else ()
    safe = tuple(map(printable, notes))
    source = Source(
        document.name,
        document.digest,
        measurements.header,
        format_name,
        measured,
        safe,
        missing=missing,
    )
    return Atlas(tuple(entries), (*measurements.skipped, *skipped), (source,))


def _reflectances(
    document: Document, measurements: Measurements
) -> tuple[list[Spectrum], list[SkippedEntry]]:
    """Separate reflectances from other spectra. Raise `AtlasError` if none may be a
    reflectance.
    """
    kept = list[Spectrum]()
    skipped = list[SkippedEntry]()
    refusals = list[AtlasError]()
    for spectrum in measurements.spectra:
        quantity = spectrum.quantity or measurements.quantity
        if quantity is None or quantity.is_reflectance:
            kept.append(spectrum)
        else:
            reason = f"it is {quantity.name}, not reflectance"
            skipped.append(
                SkippedEntry(spectrum.name, reason, document.path, spectrum.line)
            )
            refusals.append(
                wrong_quantity(quantity, document.location.at(spectrum.line))
            )
    if refusals and not kept:
        raise refusals[0]
    return kept, skipped


def _entry(samples: Samples, scale: float, document: Document) -> Entry:
    """Make an entry of samples on a scale. Invalid ones outside the range that is used
    are cut off.
    """
    spectrum = samples.spectrum
    nm = samples.nm
    scaled = samples.values / scale
    location = document.location.at(spectrum.line, spectrum.name)
    outside = (scaled > HIGHEST) | (scaled < LOWEST)
    if nm.shape == scaled.shape and nm.ndim == 1:
        invalid = outside.copy()
        invalid[1:] |= np.diff(nm) < SLACK
        first = np.flatnonzero(invalid & (nm < USED[0])).max(initial=-1) + 1
        last = np.flatnonzero(invalid & (nm > USED[1])).min(initial=len(nm))
        nm = nm[first:last]
        scaled = scaled[first:last]
        outside = outside[first:last]
    if (
        scale != 1 and outside.any()
    ):  # an entry would name the scaled value, which is not in the file
        at = int(np.argmax(outside))
        limits = f"[{LOWEST * scale:g}, {HIGHEST * scale:g}] on the scale to {scale:g}"
        problem = (
            f"values must be in {limits}, got {scaled[at] * scale:g} at {nm[at]:g} nm"
        )
        raise location.error(problem, "correct the value, or the scale")
    stated = {key: getattr(spectrum, key) for key in ("description", "date", "line")}
    return Entry(spectrum.name, nm, scaled, path=document.path, **stated)


def warn_of_odd(entries: Sequence[Entry]) -> None:
    """Warn of values that are ten times both neighbours, or a tenth."""
    for entry in entries:
        values = np.maximum(entry.values, FLOOR / PERCENT)
        before = values[:-2]
        value = values[1:-1]
        after = values[2:]
        above = value > ODD * np.maximum(before, after)
        below = value * ODD < np.minimum(before, after)
        is_near = entry.wavelengths[2:] - entry.wavelengths[:-2] <= 2 * COARSE
        for at in (
            np.flatnonzero(
                (above | below) & is_near & (np.maximum(value, before) > FLOOR)
            )[:1]
            + 1
        ):
            problem = (
                f"{entry.values[at]:g} at {entry.wavelengths[at]:g} nm is far from "
                "both of its neighbours"
            )
            warning = UpliftWarning(
                problem,
                code="odd-value",
                path=entry.path,
                line=entry.line,
                entry=entry.name,
            )
            warn(warning)


def not_used_note(labels: Iterable[str]) -> tuple[str, ...]:
    """Return the note about columns that are not spectra; none without labels."""
    names = [truncate(label) or "(no label)" for label in labels]
    return (f"not used: {listed(names)}",) if names else ()


def wrong_quantity(quantity: Quantity, location: SourceLocation) -> AtlasError:
    """Create the error for values that are not reflectances."""
    hint = (
        "measure the reflectance, or correct the statement if it is wrong: a cube "
        "holds reflectances"
    )
    if quantity.of_light:
        hint = "it is read by read_lamps(): an atlas holds reflectances"
    problem = (
        f"the file states {quantity.name} ('{truncate(quantity.text)}'), not "
        "reflectance"
    )
    return location.error(problem, hint, code="not-reflectance")


@contextlib.contextmanager
def parsed_by(library: str, kind: str, document: Document) -> Iterator[None]:
    """Import and run another library's reader; its exceptions, which a damaged file may
    cause, become `AtlasError`.
    """
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
