"""Where atlases come from and go to: files, the atlases that are installed with uplift,
and other libraries.
"""

import difflib
import functools
import hashlib
import os
from collections.abc import Mapping
from dataclasses import astuple, dataclass, replace
from importlib import import_module
from importlib.resources import files
from pathlib import Path
from typing import Any, Literal

import numpy as np

from uplift.atlas import art
from uplift.atlas.atlas import Atlas, Entry, Header, Source, merge, skipped_warning
from uplift.atlas.document import EXPORT, Document, SourceLocation, read_document
from uplift.atlas.formats import ART, known_formats, read_any
from uplift.common.arrays import StrPath
from uplift.common.errors import OutputError, UpliftWarning, unknown_name, warn
from uplift.common.files import write_text
from uplift.common.text import listed, pluralise

Measured = Literal["auto", "percent", "fraction"]
Missing = Literal["refuse", "interpolate", "skip"]
MEASURED: tuple[Measured, ...] = ("auto", "percent", "fraction")
"""Scales of measured values; ``auto`` takes the scale that the file states or, failing
that, decides by the values.
"""
MISSING: tuple[Missing, ...] = ("refuse", "interpolate", "skip")
"""What becomes of an entry with a missing value."""
COARSE = 20.0
"""Largest step in nm at which neighbours are alike."""
ODD = 10.0
"""Ratio of a value to both of its neighbours that is likely to be a slip."""
DARK = 1e-3
"""Reflectance below which a ratio shows no slip."""
VISIBLY = 0.1
"""Reflectance above which a slip matters."""
PACKAGE = "uplift_atlases"
"""Name under which the folder atlases/ of the repository is installed."""
FORMS = (
    "pass a mapping of names to distributions with .wavelengths and .values, "
    "one distribution with .name, or several with .labels"
)


def read_atlas(
    *paths: StrPath, measured: Measured = "auto", missing: Missing = "refuse"
) -> Atlas:
    """Read atlas files into one atlas. The content of a file determines its format, one
    of `known_formats`.

    Parameters
    ----------
    *paths : path-like
        Files, in the order of their entries. Where a file does not exist, a shipped
        atlas of that name is read, in any case, with or without the suffix ``.txt``;
        see `shipped_atlases`.
    measured : {"auto", "percent", "fraction"}
        Scale of the values. ``"auto"`` takes the scale that a file states, or else
        decides by its values. Measurement archives always state their scale.
    missing : {"refuse", "interpolate", "skip"}
        What becomes of an entry that lacks a value within 380–780 nm: an error,
        interpolation between its neighbours, or the entry is left out with a warning.
        Values that are missing elsewhere are always left out.

    Returns
    -------
    Atlas

    Raises
    ------
    AtlasError
        A file cannot be read, or two entries share a name. The error has path, line,
        entry and hint.
    UnknownNameError
        The scale, or what becomes of missing values, is unknown.

    Warns
    -----
    UpliftWarning
        Entries were skipped (``entry-skipped``), a table was read as percent
        (``values-in-percent``), a file in percent has no value above 1
        (``dark-percent``), a value is far from its neighbours (``odd-value``), or a
        shipped atlas replaces a missing file (``shipped-atlas``); the name ``macbeth``
        without a suffix gives no warning.

    Examples
    --------
    >>> import uplift
    >>> macbeth = uplift.read_atlas("macbeth")
    >>> macbeth["orange"]
    Entry('orange', 81 samples, 380–780 nm)
    """
    if measured not in MEASURED:
        raise unknown_name(str(measured), MEASURED, "scale")
    if missing not in MISSING:
        raise unknown_name(str(missing), MISSING, "treatment of missing values")
    atlases = []
    for document in map(read_named, list(map(find_atlas_file, paths))):
        chosen, content = read_any(document)
        if not isinstance(content, Atlas):
            content = content.to_atlas(document, chosen.name, measured, missing)
        atlases.append(content)
    atlas = merge(atlases)
    if atlas.skipped and not atlas.entries:
        first = atlas.skipped[0]
        reasons = list(dict.fromkeys(entry.reason for entry in atlas.skipped))
        raise SourceLocation(first.path, first.line).error(
            f"none of {pluralise(len(atlas.skipped), 'entry')} is a reflectance: "
            f"{listed(reasons)}",
            EXPORT,
            code="not-reflectance",
        )
    for entry in atlas:
        _warn_of_odd(entry)
    if atlas.skipped:
        warn(skipped_warning(atlas.skipped, code="entry-skipped"))
    return atlas


def _warn_of_odd(entry: Entry) -> None:
    """Warn of the first value that is ten times both neighbours, or a tenth."""
    values = np.maximum(entry.values, DARK)
    before = values[:-2]
    value = values[1:-1]
    after = values[2:]
    above = value > ODD * np.maximum(before, after)
    below = value * ODD < np.minimum(before, after)
    if not (above | below).any():
        return
    is_near = entry.wavelengths[2:] - entry.wavelengths[:-2] <= 2 * COARSE
    is_bright = np.maximum(value, before) > VISIBLY
    odd = np.flatnonzero((above | below) & is_near & is_bright) + 1
    if not len(odd):
        return
    at = odd[0]
    problem = (
        f"{entry.values[at]:g} at {entry.wavelengths[at]:g} nm is far from both of its "
        "neighbours"
    )
    warn(
        UpliftWarning(
            problem,
            code="odd-value",
            path=entry.path,
            line=entry.line,
            entry=entry.name,
        )
    )


def write_atlas(
    atlas: Atlas, path: StrPath, header: Header | None = None, *, force: bool = True
) -> None:
    """Write an atlas atomically.

    Parameters
    ----------
    atlas : Atlas
        The entries to write.
    path : path-like
        The file. With the suffix ``.csv`` it is a table, otherwise atlas text.
    header : Header, optional
        Statements about the archive, by default those of the sources. A table has no
        header.
    force : bool, default True
        Replace an existing file.

    Raises
    ------
    OutputError
        The atlas is empty, the path cannot be written, the file exists and ``force`` is
        false, or the entries of a table differ in sampling.
    """
    if not atlas.entries:
        problem = "an atlas to write must have entries, got none"
        raise OutputError(
            problem, path=path, hint="give an atlas that contains reflectances"
        )
    if header is None:  # the statements of all sources, each one once
        stated = zip(*(astuple(source.header) for source in atlas.sources), strict=True)
        header = Header(
            *("; ".join(filter(None, dict.fromkeys(texts))) for texts in stated)
        )
    suffix = os.path.splitext(path)[1].lower()
    written = [form for form in known_formats() if form.written]
    form = next((form for form in written if form.suffixes[0] == suffix), ART)
    if suffix not in ("", form.suffixes[0], *ART.suffixes):
        known = " or ".join(form.suffixes[0] for form in written)
        problem = f"an atlas is written to files ending in {known}"
        raise OutputError(problem, path=path, hint="give another name")
    text = import_module(form.module).text(atlas, header)
    write_text(text, path, force=force)


def from_distributions(distributions: Any) -> Atlas:
    """Create an atlas from distributions of colour-science, or from objects with the
    same attributes.

    Parameters
    ----------
    distributions : mapping or object
        A mapping of names to objects with ``wavelengths`` (N,) in nm and ``values``
        (N,) in units of 1; one object with ``labels`` (E,), ``wavelengths`` (N,) and
        ``values`` (N, E); or one distribution with ``name``, ``wavelengths`` and
        ``values``.

    Returns
    -------
    Atlas

    Raises
    ------
    AtlasError
        An object lacks these attributes, or is not a reflectance in units of 1.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> grey = SimpleNamespace(wavelengths=[380, 780], values=[0.5, 0.5])
    >>> from_distributions({"grey": grey}).names
    ('grey',)
    """
    named = distributions
    if not isinstance(distributions, Mapping):
        named = {
            getattr(distributions, "name", type(distributions).__name__): distributions
        }
    entries = list[Entry]()
    for name, distribution in named.items():
        try:
            nm = distribution.wavelengths
            values = distribution.values
        except AttributeError:
            problem = f"'{type(distribution).__name__}' is not a spectral distribution"
            raise SourceLocation(entry=str(name)).error(problem, FORMS) from None
        labels = getattr(distribution, "labels", None)
        if labels is None or named is distributions:
            entries.append(Entry(str(name), nm, values))
        elif np.ndim(values) != 2 or np.shape(values)[1] != len(labels):
            count = pluralise(len(labels), "label")
            problem = (
                f"values must have shape (N, {len(labels)}) for {count}, got "
                f"{np.shape(values)}"
            )
            raise SourceLocation().error(problem, "give one column of values per label")
        else:
            entries += [
                Entry(str(label), nm, column)
                for label, column in zip(labels, np.transpose(values), strict=True)
            ]
    # The digest is that of the file that `write_atlas` writes.
    digest = hashlib.sha256(
        art.text(Atlas(tuple(entries)), Header()).encode()
    ).hexdigest()
    return Atlas(tuple(entries), sources=(Source("distributions", digest),))


@dataclass(frozen=True)
class ShippedAtlas:
    """An atlas that is installed with uplift, with the statements of its header.

    Parameters
    ----------
    name : str
        Name, valid in place of a path: the file name without its suffix.
    content : str
        Description of the measurements, which begins with their number.
    source : str
        Copyright of the measurements.
    licence : str
        Licence under which they are distributed.
    path : Path
        The installed file.
    digest : str
        SHA-256 of its bytes, in hexadecimal digits.
    """

    name: str
    content: str
    source: str
    licence: str
    path: Path
    digest: str

    @property
    def entries(self) -> int:
        """Number of entries, as ``content`` states it."""
        return int(self.content.split()[0])


@functools.cache
def shipped_atlases() -> tuple[ShippedAtlas, ...]:
    """Return the atlases that are installed with uplift, by name.

    >>> for atlas in shipped_atlases():
    ...     if atlas.name == "macbeth":
    ...         print(atlas.entries, atlas.content)
    24 24 patches of the Macbeth ColorChecker, measured by Ohta (1997)
    """
    atlases = []
    for name, path in _shipped_paths().items():
        document = read_document(path)
        header = art.read_header(document)
        atlases.append(
            ShippedAtlas(
                name=name,
                content=header.content,
                source=header.copyright,
                licence=header.licence,
                path=path,
                digest=document.digest,
            )
        )
    return tuple(atlases)


@functools.cache
def _shipped_paths() -> dict[str, Path]:
    """Shipped files by name, in alphabetical order."""
    try:
        folder = Path(str(files(PACKAGE)))
    except ModuleNotFoundError:
        return {}
    return {path.stem: path for path in sorted(folder.glob("*.txt"))}


def read_named(file: StrPath) -> Document:
    """Read a file that `find_atlas_file` found. Messages have the name of a shipped
    atlas, not its path.
    """
    document = read_document(file)
    if file not in _shipped_paths().values():
        return document
    return replace(document, path=document.stem, location=SourceLocation(document.stem))


def find_atlas_file(path: StrPath, folder: StrPath = "") -> StrPath:
    """Return the file that a path, relative to ``folder``, or the name of a shipped
    atlas stands for.

    An existing file takes precedence. Otherwise a path without another folder may name
    a shipped atlas, in any case, with or without the suffix. Warnings refer to the
    caller of the caller.
    """
    name = os.fspath(path)
    paths = _shipped_paths()
    file = os.path.join(folder, path)
    if os.path.lexists(file) and not os.path.isdir(file):
        return file
    # No file: the name of a shipped atlas, or else one that is spelt alike.
    stem = os.path.normpath(name).lower().removesuffix(".txt")
    if stem in paths:
        if stem != name:
            problem = f"the file does not exist; the shipped atlas '{stem}' is used"
            warn(UpliftWarning(problem, code="shipped-atlas", path=path))
        return paths[stem]
    near = difflib.get_close_matches(Path(name).stem.lower(), paths, n=1, cutoff=0.7)
    if near and not os.path.lexists(file):
        problem = "cannot be read: no such file or directory"
        hint = f"did you mean the shipped atlas '{near[0]}'?"
        raise SourceLocation(file).error(problem, hint, code="file-not-found")
    return file
