"""Spectra as the reader of a format returns them, and their conversion to an `Atlas`:
order, scale and quantity.
"""

import contextlib
import operator
import warnings
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import KW_ONLY, dataclass, field, replace
from itertools import chain

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
from uplift.common.errors import AtlasError, needs_package
from uplift.common.text import listed, pluralise, printable
from uplift.extras.formats.quantities import (
    DEVIATION,
    Quantity,
    name_quantities,
    value_quantity,
)
from uplift.extras.formats.samples import Samples, Spectrum, in_order
from uplift.extras.formats.scales import find_scale
from uplift.extras.formats.statements import Scale


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
    labelled: bool = True
    """Whether the values have a label."""

    def select(self, document: Document, *, lamps: bool = False) -> "Measurements":
        """Return the reflectances, or the powers of lamps; others are skipped.

        A spectrum has the quantity that its label states, or else that which the names,
        the file or the values do. Raises `AtlasError` if all are of other quantities.
        """
        kept = list[Spectrum]()
        skipped = list(self.skipped)
        refusals = list[tuple[bool, AtlasError]]()
        names = name_quantities([spectrum.name for spectrum in self.spectra])
        for spectrum, by_name in zip(self.spectra, names, strict=True):
            quantity = spectrum.quantity or by_name or self.quantity
            quantity = quantity or value_quantity(spectrum.wavelengths, spectrum.values)
            if quantity is None or quantity.kind.is_used(lamps=lamps):
                kept.append(replace(spectrum, quantity=quantity))
                continue
            error = wrong_quantity(
                quantity, document.location.at(spectrum.line), lamps=lamps
            )
            refusals.append((quantity.kind is DEVIATION, error))
            skipped.append(_skip(spectrum, error.problem, document))
        if refusals and not kept:
            raise min(refusals, key=operator.itemgetter(0))[1]
        return replace(self, spectra=tuple(kept), skipped=tuple(skipped))

    def to_atlas(
        self,
        document: Document,
        format_name: str,
        measured: str = "auto",
        missing: str = "refuse",
        *,
        lamps: bool = False,
    ) -> Atlas:
        """Make entries of the reflectances, or of the powers of lamps: in order of
        wavelength, without missing values, in units of 1.
        """
        selected = self.select(document, lamps=lamps)
        location = document.location
        samples = [
            in_order(spectrum, location, missing) for spectrum in selected.spectra
        ]
        kept = [spectrum for spectrum in samples if not spectrum.skipped]
        skipped = [
            _skip(left.spectrum, left.skipped, document)
            for left in samples
            if left.skipped and kept
        ]
        kept = kept or samples  # the error of an entry states what is wrong
        # One scale for all spectra: a dark one alone does not show whether it is in
        # percent.
        scale, scale_note = find_scale(
            location, self.scales, kept, measured, labelled=self.labelled
        )
        entries = tuple(_entry(spectrum, scale, document) for spectrum in kept)
        notes = (*self.notes, *_changes(kept), scale_note) if entries else ()
        source = Source(
            document.name,
            document.digest,
            self.header,
            format_name,
            measured,
            tuple(map(printable, notes)),
            missing,
        )
        return Atlas(entries, (*selected.skipped, *skipped), (source,))


def _skip(spectrum: Spectrum, reason: str, document: Document) -> SkippedEntry:
    return SkippedEntry(spectrum.name, reason, document.path, spectrum.line)


def _changes(samples: Sequence[Samples]) -> list[str]:
    """Return notes on what was done to samples, with the number of spectra of each."""
    counts = Counter(chain.from_iterable(spectrum.notes for spectrum in samples))
    total = pluralise(len(samples), "entry")
    return [f"{count} of {total}: {note}" for note, count in counts.items()]


def _entry(samples: Samples, scale: float, document: Document) -> Entry:
    """Make an entry of samples on a scale. Invalid ones outside the range that is used
    are cut off.
    """
    spectrum = samples.spectrum
    nm = samples.nm
    scaled = samples.values / scale
    location = document.location.at(spectrum.line, spectrum.name)
    outside = (scaled > HIGHEST) | (scaled < LOWEST)
    is_pair = nm.shape == scaled.shape and nm.ndim == 1
    if is_pair and (outside.any() or (nm[1:] - nm[:-1] < SLACK).any()):
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


def not_used_note(labels: Iterable[str]) -> tuple[str, ...]:
    """Return the note about columns that are not spectra; none without labels."""
    names = [truncate(label) or "(no label)" for label in labels]
    return (f"not used: {listed(names)}",) if names else ()


def wrong_quantity(
    quantity: Quantity, location: SourceLocation, *, lamps: bool = False
) -> AtlasError:
    """Create the error for values that are not reflectances, or not powers of lamps."""
    stated = f"the file states {quantity.kind.name} ('{truncate(quantity.text)}')"
    if lamps:
        problem = f"{stated}, not the power of a lamp"
        hint = "give spectral powers, such as a CSV table"
        return location.error(problem, hint, code="not-a-lamp")
    problem = f"{stated}, not reflectance"
    return location.error(problem, quantity.kind.hint, code="not-reflectance")


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
