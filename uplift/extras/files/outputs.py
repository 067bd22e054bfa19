"""Checks of all outputs of a program before it reads and writes anything."""

import os
import tempfile
import unicodedata
from collections.abc import Iterable
from pathlib import Path

from uplift.common.errors import OutputError, StrPath
from uplift.common.files import check_named, check_output

FOLDER_HINT = "name a folder to write to"


def check_outputs(
    paths: Iterable[StrPath | None],
    *,
    inputs: Iterable[StrPath | None] = (),
    force: bool = False,
) -> None:
    """Check all outputs of a program before it reads and writes anything, as
    `check_output`; None are left out.
    """
    outputs = [path for path in paths if path is not None]
    inputs = list(inputs)
    for path in outputs:
        check_output(path, inputs=inputs, force=force)
    _check_distinct(outputs)


def _check_distinct(paths: Iterable[StrPath]) -> None:
    """Raise `OutputError` if two paths are the same file, also by the rules of the file
    system for upper and lower case.
    """
    checked: dict[str, StrPath] = {}
    spellings: dict[str, str] = {}
    for path in paths:
        place = os.path.normcase(os.path.realpath(path))
        spelling = unicodedata.normalize("NFC", place).casefold()
        similar = spellings.setdefault(spelling, place)
        if place not in checked and is_same_name(Path(place), Path(similar)):
            place = similar
        if place in checked:
            problem = f"is the same file as {os.fspath(checked[place])}"
            raise OutputError(problem, path=path, hint="give each output its own name")
        checked[place] = path


def is_same_name(path: Path, other: Path) -> bool:
    """Return whether the file system takes two paths for one that differ at most in
    case or in the form of accents. A temporary file tries it.
    """
    pairs = zip(path.parts, other.parts, strict=True)
    different = [place for place, (name, like) in enumerate(pairs) if name != like]
    if not different:
        return True
    depth = different[0]
    folder = Path(*path.parts[:depth])
    while not folder.is_dir():
        folder = folder.parent
    try:
        with tempfile.TemporaryDirectory(prefix=".uplift-", dir=folder) as trial:
            Path(trial, path.parts[depth]).touch()
            return Path(trial, other.parts[depth]).exists()
    except OSError:
        return False


def check_folder(
    path: StrPath,
    names: Iterable[str],
    *,
    inputs: Iterable[StrPath | None] = (),
    force: bool = False,
) -> Path:
    """Check that files with these names can be written to a folder, which `make_folder`
    creates if necessary.
    """
    check_named(path)
    folder = Path(path)
    outputs = [folder / name for name in names]
    if os.path.isdir(folder):
        check_outputs(outputs, inputs=inputs, force=force)
        return folder
    missing = Path(os.path.abspath(folder))
    while not os.path.lexists(missing.parent):
        missing = missing.parent
    if os.path.lexists(missing):
        raise _not_a_folder(folder)
    check_output(missing)
    _check_distinct(outputs)
    return folder


def make_folder(path: StrPath) -> Path:
    """Create a folder, and those above it, if they do not exist."""
    check_named(path)
    folder = Path(path)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except FileExistsError as error:
        raise _not_a_folder(folder) from error
    except OSError as error:
        raise OutputError(
            f"cannot be created: {error.strerror}", path=folder, hint=FOLDER_HINT
        ) from error
    return folder


def _not_a_folder(path: Path) -> OutputError:
    return OutputError("is not a folder", path=path, hint=FOLDER_HINT)
