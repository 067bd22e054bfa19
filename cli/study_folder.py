"""The folder that a study writes its tables and pictures to."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path


def check_folder(folder: Path, names: Iterable[str], *, force: bool) -> None:
    """Make the folder and ask for every file before the work. Raises `OutputError`."""
    from uplift.errors import OutputError
    from uplift.files import check_output

    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        raise OutputError(
            f"cannot be made: {error.strerror}", path=folder, remedy="name a folder to write to"
        ) from error
    for name in names:
        check_output(folder / name, force=force)
