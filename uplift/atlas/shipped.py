"""Atlases that are installed with uplift, from the folder atlases/ of the repository."""

from __future__ import annotations

import difflib
import functools
import os
import warnings
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path

from uplift.atlas.document import SourceLocation, read_document
from uplift.atlas.formats.art import read_header
from uplift.common.arrays import StrPath
from uplift.common.errors import UpliftWarning

PACKAGE = "uplift_atlases"
"""Name under which the folder atlases/ is installed."""


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
        """Number of entries, as ``content`` states it.

        Returns
        -------
        int
        """
        return int(self.content.split()[0])


@functools.cache
def shipped_atlases() -> tuple[ShippedAtlas, ...]:
    """Return the atlases that are installed with uplift, by name.

    >>> for atlas in shipped_atlases():
    ...     if atlas.name == "macbeth":
    ...         print(atlas.entries, atlas.content)
    24 24 patches of the Macbeth ColorChecker, measured by Ohta (1997)
    """
    return tuple(_describe(name, path) for name, path in _paths().items())


def find_atlas_file(path: StrPath, folder: StrPath = "") -> StrPath:
    """Return the file that a path, relative to ``folder``, or the name of a shipped atlas stands for.

    An existing file takes precedence. Otherwise a path without a folder may name a shipped atlas, with or without the
    suffix. Warnings refer to the caller of the caller.
    """
    name = os.fspath(path)
    file = os.path.join(folder, path)
    if os.path.lexists(file) and not os.path.isdir(file):
        return file
    paths = _paths()
    if name in paths:
        return paths[name]
    stem = name.removesuffix(".txt")
    if stem in paths:
        problem = f"the file does not exist; the shipped atlas '{stem}' is used"
        warnings.warn(UpliftWarning(problem, code="shipped-atlas", path=path), stacklevel=3)
        return paths[stem]
    near = difflib.get_close_matches(Path(name).stem, paths, n=1, cutoff=0.7)
    if near and not os.path.lexists(file):
        raise SourceLocation(file).error(
            "cannot be read: no such file or directory",
            f"did you mean the shipped atlas '{near[0]}'?",
            code="file-not-found",
        )
    return file


@functools.cache
def _paths() -> dict[str, Path]:
    """Shipped files by name, in alphabetical order."""
    try:
        folder = Path(str(files(PACKAGE)))
    except ModuleNotFoundError:
        return {}
    return {path.stem: path for path in sorted(folder.glob("*.txt"))}


def _describe(name: str, path: Path) -> ShippedAtlas:
    document = read_document(path)
    header = read_header(document)
    return ShippedAtlas(name, header.content, header.copyright, header.licence, path, document.digest)
