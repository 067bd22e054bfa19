"""Tables of `benchmarks.lookups`, for docs/performance.md."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from benchmarks.page import table

if TYPE_CHECKING:
    from benchmarks.lookups import LookupTiming


def lookup_table(rows: Sequence[LookupTiming]) -> str:
    return table(
        "Lookups in numpy",
        "Random colours of a 32³ Macbeth cube, 9 coefficients; reflectances at 16 wavelengths. Bytes are those of the "
        "question, of the eight rows read and of the answer. Errors: of the round trip, linear RGB; for coefficients, "
        "from float64.",
        [
            "what",
            "type",
            "threads",
            "colours",
            "bytes each",
            "seconds",
            "million colours/s",
            "CPU µs each",
            "error",
        ],
        [
            [
                *_numbers(row),
                f"{row.worst if row.apart is None else row.apart:.1e}",
            ]
            for row in rows
        ],
    )


def bulk_table(rows: Sequence[LookupTiming]) -> str:
    return table(
        "Lookups in bulk",
        "`uplift.lookup.bulk` on the same cube, float32 out. *ready* is what making the tables takes, *compile* what a first "
        "run takes longer than the next; the error is the largest difference from numpy in float64.",
        [
            "what",
            "question",
            "threads",
            "colours",
            "bytes each",
            "seconds",
            "million colours/s",
            "CPU µs each",
            "ready s",
            "compile s",
            "error",
        ],
        [[*_numbers(row), f"{row.prepare:.2f}", f"{row.compile:.2f}", f"{row.apart:.1e}"] for row in rows],
    )


def _numbers(row: LookupTiming) -> list[str]:
    return [
        row.what,
        row.dtype,
        str(row.threads),
        f"{row.colours:,}",
        str(row.bytes),
        f"{row.wall:.3f}",
        f"{row.colours / row.wall.median / 1e6:.2f}",
        f"{row.cpu.median / row.colours * 1e6:.2f}",
    ]
