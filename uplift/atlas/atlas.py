"""Measured reflectances with names: what every atlas reader gives and every writer takes."""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from uplift.atlas.checks import Array, check_name, check_spectrum
from uplift.atlas.document import SourceLocation


@dataclass(frozen=True, eq=False)
class Entry:
    """One measured reflectance, checked when it is made.

    Parameters
    ----------
    name : unique within its `Atlas`.
    wavelengths : (N,) nm, positive, ascending, covering at least 400–700 nm.
    values : (N,) reflectance in units of 1, as measured: slightly below 0 or above 1 is allowed.
    description, additional, device, measured_by, date : what the archive says about the measurement.
    path, line : where the entry stood.

    Raises
    ------
    AtlasError : with path, line, name and hint.
    """

    name: str
    wavelengths: Array
    values: Array
    description: str = ""
    additional: str = ""
    device: str = ""
    measured_by: str = ""
    date: str = ""
    path: str | None = None
    line: int | None = None

    def __post_init__(self) -> None:
        place = SourceLocation(self.path, self.line, self.name)
        check_name(self.name, place)
        for key in ("wavelengths", "values"):
            object.__setattr__(self, key, _samples(getattr(self, key), key, place))
        check_spectrum(self.wavelengths, self.values, place)

    @property
    def step(self) -> float | None:
        """The sampling step in nm, None where it is irregular."""
        steps = np.diff(self.wavelengths)
        return round(float(steps.mean()), 6) if np.ptp(steps) <= 1e-6 else None


@dataclass(frozen=True)
class SkippedEntry:
    """An entry that a cube of plain reflectances cannot hold, and why."""

    name: str
    reason: str
    path: str | None = None
    line: int | None = None

    def __str__(self) -> str:
        return f"{self.path}:{self.line}: entry '{self.name}' skipped: {self.reason}"


@dataclass(frozen=True)
class Header:
    """What an archive says about itself."""

    content: str = ""
    copyright: str = ""
    licence: str = ""


@dataclass(frozen=True)
class Source:
    """A file that was read: base name, sha256 (hex) of its bytes, and its header."""

    name: str
    digest: str
    header: Header = field(default_factory=Header)


@dataclass(frozen=True)
class Atlas:
    """An atlas: entries in the order they were read, and what was left out.

    Raises
    ------
    AtlasError : two entries share a name; names both places.
    """

    entries: tuple[Entry, ...] = ()
    skipped: tuple[SkippedEntry, ...] = ()
    sources: tuple[Source, ...] = ()

    def __post_init__(self) -> None:
        first: dict[str, Entry] = {}
        for entry in self.entries:
            if first.setdefault(entry.name, entry) is not entry:
                raise _duplicate(first[entry.name], entry)

    def __len__(self) -> int:
        return len(self.entries)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the entries."""
        return tuple(entry.name for entry in self.entries)


def merge(parts: Iterable[Atlas]) -> Atlas:
    """Several atlases as one, in order. Raises `AtlasError` where two entries share a name."""
    parts = tuple(parts)
    chain = itertools.chain.from_iterable
    return Atlas(
        tuple(chain(part.entries for part in parts)),
        tuple(chain(part.skipped for part in parts)),
        tuple(chain(part.sources for part in parts)),
    )


def _samples(samples: ArrayLike, key: str, place: SourceLocation) -> Array:
    """A copy that nobody can change."""
    try:
        array = np.array(samples, dtype=np.float64)
    except (TypeError, ValueError):
        raise place.error(f"the {key} are not all numbers", "give an array of numbers") from None
    array.setflags(write=False)
    return array


def _duplicate(first: Entry, second: Entry) -> Exception:
    where = "" if first.path is None else f": first used at {first.path}:{first.line}"
    place = SourceLocation(second.path, second.line, second.name)
    return place.error(f"the name is taken{where}", "rename or remove one of the two")
