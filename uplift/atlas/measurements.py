"""Spectra as the reader of a format returns them, and their conversion to an `Atlas`: order, scale and quantity."""

import contextlib
import re
import warnings
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import KW_ONLY, dataclass, field
from typing import Literal

import numpy as np

from uplift.atlas.atlas import HIGHEST, LOWEST, Atlas, Entry, Header, SkippedEntry, Source
from uplift.atlas.document import EXPORT, Document, SourceLocation, truncate
from uplift.common.arrays import Array
from uplift.common.errors import AtlasError, UpliftWarning, needs_package
from uplift.common.text import listed, printable

Measured = Literal["auto", "percent", "fraction"]
MEASURED: tuple[Measured, ...] = ("auto", "percent", "fraction")
"""Scales of measured values; ``auto`` takes the scale that the file states or, failing that, decides by the values."""
GIVEN = {"percent": "percent", "fraction": "0 to 1"}
PERCENT = 100.0
DARKEST = 1.0
"""A row of a table in percent whose values are all below this number is darker than any common material."""
JUMP, FLOOR = 30.0, 0.1
"""Ratio of neighbouring samples that no reflectance has, and the smallest divisor in units of the table."""
NOT_REFLECTANCE = re.compile(
    r"transmi(?:ttance|ssion|ssive)|absorbance|absorptance|irradiance|radiance|emissi(?:on|ve)|t-factor", re.I
)
REFLECTANCE = re.compile(r"reflect|remission|\br-factor", re.I)


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


@dataclass(frozen=True, eq=False)
class Measurements:
    """Content of a file."""

    spectra: tuple[Spectrum, ...]
    """Reflectances."""
    _: KW_ONLY
    skipped: tuple[SkippedEntry, ...] = ()
    """Other spectra."""
    scale: float | None = None
    """Divisor to units of 1 that the file states."""
    header: Header = field(default_factory=Header)
    """Statements of the file about itself."""
    notes: tuple[str, ...] = ()
    """How the content was understood."""
    material: str = ""
    """Quantity of materials that the file states; its values are not the power of lamps."""
    refusal: AtlasError | None = None
    """Error to raise where reflectances are wanted: the file states another quantity."""


def to_atlas(document: Document, measurements: Measurements, format_name: str, measured: str = "auto") -> Atlas:
    """Validate the spectra of a file: turn descending ones round, and scale all of them by one number."""
    if measurements.refusal is not None:
        raise measurements.refusal
    rows = [np.asarray(spectrum.values, dtype=float) for spectrum in measurements.spectra]
    scale, scale_note = _scale(document.location, measurements, rows, measured)
    # One scale for all spectra: a dark one alone does not show whether it is in percent.
    entries, notes, descending = list[Entry](), list(measurements.notes), 0
    for spectrum, values in zip(measurements.spectra, rows, strict=True):
        nm, scaled = np.asarray(spectrum.wavelengths, dtype=float), values / scale
        outside = (scaled > HIGHEST) | (scaled < LOWEST)
        if scale != 1 and outside.any():  # an entry would name the scaled value, which is not in the file
            at = int(np.argmax(outside))
            limits = f"[{LOWEST * scale:g}, {HIGHEST * scale:g}] on the scale to {scale:g}"
            problem = f"values must be in {limits}, got {values[at]:g} at {nm[at]:g} nm"
            location = document.location.at(spectrum.line, spectrum.name)
            raise location.error(problem, "correct the value, or the scale")
        if len(nm) > 1 and (nm[1:] < nm[:-1]).all():
            nm, scaled = nm[::-1], scaled[::-1]
            descending += 1
        stated = {key: getattr(spectrum, key) for key in ("description", "date", "line")}
        entries.append(Entry(spectrum.name, nm, scaled, path=document.path, **stated))
    if descending:
        notes.append(f"{descending} of {len(entries)} spectra descended in wavelength and were reversed")
    safe = tuple(map(printable, (*notes, scale_note)))
    source = Source(document.name, document.digest, measurements.header, format_name, measured, safe if entries else ())
    return Atlas(tuple(entries), measurements.skipped, (source,))


def not_used_note(labels: Iterable[str]) -> tuple[str, ...]:
    """Return the note about columns that are not spectra; none without labels."""
    names = [truncate(label) or "(no label)" for label in labels]
    return (f"not used: {listed(names)}",) if names else ()


def wrong_quantity(problem: str, location: SourceLocation) -> AtlasError:
    """Create the error for values that are not reflectances."""
    hint = "measure the reflectance, or correct the statement if it is wrong: a cube holds reflectances"
    return location.error(problem, hint)


def find_quantity(text: str, location: SourceLocation) -> AtlasError | None:
    """Return the error for a text that names another quantity, and not reflectance."""
    found = NOT_REFLECTANCE.search(text)
    if found is None or REFLECTANCE.search(text):
        return None
    return wrong_quantity(f"the file states '{found[0].lower()}', not reflectance", location)


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
    location: SourceLocation, measurements: Measurements, rows: Sequence[Array], measured: str
) -> tuple[float, str]:
    """Return the divisor of the values (N,) of each spectrum, and a note about it."""
    if measured != "auto":
        return PERCENT if measured == "percent" else 1.0, f"scale: {GIVEN[measured]}, as given"
    if measurements.scale is not None:
        return measurements.scale, f"scale: 0 to {measurements.scale:g}, as the file states"
    highest = [float(row[np.isfinite(row)].max(initial=0)) for row in rows]
    if max(highest, default=0) <= HIGHEST:
        return 1.0, "scale: 0 to 1, by the values"
    _check_one_scale(location, measurements.spectra, rows, highest)
    top = int(np.argmax(highest))
    problem = f"values up to {highest[top]:g} are read as percent and divided by 100"
    entry = measurements.spectra[top].name
    warnings.warn(UpliftWarning(problem, code="values-in-percent", path=location.path, entry=entry), stacklevel=4)
    return PERCENT, f"scale: percent, by values up to {highest[top]:g}"


def _check_one_scale(
    location: SourceLocation, spectra: Sequence[Spectrum], rows: Sequence[Array], highest: Sequence[float]
) -> None:
    """Raise `AtlasError` for a row in units of 1 among rows in percent, or the reverse, or within one row."""
    problem, odd = "", 0
    # A row that never exceeds 1, where others are in percent, is in units of 1, or the reverse; the minority is named.
    dark = [row for row, top in enumerate(highest) if top <= DARKEST]
    if dark:
        light = [row for row, top in enumerate(highest) if top > HIGHEST]
        (odd, *_), (usual, *_) = sorted((dark, light), key=len)
        problem = f"values up to {highest[odd]:g}, where '{truncate(spectra[usual].name)}' has up to {highest[usual]:g}"
    for row, values in enumerate(rows):
        # Neighbours that differ by more than JUMP, one of them within [0, 1], and the other one in percent.
        low, high = np.minimum(values[:-1], values[1:]), np.maximum(values[:-1], values[1:])
        jumps = np.flatnonzero((low <= DARKEST) & (high > HIGHEST) & (high / JUMP > np.maximum(low, FLOOR)))
        if len(jumps):
            odd, at = row, jumps[0]
            problem = f"{values[at]:g}, then {values[at + 1]:g}, at {spectra[row].wavelengths[at + 1]:g} nm"
            break
    if problem:
        raise location.at(spectra[odd].line, spectra[odd].name).error(
            f"mixed scales of percent and 0 to 1: {problem}",
            "correct the row, or pass measured='percent' or measured='fraction' if it is right",
            code="mixed-scales",
        )
