"""Sequences of pictures, and which pictures of several are of one frame or tile."""

import os
import re
from collections.abc import Sequence
from itertools import chain
from os.path import commonprefix
from string import digits

from uplift.common.errors import TextureError
from uplift.common.text import listed

from .inputs import UDIM, expand_patterns

WILDCARDS = re.compile(rf"[0-9]*(?:{UDIM}|\*|\?|\[!?.[^]]*\])+[0-9]*")
NUMBER = re.compile("([0-9]+)")
Frame = tuple[str | int, ...]
"""Texts and numbers in which the pictures of a sequence differ."""


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
    tables = list(map(dict, map(zip, frames, columns)))
    ordered = [map(table.__getitem__, frames[0]) for table in tables]
    return list(zip(*ordered, strict=True))


def matched(pattern: str, path: str) -> tuple[str, ...]:
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
        parts = matched(sources[0], paths[0]) or NUMBER.findall(name)[-1:]
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
