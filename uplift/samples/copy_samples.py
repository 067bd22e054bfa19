"""Copies of the sample files, which are installed in the folder ``files``."""

import shutil
from pathlib import Path

from uplift.common.arrays import StrPath
from uplift.common.files import atomic_write
from uplift.extras.files.outputs import check_folder, make_folder

FOLDER = Path(__file__).parent / "files"


def sample_names() -> tuple[str, ...]:
    """Return the names of the sample files, in alphabetical order."""
    return tuple(sorted(path.name for path in FOLDER.iterdir()))


def sample_path(name: str) -> Path:
    """Return the installed sample of a name, one of `sample_names`.

    >>> sample_path("still-life.png").is_file()
    True
    """
    return FOLDER / name


def copy_samples(folder: StrPath, *, force: bool = False) -> tuple[Path, ...]:
    """Copy the sample files into a folder, which is created. Equal files that are there
    already stay as they are.

    Raises `OutputError` if the folder cannot be written, or without ``force`` has
    another file of the same name; nothing is copied then.
    """
    copies = {Path(folder) / name: sample_path(name) for name in sample_names()}
    missing = {
        copy: sample for copy, sample in copies.items() if not _is_equal(copy, sample)
    }
    check_folder(folder, [copy.name for copy in missing], force=force)
    make_folder(folder)
    for copy, sample in missing.items():
        with atomic_write(copy, force=force) as temporary:
            shutil.copyfile(sample, temporary)
    return tuple(copies)


def _is_equal(copy: Path, sample: Path) -> bool:
    return copy.is_file() and copy.read_bytes() == sample.read_bytes()
