"""Fuzz target: the reader of ART measurement archives, with mutated archives."""

from __future__ import annotations

from pathlib import Path

from tests.fuzz.mutate import NUMBERS, Random, mutate
from tests.fuzz.target import ROOT, Target
from tests.fuzz.use_atlas import use_atlas

ENTRY = b"""Entry ID:   %s
---------------------------------------------------------------------------
Description           :  "a card"
Type                  :  reflectance spectrum
Fluorescence data     :  no
Sampling information
--------------------
Type                  :  %s
Maximum sample value  :  1.0
ASCII sample data
-----------------
{%s}
"""
REGULAR = ENTRY % (b"grey", b"regular\nStart : 400.0 nm\nIncrement : 100.0 nm", b"0.5, 0.25, 0.125, 0.0625")
POINTS = ENTRY % (b"other", b"point sampled", b"{380, 0.5}, {500.5, 0.1}, {720, 1}")
HEADER = b"ART measurement archive version 1.1\nArchive content: cards\n"
SHIPPED = (ROOT / "atlases" / "macbeth.txt").read_bytes()
SEEDS = (HEADER + REGULAR + POINTS, REGULAR, POINTS + REGULAR, SHIPPED[: SHIPPED.index(b"Entry ID", 2000)])
TOKENS = (
    b"Entry ID:", b"Type", b"reflectance spectrum", b"emission spectrum", b"regular", b"point sampled",
    b"yes", b"no",
    b"Fluorescence data", b"Maximum sample value", b"Start", b"Increment", b"Sampling information",
    b"<hr/>", b"1.2",
    b"ASCII sample data", b"{", b"}", b"{{", b"}}", b", ", b":", b"\n", b"\r", b"\t", b"\0",
    b"\xef\xbb\xbf", b"\xe2\x80\xa8",
    b"\xff", b" nm", b"{" * 999, b"\n" * 999, b"Entry ID: grey\n", b'"', *NUMBERS,
)  # fmt: skip


def _generate(random: Random, path: Path) -> None:
    path.write_bytes(mutate(SEEDS[random.integers(len(SEEDS))], random, TOKENS))


TARGET = Target("atlas text", _generate, use_atlas)
