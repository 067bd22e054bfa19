"""Atlases and their entries: the result of every reader and the input of
every writer.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import KW_ONLY, dataclass, field, replace
from itertools import chain
from typing import overload

import numpy as np

from uplift.atlas.document import SourceLocation
from uplift.common.arrays import Array, as_array
from uplift.common.errors import UpliftWarning, unknown_name
from uplift.common.text import listed, pluralise

VISIBLE = (400.0, 700.0)
"""Range in nm that every entry must cover. Wavelengths outside have little effect on
colour.
"""

USED = (380.0, 780.0)
"""Range in nm that a cube samples by default."""

LOWEST = -0.05
"""Smallest reflectance, of noise."""
HIGHEST = 2.0
"""Largest reflectance, of fluorescent whites. Larger values have a wrong scale."""

LONGEST = 1e6
"""Largest wavelength in nm, a millimetre. Larger values would overflow in
interpolation.
"""

SLACK = 1e-6
"""Tolerance in nm for the ends of a range, as start + n × increment is rounded."""

ASSUMED = ", assumed: "
"""Part of a note on what a file does not state."""

MAX_NAME = 1000
"""Characters of a name."""


@dataclass(frozen=True, eq=False)
class Entry:
    """One measured reflectance, validated on creation.

    Parameters
    ----------
    name : str
        Name, unique within its `Atlas`.
    wavelengths : array_like, shape (N,)
        Wavelengths in nm: positive, ascending, covering at least 400–700 nm.
    values : array_like, shape (N,)
        Reflectance in units of 1 as measured: noise slightly below 0 or above 1 is
        allowed.
    description, additional_description, device, measured_by, date : str
        Statements of the archive about the measurement.
    path : str, optional
        File of the entry.
    line : int, optional
        First line of the entry in the file, counted from 1.

    Raises
    ------
    AtlasError
        The name or the spectrum is invalid.

    Examples
    --------
    >>> Entry("grey", [380, 580, 780], [0.5, 0.5, 0.5])
    Entry('grey', 3 samples, 380–780 nm)
    """

    name: str
    wavelengths: Array
    values: Array
    _: KW_ONLY
    description: str = ""
    additional_description: str = ""
    device: str = ""
    measured_by: str = ""
    date: str = ""
    path: str | None = None
    line: int | None = None

    def __post_init__(self) -> None:
        location = SourceLocation(self.path, self.line, self.name)
        for key in ("wavelengths", "values"):
            try:
                samples = as_array(getattr(self, key)).copy()
            except (TypeError, ValueError):
                raise location.error(
                    f"the {key} are not all numbers", "give an array of numbers"
                ) from None
            samples.setflags(write=False)
            object.__setattr__(self, key, samples)
        for problem, hint in chain(
            _name_faults(self.name), _sample_faults(self.wavelengths, self.values)
        ):
            raise location.error(problem, hint)

    def __repr__(self) -> str:
        first, last = self.wavelengths[[0, -1]]
        return (
            f"Entry({self.name!r}, {pluralise(len(self.values), 'sample')}, "
            f"{first:g}–{last:g} nm)"
        )

    @property
    def step(self) -> float | None:
        """Sampling step in nm; None if the sampling is irregular."""
        steps = np.diff(self.wavelengths)
        return round(float(steps.mean()), 6) if np.ptp(steps) <= 1e-6 else None


@dataclass(frozen=True)
class SkippedEntry:
    """An entry of a file that is not a plain reflectance.

    Parameters
    ----------
    name : str
        Name of the entry.
    reason : str
        Why it cannot be used.
    path : str, optional
        File of the entry.
    line : int, optional
        First line of the entry in the file.
    """

    name: str
    reason: str
    path: str | None = None
    line: int | None = None


def skipped_warning(skipped: Sequence[SkippedEntry], *, code: str) -> UpliftWarning:
    """Create one warning for all skipped entries, with the location and the reason of
    the first one.
    """
    first, *others = skipped
    problem = f"skipped: {first.reason}"
    if others:
        names = listed([f"'{entry.name}'" for entry in others])
        problem += f"; {len(others)} more are skipped: {names}"
    return UpliftWarning(
        problem, code=code, path=first.path, line=first.line, entry=first.name
    )


@dataclass(frozen=True)
class Header:
    """Statements of an archive about itself, empty if it makes none.

    Parameters
    ----------
    content, copyright, licence : str
        One line each.
    """

    content: str = ""
    copyright: str = ""
    licence: str = ""


@dataclass(frozen=True)
class Source:
    """A file that entries were read from.

    Parameters
    ----------
    name : str
        Base name.
    digest : str
        SHA-256 of its bytes, in hexadecimal digits.
    header : Header
        Statements of the file about itself.
    format : str
        Name of the format that was recognised; empty for spectra that come from
        elsewhere.
    measured : {"auto", "percent", "fraction"}
        Scale of the values that the caller gave.
    notes : tuple of str
        How the content was understood: layout, scale, and columns that are not spectra.
    missing : {"refuse", "interpolate", "skip"}
        What the caller wanted of entries with missing values.
    """

    name: str
    digest: str
    header: Header = field(default_factory=Header)
    format: str = ""
    measured: str = "auto"
    notes: tuple[str, ...] = ()
    missing: str = "refuse"

    @property
    def assumptions(self) -> tuple[str, ...]:
        """Notes on what the file does not state."""
        return tuple(note for note in self.notes if ASSUMED in note)

    def changed_options(self) -> dict[str, str]:
        """Return the options of reading that the caller gave.

        Returns
        -------
        dict of str to str
            ``measured`` and ``missing``, without defaults.
        """
        options = {"measured": self.measured, "missing": self.missing}
        return {
            name: value
            for name, value in options.items()
            if value not in ("auto", "refuse")
        }


@dataclass(frozen=True, repr=False)
class Atlas:
    """A sequence of entries with unique names.

    Iteration yields entries. An index is a name, a position, or a slice, which gives an
    atlas.

    Parameters
    ----------
    entries : tuple of Entry
        Entries, in the order of their files.
    skipped : tuple of SkippedEntry
        Entries of the files that were not used.
    sources : tuple of Source
        The files.

    Raises
    ------
    AtlasError
        Two entries share a name.

    Examples
    --------
    >>> grey = Entry("grey", [380, 780], [0.5, 0.5])
    >>> atlas = Atlas((grey, Entry("white", [380, 780], [0.9, 0.9])))
    >>> atlas
    Atlas(2 entries, 380–780 nm)
    >>> atlas["white"].values.tolist(), "black" in atlas, atlas[:1].names
    ([0.9, 0.9], False, ('grey',))
    """

    entries: tuple[Entry, ...] = ()
    skipped: tuple[SkippedEntry, ...] = ()
    sources: tuple[Source, ...] = ()

    def __post_init__(self) -> None:
        # The first entry of each name; the second one is refused with the place of the
        # first.
        named: dict[str, Entry] = {}
        for entry in self.entries:
            first = named.setdefault(entry.name, entry)
            if first is not entry:
                place = ":".join(map(str, filter(None, (first.path, first.line))))
                where = f": first used at {place}" if place else ""
                location = SourceLocation(entry.path, entry.line, entry.name)
                is_copy = (
                    first.wavelengths.shape == entry.wavelengths.shape
                    and np.allclose(first.values, entry.values)
                )
                hint = (
                    "leave out one of the two files"
                    if is_copy
                    else "rename or remove one of the two"
                )
                raise location.error(f"the name is taken{where}", hint)

    def __len__(self) -> int:
        return len(self.entries)

    def __iter__(self) -> Iterator[Entry]:
        return iter(self.entries)

    def __contains__(self, item: object) -> bool:
        return any(item is entry or item == entry.name for entry in self.entries)

    @overload
    def __getitem__(self, key: str | int) -> Entry: ...
    @overload
    def __getitem__(self, key: slice) -> "Atlas": ...
    def __getitem__(self, key: str | int | slice) -> "Entry | Atlas":
        if isinstance(key, slice):
            return replace(self, entries=self.entries[key])
        if not isinstance(key, str):
            return self.entries[key]
        for entry in self.entries:
            if entry.name == key:
                return entry
        raise unknown_name(key, self.names, "atlas entry")

    def __repr__(self) -> str:
        parts = [pluralise(len(self), "entry")]
        if self.entries:
            first = min(entry.wavelengths[0] for entry in self.entries)
            last = max(entry.wavelengths[-1] for entry in self.entries)
            parts.append(f"{first:g}–{last:g} nm")
        if self.skipped:
            parts.append(f"{len(self.skipped)} skipped")
        if self.sources:
            parts.append("from " + listed([source.name for source in self.sources]))
        return f"Atlas({', '.join(parts)})"

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the entries."""
        return tuple(entry.name for entry in self.entries)


def merge(atlases: Iterable[Atlas]) -> Atlas:
    """Merge atlases into one, in order.

    Parameters
    ----------
    atlases : iterable of Atlas
        The atlases.

    Returns
    -------
    Atlas

    Raises
    ------
    AtlasError
        Two entries share a name.
    """
    entries = list[Entry]()
    skipped = list[SkippedEntry]()
    sources = list[Source]()
    for atlas in atlases:
        entries += atlas.entries
        skipped += atlas.skipped
        sources += atlas.sources
    return Atlas(tuple(entries), tuple(skipped), tuple(sources))


def _name_faults(name: str) -> Iterator[tuple[str, str]]:
    """Yield problems of a name, with hints. The first one counts."""
    if name != name.strip() or len(name.splitlines()) != 1 or "\0" in name:
        yield (
            "the name must be one line of text without surrounding blanks",
            "give every entry a unique name",
        )
    if len(name) > MAX_NAME or name != name.encode(errors="ignore").decode():
        problem = (
            f"the name must have at most {MAX_NAME} characters, all of them valid "
            "Unicode"
        )
        yield problem, "give the entry a shorter name"


def _sample_faults(wavelengths: Array, values: Array) -> Iterator[tuple[str, str]]:
    """Yield problems of samples (N,) in nm and units of 1, with hints. The first one
    counts.
    """
    if wavelengths.ndim != 1 or wavelengths.shape != values.shape:
        problem = (
            "wavelengths and values must have the same shape (N,), got "
            f"{wavelengths.shape} and {values.shape}"
        )
        yield problem, "give one wavelength for every value"
    if len(wavelengths) < 2:
        yield (
            f"an entry needs at least 2 samples, got {len(wavelengths)}",
            "add the missing samples",
        )
    for i in (~(np.isfinite(wavelengths) & np.isfinite(values))).nonzero()[0]:
        problem = (
            f"sample {i + 1} is not finite: {values[i]:g} at {wavelengths[i]:g} nm"
        )
        yield problem, "replace it by the measured value or remove the entry"
    first = wavelengths[0]
    last = wavelengths[-1]
    if first <= 0 or last > LONGEST:
        invalid = first if first <= 0 else last
        problem = f"wavelengths must be in (0, {LONGEST:g}] nm, got {invalid:g}"
        yield problem, "give wavelengths in nm"
    for i in (wavelengths[1:] - wavelengths[:-1] < SLACK).nonzero()[0]:
        problem = (
            f"wavelengths must ascend, got {wavelengths[i]:g} nm, then "
            f"{wavelengths[i + 1]:g} nm"
        )
        yield problem, "sort the samples by wavelength, each wavelength once"
    if first > VISIBLE[0] + SLACK or last < VISIBLE[1] - SLACK:
        problem = (
            f"an entry must cover {VISIBLE[0]:g}–{VISIBLE[1]:g} nm, got "
            f"{first:g}–{last:g} nm"
        )
        yield problem, "add the missing samples and give wavelengths in nm"
    for i in ((values > HIGHEST) | (values < LOWEST)).nonzero()[0]:
        problem = (
            f"reflectance must be in [{LOWEST:g}, {HIGHEST:g}], got {values[i]:g} at "
            f"{wavelengths[i]:g} nm"
        )
        yield problem, "correct the value, or the scale of the file"
