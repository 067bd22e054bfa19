"""Fuzz target: the reader of tables, with mutated CSV in all layouts."""

from __future__ import annotations

from pathlib import Path

from tests.fuzz.mutate import NUMBERS, Random, mutate
from tests.fuzz.target import Target
from tests.fuzz.use_atlas import use_atlas

ROWS = b"name,400,500,600,700\ngrey,0.5,0.25,0.125,0.0625\n\"a, 'b'\",1,0,1,0\n"
COLUMNS = b"nm;grey;other\n380;0,5;0,1\n500;0,25;0,2\n700;0,125;0,3\n720;0,1;0,4\n"
PERCENT = b"\tred\tblue\n400 nm\t50\t1\n550 nm\t25\t2\n700 nm\t12.5\t99\n"
SEEDS = (ROWS, COLUMNS, PERCENT, ROWS.replace(b"\n", b"\r\n"), b"\xef\xbb\xbf" + ROWS)
TOKENS = (
    b",", b";", b"\t", b"\n", b"\r\n", b"\r", b'"', b'""', b"'", b"nm", b" nm", b"name", b"grey", b"400", b"700", b"\0",
    b"\xff", b"\xe2\x80\xa8", b"," * 999, b"\n" * 999, b'"' * 999, b"a" * 200_000, b"grey,0.5,0.5,0.5,0.5\n", *NUMBERS,
)  # fmt: skip


def _generate(random: Random, path: Path) -> None:
    path.write_bytes(mutate(SEEDS[random.integers(len(SEEDS))], random, TOKENS))


TARGET = Target("atlas table", _generate, use_atlas)
