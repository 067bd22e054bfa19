"""Random mutation of bytes, a few changes at a time, by the words of seeds and by what parsers may mishandle."""

from __future__ import annotations

import functools
import re
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

Random = np.random.Generator
Seeds = tuple[bytes, ...]
Change = Callable[[bytes, Random, Seeds], bytes]

NUMBERS = (
    b"nan", b"inf", b"-inf", b"-1", b"0", b"-0.0", b"1e999", b"1e-999", b"1_000", b"9" * 400, b"0x10", b"1,5",
    b"1e308", b"5e-324", b"4294967296", b"1000000000", b"18446744073709551616", b"\xd9\xa3", b"\xef\xbc\x91", b"",
)  # fmt: skip
HOSTILE = (
    *NUMBERS, b"\0", b"\0" * 999, b"\xff", b"\xff\xfe", b"\xff" * 4, b"\xff\xff\xff\x7f", b"\1\0\0\0", b"\xef\xbb\xbf",
    b"\xe2\x80\xa8", b"\r", b"\r\n", b"\n" * 999, b"\t", b",", b"," * 999, b'"' * 999, b"[" * 100_000, b"{" * 999,
    b'{"a":' * 20_000, b"a." * 2000, b"a" * 200_000, b"0" * 70_000, b"\\u0000", b"\\ud800", b"null", b"true", b"yes",
    b"<a>" * 99, b"<!DOCTYPE a>", b"<!ENTITY a 'b'>", b"&a;", b"sep=|\n", b"PK\x03\x04", b"PK\x05\x06", b"\x1b]52;c;\7",
)  # fmt: skip
"""Texts that parsers of any format may mishandle."""
WORD = re.compile(rb"[A-Za-z][\w-]{2,}|[^\w\0-\x08\x0e-\x1f\x7f-\xff]")
"""Words of three letters or more, signs and blanks."""
NUMBER = re.compile(rb"[0-9.+-]+(?:[eE][0-9+-]+)?")


def mutate(content: bytes, random: Random, seeds: Seeds) -> bytes:
    """Apply one to eight random changes to ``content``, with words from the ``seeds`` of the format."""
    for _ in range(int(random.integers(1, 9))):
        content = choose(random, CHANGES)(content, random, seeds)
    return content


def choose(random: Random, items: Sequence[Any]) -> Any:
    """Return one of the items."""
    return items[random.integers(len(items))]


@functools.cache
def words(seeds: Seeds) -> Seeds:
    """Return every word of the seeds once."""
    return tuple(dict.fromkeys(word for seed in seeds for word in WORD.findall(seed)))


def _token(random: Random, seeds: Seeds) -> bytes:
    found: bytes = choose(random, words(seeds) if random.random() < 0.6 else HOSTILE)
    return found


def _position(content: bytes, random: Random) -> int:
    return int(random.integers(len(content) + 1))


def _span(content: bytes, random: Random) -> tuple[int, int]:
    """Random span of log-uniform length."""
    first = _position(content, random)
    return first, min(first + int(2 ** random.uniform(0, 10)), len(content))


def _flip(content: bytes, random: Random, seeds: Seeds) -> bytes:
    flipped = bytearray(content or b"\0")
    flipped[random.integers(len(flipped))] ^= 1 << int(random.integers(8))
    return bytes(flipped)


def _delete(content: bytes, random: Random, seeds: Seeds) -> bytes:
    first, last = _span(content, random)
    return content[:first] + content[last:]


def _repeat(content: bytes, random: Random, seeds: Seeds) -> bytes:
    first, last = _span(content, random)
    return content[:last] + content[first:last] * int(random.integers(1, 4)) + content[last:]


def _insert(content: bytes, random: Random, seeds: Seeds) -> bytes:
    """Insert a token or noise."""
    position = _position(content, random)
    inserted = _token(random, seeds) if random.random() < 0.5 else random.bytes(int(random.integers(1, 9)))
    return content[:position] + inserted + content[position:]


def _cut(content: bytes, random: Random, seeds: Seeds) -> bytes:
    return content[: _position(content, random)] if random.random() < 0.2 else content


def _replace_word(content: bytes, random: Random, seeds: Seeds) -> bytes:
    return content.replace(choose(random, words(seeds)), _token(random, seeds), int(random.integers(1, 4)))


def _replace_number(content: bytes, random: Random, seeds: Seeds) -> bytes:
    if not (found := NUMBER.search(content, _position(content, random))):
        return content
    return content[: found.start()] + choose(random, NUMBERS) + content[found.end() :]


def _swap_lines(content: bytes, random: Random, seeds: Seeds) -> bytes:
    lines = content.split(b"\n")
    one, other = random.integers(len(lines), size=2)
    lines[one], lines[other] = lines[other], lines[one]
    return b"\n".join(lines)


CHANGES: tuple[Change, ...] = (
    _flip, _delete, _repeat, _insert, _insert, _cut, _replace_word, _replace_number, _swap_lines,
)  # fmt: skip
