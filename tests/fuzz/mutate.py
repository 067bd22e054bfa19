"""Random mutation of bytes, a few changes at a time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

Random = np.random.Generator
Change = Callable[[bytes, Random, Sequence[bytes]], bytes]

NUMBERS = (
    b"nan", b"inf", b"-inf", b"-1", b"0", b"-0.0", b"1e999", b"1e-999", b"1_000", b"9" * 400, b"0x10", b"1,5",
    b"1e308", b"4294967296", b"1000000000", b"18446744073709551616", b"\xd9\xa3", b"",
)  # fmt: skip
"""Texts in place of numbers that parsers may mishandle."""


def mutate(content: bytes, random: Random, tokens: Sequence[bytes]) -> bytes:
    """Apply one to eight random changes to ``content``; ``tokens`` are those of the format."""
    for _ in range(int(random.integers(1, 9))):
        content = CHANGES[random.integers(len(CHANGES))](content, random, tokens)
    return content


def choose(random: Random, items: Sequence[Any]) -> Any:
    """Return one of the items."""
    return items[random.integers(len(items))]


def _position(content: bytes, random: Random) -> int:
    return int(random.integers(len(content) + 1))


def _span(content: bytes, random: Random) -> tuple[int, int]:
    """Random span of log-uniform length."""
    first = _position(content, random)
    return first, min(first + int(2 ** random.uniform(0, 10)), len(content))


def _flip(content: bytes, random: Random, tokens: Sequence[bytes]) -> bytes:
    if not content:
        return content
    flipped = bytearray(content)
    flipped[random.integers(len(content))] ^= 1 << int(random.integers(8))
    return bytes(flipped)


def _delete(content: bytes, random: Random, tokens: Sequence[bytes]) -> bytes:
    first, last = _span(content, random)
    return content[:first] + content[last:]


def _repeat(content: bytes, random: Random, tokens: Sequence[bytes]) -> bytes:
    first, last = _span(content, random)
    return content[:last] + content[first:last] * int(random.integers(1, 4)) + content[last:]


def _insert(content: bytes, random: Random, tokens: Sequence[bytes]) -> bytes:
    position = _position(content, random)
    return content[:position] + tokens[random.integers(len(tokens))] + content[position:]


def _noise(content: bytes, random: Random, tokens: Sequence[bytes]) -> bytes:
    position = _position(content, random)
    return content[:position] + random.bytes(int(random.integers(1, 9))) + content[position:]


def _cut(content: bytes, random: Random, tokens: Sequence[bytes]) -> bytes:
    return content[: _position(content, random)] if random.random() < 0.2 else content


def _replace_token(content: bytes, random: Random, tokens: Sequence[bytes]) -> bytes:
    """Replace a token by another."""
    old, new = (tokens[random.integers(len(tokens))] for _ in range(2))
    return content.replace(old, new, int(random.integers(1, 4))) if old else content


def _replace_number(content: bytes, random: Random, tokens: Sequence[bytes]) -> bytes:
    """Replace the number around a position."""
    first = last = _position(content, random)
    while first and content[first - 1 : first] in DIGITS:
        first -= 1
    while content[last : last + 1] in DIGITS and last < len(content):
        last += 1
    return content[:first] + NUMBERS[random.integers(len(NUMBERS))] + content[last:]


def _swap_lines(content: bytes, random: Random, tokens: Sequence[bytes]) -> bytes:
    lines = content.split(b"\n")
    one, other = random.integers(len(lines), size=2)
    lines[one], lines[other] = lines[other], lines[one]
    return b"\n".join(lines)


DIGITS = {bytes([code]) for code in b"0123456789.+-eE"}
CHANGES: tuple[Change, ...] = (
    _flip, _delete, _repeat, _insert, _noise, _cut, _replace_token, _replace_number, _swap_lines,
)  # fmt: skip
