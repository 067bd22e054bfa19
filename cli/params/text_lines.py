"""Lines of a file or of a stream that may never end, as they come."""

from __future__ import annotations

import codecs
import io
from collections.abc import Iterator
from typing import IO

from uplift.common.errors import ColourError

CHUNK = 1 << 16
"""Bytes read at once. A pipe gives those that have arrived."""
MAX_LINE = 1 << 16
"""Characters of a line."""
HINT = "give a CSV file of colours"


def line_blocks(file: IO[bytes], name: str) -> Iterator[list[tuple[int, str]]]:
    """Yield blocks of lines with their numbers, each as soon as it can be read.

    Raises `ColourError` for text that is not UTF-8 and for lines that are too long.
    """
    decoder = io.IncrementalNewlineDecoder(codecs.getincrementaldecoder("utf-8-sig")(), translate=True)
    read = getattr(file, "read1", file.read)
    first, rest = 1, ""
    while chunk := read(CHUNK):
        *lines, rest = (rest + _decode(decoder, chunk, name)).split("\n")
        for line, text in enumerate([*lines, rest], first):
            if len(text) > MAX_LINE:
                problem = f"lines must not exceed {MAX_LINE:,} characters"
                raise ColourError(problem, code="line-too-long", path=name, line=line, hint=HINT)
        if lines:
            yield list(enumerate(lines, first))
            first += len(lines)
    if rest := rest + _decode(decoder, b"", name, final=True):
        yield list(enumerate(rest.split("\n"), first))


def _decode(decoder: io.IncrementalNewlineDecoder, chunk: bytes, name: str, *, final: bool = False) -> str:
    try:
        return decoder.decode(chunk, final=final)
    except UnicodeDecodeError as error:
        raise ColourError("is not a text file", code="not-text", path=name, hint=HINT) from error
