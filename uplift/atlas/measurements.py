"""Spectra as the reader of a format returns them, and their conversion to an `Atlas`: order, scale and quantity."""

from __future__ import annotations

import contextlib
import re
import warnings
from collections.abc import Iterable, Iterator, Sequence
from contextvars import ContextVar
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from uplift.atlas.atlas import HIGHEST, Atlas, Entry, Header, SkippedEntry, Source
from uplift.atlas.document import Document, SourceLocation, truncate
from uplift.common.arrays import Array
from uplift.common.errors import AtlasError, OptionError, UpliftWarning
from uplift.common.text import printable

Measured = Literal["auto", "percent", "fraction"]
MEASURED: tuple[Measured, ...] = ("auto", "percent", "fraction")
"""Scales of measured values; ``auto`` takes the scale that the file states or, failing that, decides by the values."""
PERCENT = 100.0
DARKEST = 1.0
"""A row of a table in percent whose values are all below this number is darker than any common material."""
JUMP, FLOOR = 30.0, 0.1
"""Ratio of neighbouring samples that no reflectance has, and the smallest divisor in units of the table."""
NOT_REFLECTANCE = re.compile(
    r"transmi(?:ttance|ssion|ssive)|absorbance|absorptance|irradiance|radiance|emissi(?:on|ve)|t-factor", re.I
)
REFLECTANCE = re.compile(r"reflect|remission|\br-factor", re.I)
_POWER = ContextVar("power", default=False)
MAX_LISTED = 8
"""Names of columns that a note lists."""


@dataclass(frozen=True, eq=False)
class Spectrum:
    """One spectrum of a file, not validated."""

    name: str
    """Name of the entry."""
    wavelengths: Sequence[float] | Array
    values: Sequence[float] | Array
    """(N,) Wavelengths in nm, ascending or descending, and values in units of the file."""
    line: int | None = None
    """First line of the spectrum in the file."""
    description: str = ""
    device: str = ""
    date: str = ""
    """Statements of the file about the measurement."""


@dataclass(frozen=True, eq=False)
class Measurements:
    """Content of a file."""

    spectra: tuple[Spectrum, ...]
    """Reflectances."""
    skipped: tuple[SkippedEntry, ...] = ()
    """Other spectra."""
    scale: float | None = None
    """Divisor to units of 1 that the file states."""
    header: Header = field(default_factory=Header)
    """Statements of the file about itself."""
    notes: tuple[str, ...] = ()
    """How the content was understood."""


def check_measured(measured: str) -> None:
    """Raise `OptionError` (code ``unknown-scale``) unless ``measured`` is one of `MEASURED`."""
    if measured not in MEASURED:
        raise OptionError(
            f"unknown scale of measured values '{truncate(str(measured))}'",
            code="unknown-scale",
            hint=f"use one of {', '.join(MEASURED)}",
        )


def to_atlas(document: Document, measurements: Measurements, format_name: str, measured: str = "auto") -> Atlas:
    """Validate the spectra of a file: turn descending ones round, and scale all of them by one number."""
    spectra = measurements.spectra
    scale, scale_note = _scale(document.path, spectra, measurements.scale, measured)
    entries, notes, descending = list[Entry](), list(measurements.notes), 0
    for spectrum in spectra:
        wavelengths, values = (np.asarray(each, dtype=float) for each in (spectrum.wavelengths, spectrum.values))
        if len(wavelengths) > 1 and (wavelengths[1:] < wavelengths[:-1]).all():
            wavelengths, values = wavelengths[::-1], values[::-1]
            descending += 1
        stated = {key: getattr(spectrum, key) for key in ("description", "device", "date", "line")}
        entries.append(Entry(spectrum.name, wavelengths, values / scale, path=document.path, **stated))
    if descending:
        notes.append(f"{descending} of {len(spectra)} spectra descended in wavelength and were reversed")
    safe = tuple(map(printable, (*notes, scale_note)))
    source = Source(document.name, document.digest, measurements.header, format_name, measured, safe if spectra else ())
    return Atlas(tuple(entries), measurements.skipped, (source,))


def not_used_note(labels: Iterable[str]) -> tuple[str, ...]:
    """Return the note about columns that are not spectra; none without labels."""
    names = [truncate(label) or "(no label)" for label in labels]
    if not names:
        return ()
    more = f" and {len(names) - MAX_LISTED} more" if len(names) > MAX_LISTED else ""
    return (f"not used: {', '.join(names[:MAX_LISTED])}{more}",)


@contextlib.contextmanager
def accept_power() -> Iterator[None]:
    """Let readers accept files of the power of lamps, which state another quantity than reflectance."""
    token = _POWER.set(True)
    try:
        yield
    finally:
        _POWER.reset(token)


def refuse_quantity(problem: str, location: SourceLocation) -> None:
    """Raise `AtlasError` (code ``not-a-reflectance``), except within `accept_power`."""
    if not _POWER.get():
        hint = "measure the reflectance, or correct the statement if it is wrong: a cube holds reflectances"
        raise location.error(problem, hint, code="not-a-reflectance")


def refuse_as_lamp(quantity: str, location: SourceLocation) -> None:
    """Raise `AtlasError` (code ``not-a-lamp``) within `accept_power`: the file states a quantity of materials."""
    if _POWER.get():
        raise location.error(
            f"the file states '{truncate(quantity)}', not the power of a lamp",
            "give spectral powers, such as a CSV table",
            code="not-a-lamp",
        )


def check_quantity(text: str, location: SourceLocation) -> None:
    """Raise `AtlasError` (code ``not-a-reflectance``) if a text names another quantity, and not reflectance."""
    found = NOT_REFLECTANCE.search(text)
    if found and not REFLECTANCE.search(text):
        refuse_quantity(f"the file states '{found[0].lower()}', not reflectance", location)


@contextlib.contextmanager
def parsed_by(library: str, kind: str, path: str) -> Iterator[None]:
    """Translate the exceptions of another library's reader, which a damaged file may raise, to `AtlasError`."""
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        try:
            yield
        except (AtlasError, MemoryError):
            raise
        except Exception as error:
            reason = truncate(str(error)) or type(error).__name__
            raise SourceLocation(path).error(
                f"cannot be read as {kind} by {library}: {reason}", "export the file again, or export a CSV table"
            ) from error


def _scale(path: str, spectra: Sequence[Spectrum], stated: float | None, measured: str) -> tuple[float, str]:
    """Return the divisor of the values, and a note about it."""
    if measured == "percent":
        return PERCENT, "scale: percent, as given"
    if measured == "fraction":
        return 1.0, "scale: 0 to 1, as given"
    if stated is not None:
        return stated, f"scale: 0 to {stated:g}, as the file states"
    values = [np.asarray(spectrum.values, dtype=float) for spectrum in spectra]
    highest = [float(row[np.isfinite(row)].max(initial=0)) for row in values]
    top = int(np.argmax(highest)) if highest else 0
    if not highest or highest[top] <= HIGHEST:
        return 1.0, "scale: 0 to 1, by the values"
    _check_rows(path, spectra, values, highest)
    problem = f"values up to {highest[top]:g} are read as percent and divided by 100"
    warning = UpliftWarning(problem, code="values-in-percent", path=path, entry=spectra[top].name)
    warnings.warn(warning, stacklevel=5)
    return PERCENT, f"scale: percent, by values up to {highest[top]:g}"


def _check_rows(path: str, spectra: Sequence[Spectrum], values: Sequence[Array], highest: Sequence[float]) -> None:
    """Raise `AtlasError` for a row in units of 1 among rows in percent, or the reverse, or within one row."""
    for spectrum, row in zip(spectra, values, strict=True):
        low, high = np.minimum(row[:-1], row[1:]), np.maximum(row[:-1], row[1:])
        jump = np.flatnonzero((low <= DARKEST) & (high > HIGHEST) & (high / JUMP > np.maximum(low, FLOOR)))
        if len(jump):
            place = int(jump[0])
            pair = f"{row[place]:g} and {row[place + 1]:g}"
            nm = f"{spectrum.wavelengths[place]:g} and {spectrum.wavelengths[place + 1]:g} nm"
            raise _mixed(path, spectrum, f"{pair} at {nm}")
    dark = [index for index, top in enumerate(highest) if top <= DARKEST]
    light = [index for index, top in enumerate(highest) if top > HIGHEST]
    if dark:
        (odd, *_), (usual, *_) = sorted((dark, light), key=len)
        problem = f"values up to {highest[odd]:g}, where '{truncate(spectra[usual].name)}' has up to {highest[usual]:g}"
        raise _mixed(path, spectra[odd], problem)


def _mixed(path: str, spectrum: Spectrum, problem: str) -> AtlasError:
    return SourceLocation(path, spectrum.line, spectrum.name).error(
        f"mixed scales of percent and 0 to 1: {problem}",
        "correct the row, or pass measured='percent' or measured='fraction' if it is right",
        code="mixed-scales",
    )
