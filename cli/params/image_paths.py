"""Images as they are typed: one, several, or a pattern; and the names of their textures."""

from __future__ import annotations

import glob
import os
from collections.abc import Sequence
from pathlib import Path


def frames(sources: Sequence[str], target: str) -> list[tuple[Path, Path]]:
    """Images and their textures; several images, and patterns, go into the folder ``target``, which is made.

    Raises `TextureError` for a pattern that nothing has the name of, `OutputError` for a folder that cannot be.
    """
    from uplift.common.errors import OutputError

    found = expanded(sources)
    folder = Path(target)
    alone = len(sources) == 1 and found == [sources[0]]
    if alone and not folder.is_dir() and not target.endswith(os.sep):
        if folder.suffix.lower() != ".exr":
            raise OutputError("textures are OpenEXR", path=target, hint="name the file .exr, or a folder")
        return [(Path(found[0]), folder)]
    if folder.suffix.lower() == ".exr" and not folder.is_dir():
        raise OutputError(f"is one file, for {len(found)} images", path=target, hint="name a folder")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        problem = f"is no folder, and {len(found)} images need one"
        raise OutputError(problem, path=target, hint="name a folder") from error
    return [(Path(path), folder / f"{Path(path).stem}.exr") for path in found]


def expanded(sources: Sequence[str]) -> list[str]:
    """Paths, in order, of images and patterns. Raises `TextureError` for a pattern that nothing has the name of."""
    return [path for source in sources for path in _expanded(source)]


def _expanded(source: str) -> list[str]:
    from uplift.common.errors import TextureError

    if os.path.exists(source) or not glob.has_magic(source):
        return [source]
    found = sorted(glob.glob(source))
    if not found:
        raise TextureError(f"no file is named like '{source}'", hint="check the pattern")
    return found
