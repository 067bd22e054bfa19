"""Images by path or pattern, and the names of their textures."""

from __future__ import annotations

import glob
import os
import re
from collections.abc import Sequence
from pathlib import Path

UDIM = "<UDIM>"
"""Placeholder for the number of a tile, 1001 to 9999."""
UDIM_DIGITS = "[1-9][0-9][0-9][0-9]"


def texture_paths(sources: Sequence[str], target: str) -> list[tuple[Path, Path]]:
    """Return pairs of an image and its texture. Several images, and patterns, go into the folder ``target``.

    The folder is created. Raises `TextureError` for a pattern that matches no file, `OutputError` for a folder that
    cannot be created.
    """
    from uplift.common.errors import OutputError

    images = expand_patterns(sources)
    if UDIM in target:
        return _tiles(sources, images, target)
    folder = Path(target)
    is_single = len(sources) == 1 and images == [sources[0]]
    if is_single and not folder.is_dir() and not target.endswith(os.sep):
        if folder.suffix.lower() != ".exr":
            raise OutputError(
                "textures are OpenEXR files",
                code="unknown-suffix",
                path=target,
                hint="give a file name ending in .exr, or a folder",
            )
        return [(Path(images[0]), folder)]
    if folder.suffix.lower() == ".exr" and not folder.is_dir():
        raise _needs_folder(f"is a file name, but there are {len(images)} images", target)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise _needs_folder(f"is not a folder, but there are {len(images)} images", target) from error
    return [(Path(path), folder / f"{Path(path).stem}.exr") for path in images]


def _tiles(sources: Sequence[str], images: list[str], target: str) -> list[tuple[Path, Path]]:
    """Return pairs of the tiles of one UDIM pattern and their textures, whose names have the same numbers."""
    from uplift.common.errors import OutputError

    is_plain = len(sources) == 1 and not glob.has_magic(sources[0])
    if not is_plain or sources[0].count(UDIM) != 1 or target.count(UDIM) != 1:
        raise OutputError(
            f"{UDIM} in the output needs one input with {UDIM}",
            code="udim-mismatch",
            path=target,
            hint=f"write for example 'wood.{UDIM}.exr' 'uplifted.{UDIM}.exr'",
        )
    before, _, after = (re.escape(part) for part in sources[0].partition(UDIM))
    numbers = (re.fullmatch(f"{before}(\\d{{4}}){after}", image) for image in images)
    pairs = zip(images, numbers, strict=True)
    return [(Path(image), Path(target.replace(UDIM, match[1]))) for image, match in pairs if match]


def expand_patterns(sources: Sequence[str]) -> list[str]:
    """Return the paths of images and patterns, in order. Raises `TextureError` for a pattern that matches no file."""
    return [path for source in sources for path in _expand(source)]


def _expand(source: str) -> list[str]:
    from uplift.common.errors import TextureError

    if os.path.exists(source) or not (glob.has_magic(source) or UDIM in source):
        return [source]
    paths = sorted(glob.glob(source.replace(UDIM, UDIM_DIGITS)))
    if not paths:
        raise TextureError(f"no file matches the pattern '{source}'", code="no-match", hint="check the pattern")
    return paths


def _needs_folder(problem: str, target: str) -> Exception:
    from uplift.common.errors import OutputError

    return OutputError(problem, code="not-a-folder", path=target, hint="give a folder for the textures")
