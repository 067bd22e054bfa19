"""Fuzz target: the cube reader, with mutated header lengths, headers and arrays, and mostly invalid digests."""

from __future__ import annotations

import json
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tests.fuzz.mutate import NUMBERS, Random, mutate
from tests.fuzz.target import ROOT, Target
from tests.fuzz.use_cube import use_cube

SEEDS = tuple((ROOT / "cubes" / f"{name}.uplift").read_bytes() for name in ("moments-8-macbeth", "sigmoid-8"))
TOKENS = (
    b'"F64"', b'"F32"', b'"BF16"', b'"U8"', b'"I32"', b'"BOOL"', b'"F8_E4M3"', b"[512,9]", b"[512]",
    b"[4294967296,4294967296]",
    b"[1000000000,1000000000,1000000000]", b"[]", b"{", b"}", b"[", b"]", b'"', b"\\", b"\\u0000",
    b"\\ud800", b",", b":", b"null",
    b'"nodes"', b'"rgb"', b'"shape"', b'"dtype"', b'"data_offsets"', b'"__metadata__"', b'\\"digest\\"',
    b"[" * 5000, b'{"a":' * 5000,
    b"NaN", b"Infinity", b"true", b"\0", b"\xff", *NUMBERS,
)  # fmt: skip
LENGTHS = (0, 1, 7, 8, 1 << 20, 1 << 31, 1 << 40, (1 << 63) - 1, (1 << 64) - 1)
EXTREME_VALUES = (
    -1,
    0,
    1,
    7,
    1 << 31,
    1 << 40,
    1 << 63,
    1 << 64,
    10**30,
    1.5,
    "",
    None,
    True,
    [],
    {},
    [1 << 40] * 3,
)


def _parts(content: bytes) -> tuple[bytes, bytes]:
    """Split into header and arrays."""
    length = int(struct.unpack("<Q", content[:8])[0])
    return content[8 : 8 + length], content[8 + length :]


def _with_header(header: bytes, arrays: bytes) -> bytes:
    return struct.pack("<Q", len(header)) + header + arrays


def _anywhere(content: bytes, random: Random) -> bytes:
    return mutate(content, random, TOKENS)


def _in_header(content: bytes, random: Random) -> bytes:
    header, arrays = _parts(content)
    return _with_header(mutate(header, random, TOKENS), arrays)


def _length(content: bytes, random: Random) -> bytes:
    near = len(_parts(content)[0]) + int(random.integers(-9, 10))
    length = near if random.random() < 0.5 else LENGTHS[random.integers(len(LENGTHS))]
    return struct.pack("<Q", length) + content[8:]


def _wrong_header(content: bytes, random: Random) -> bytes:
    """Change one value of an array in the header, which stays valid JSON."""
    text, arrays = _parts(content)
    header: dict[str, Any] = json.loads(text)
    array = header[list(header)[random.integers(len(header))]]
    key = list(array)[random.integers(len(array))]
    old, new = array[key], EXTREME_VALUES[random.integers(len(EXTREME_VALUES))]
    if isinstance(old, list) and old and random.random() < 0.7:
        old[random.integers(len(old))] = new
    else:
        array[key] = new
    return _with_header(json.dumps(header).encode(), arrays)


def _duplicate_key(content: bytes, random: Random) -> bytes:
    """Repeat a key of the header."""
    text, arrays = _parts(content)
    items = list(json.loads(text).items())
    name, value = items[random.integers(len(items))]
    other = items[random.integers(len(items))][1]
    more = f"{json.dumps(name)}:{json.dumps(value if random.random() < 0.5 else other)}".encode()
    return _with_header(text.rstrip()[:-1] + b"," + more + b"}", arrays)


MUTATIONS: tuple[Callable[[bytes, Random], bytes], ...] = (
    _anywhere,
    _in_header,
    _length,
    _wrong_header,
    _duplicate_key,
)


def _generate(random: Random, path: Path) -> None:
    content = SEEDS[random.integers(len(SEEDS))]
    path.write_bytes(MUTATIONS[random.integers(len(MUTATIONS))](content, random))


TARGET = Target("cube, corrupted bytes", _generate, use_cube)
