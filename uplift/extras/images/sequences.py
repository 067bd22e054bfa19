"""Sequences of images: patterns of names with tiles (UDIM) and frames, which images of
several are of one frame, and the names of their textures.
"""

import glob
import os
import re
from collections.abc import Sequence
from itertools import chain
from os.path import commonprefix
from pathlib import Path
from string import digits

from uplift.common.errors import OutputError, TextureError
from uplift.common.files import check_regular
from uplift.common.text import listed

UDIM = "<UDIM>"
"""Placeholder for the number of a tile, 1001 to 9999."""
UDIM_DIGITS = "[1-9][0-9][0-9][0-9]"
WILDCARDS = re.compile(rf"[0-9]*(?:{UDIM}|\*|\?|\[!?.[^]]*\])+[0-9]*")
NUMBER = re.compile("([0-9]+)")
Frame = tuple[str | int, ...]
"""Texts and numbers in which the pictures of a sequence differ."""


def expand_patterns(sources: Sequence[str]) -> list[str]:
    """Return the paths of images and patterns, in order. A pattern may hold the number
    of a UDIM tile.

    Raises `TextureError` for a path that is not a file, and for a pattern that matches
    none.
    """
    paths = list(chain.from_iterable(_expand(source) for source in sources))
    for path in paths:
        check_regular(path, TextureError, hint="name images, or a pattern")
    return paths


def _expand(source: str) -> list[str]:
    if os.path.exists(source) or not (glob.has_magic(source) or UDIM in source):
        return [source]
    paths = sorted(glob.glob(source.replace(UDIM, UDIM_DIGITS)))
    if not paths:
        raise TextureError(
            f"no file matches the pattern '{source}'", hint="check the pattern"
        )
    return paths


def pair_frames(sequences: Sequence[Sequence[str]]) -> list[tuple[str, ...]]:
    """Return the pictures of each frame or tile, one of each sequence.

    A sequence is a pattern, or a list of files. A frame is what differs between its
    names, numbers however they are padded. Files that are named one by one belong
    together. Raises `TextureError` (``frames-differ``) unless all sequences have the
    same frames.
    """
    columns = [expand_patterns(sources) for sources in sequences]
    frames = list(map(_frames, sequences, columns))
    is_single = max(map(len, columns)) == 1
    is_named = columns == list(map(list, sequences))
    is_one = len({*chain(*frames)} - {()}) <= 1
    if len(columns) == 1 or (is_single and (is_named or is_one)):
        return list(zip(*columns, strict=True))
    _check_same([", ".join(sources) for sources in sequences], frames)
    by_frame = [
        dict(zip(*pair, strict=True)) for pair in zip(frames, columns, strict=True)
    ]
    sorted_columns = [map(table.__getitem__, frames[0]) for table in by_frame]
    return list(zip(*sorted_columns, strict=True))


def _matched(pattern: str, path: str) -> tuple[str, ...]:
    """Return the parts of a path that stand for the wildcards of a pattern, with the
    digits next to them.
    """
    # the separators of a pattern and of the paths that it matches may differ
    literals = map(re.escape, WILDCARDS.split(os.path.normpath(pattern)))
    expression = re.compile("(.*)".join(literals), re.DOTALL | re.IGNORECASE)
    match = expression.fullmatch(os.path.normpath(path))
    assert match is not None
    return match.groups()


def _frames(sources: Sequence[str], paths: Sequence[str]) -> list[Frame]:
    """Return the frames of a sequence; of a single picture its numbers, if any."""
    if len(paths) == 1:
        name = os.path.basename(paths[0])
        parts = _matched(sources[0], paths[0]) or NUMBER.findall(name)[-1:]
        return [tuple(map(int, NUMBER.findall(" ".join(parts))))]
    start = len(commonprefix(paths).rstrip(digits))  # noqa: RUF071
    ends = [path[start:][::-1] for path in paths]
    end = len(commonprefix(ends).rstrip(digits))  # noqa: RUF071
    return [_words(path[start : len(path) - end]) for path in paths]


def _words(text: str) -> Frame:
    words = NUMBER.split(text)
    return tuple(int(word) if word.isdecimal() else word for word in words)


def _check_same(names: Sequence[str], frames: Sequence[Sequence[Frame]]) -> None:
    """Check that sequences have the same frames, and each once."""
    every = {*chain(*frames)}
    problems = []
    for name, column in zip(names, frames, strict=True):
        labels = [" ".join(map(str, frame)).strip() for frame in every - {*column}]
        if labels:
            problems.append(f"{name} lacks {listed(sorted(labels))}")
        elif len(column) > len(every):
            problems.append(f"{name} has one twice")
    if problems:
        raise TextureError(
            f"sequences must have the same frames, got: {'; '.join(problems)}",
            code="frames-differ",
            hint="add the missing pictures, or leave out those without a partner",
        )


def texture_paths(
    sources: Sequence[str], images: Sequence[str], target: str
) -> list[Path]:
    """Return the textures of ``images``, which ``sources`` name, one by one or by
    patterns: a file ``target`` for a single one, tiles for tiles, and else files in the
    folder ``target``.

    Raises `OutputError` for a file in place of the folder.
    """
    if UDIM in target:
        return _tiles(sources, images, target)
    folder = Path(target)
    is_single = [*sources] == images and len(images) == 1
    if is_single and folder.suffix and not is_folder(target):
        if folder.suffix.lower() != ".exr":
            hint = "give a file name ending in .exr, or a folder"
            raise OutputError("textures are OpenEXR files", path=target, hint=hint)
        return [folder]
    if folder.suffix.lower() == ".exr" and not folder.is_dir():
        problem = f"is not a folder, but there are {len(images):,} images"
        raise OutputError(problem, path=target, hint="give a folder for the textures")
    return [folder / f"{Path(path).stem}.exr" for path in images]


def _tiles(sources: Sequence[str], images: Sequence[str], target: str) -> list[Path]:
    """Return the textures of the tiles of one UDIM pattern, whose names have the same
    numbers.
    """
    is_plain = len(sources) == 1 and not glob.has_magic(sources[0])
    if not is_plain or sources[0].count(UDIM) != 1 or target.count(UDIM) != 1:
        hint = f"write for example 'wood.{UDIM}.exr' -o 'uplifted.{UDIM}.exr'"
        raise OutputError(
            f"{UDIM} in the output needs one input with {UDIM}", path=target, hint=hint
        )
    tiles = [_matched(sources[0], image) for image in images]
    return [Path(target.replace(UDIM, tile)) for (tile,) in tiles]


def is_folder(path: str) -> bool:
    """Return whether a path is that of a folder, or ends as one: on Windows with either
    of two separators.
    """
    separators = tuple(filter(None, (os.sep, os.altsep)))
    return path.endswith(separators) or os.path.isdir(path)
