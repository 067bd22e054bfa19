"""Tables of what building takes."""

from __future__ import annotations

from collections.abc import Sequence

from benchmarks.fitting import ACCELERATED, FitTiming
from benchmarks.nodes import NodesError
from benchmarks.page import table
from benchmarks.processes import ProcessTiming
from uplift.lab.timing import Spread


def dims_table(rows: Sequence[FitTiming]) -> str:
    return table(
        "The fit against the size of the lattice",
        "One process, Macbeth, moments with 9 coefficients. CPU time of all threads, in µs per lattice point: *whole* "
        "is from the atlas to the last fitted point, of which *constant* is what no dim changes (entries, prior) and "
        "*lattice* growth and improvement; *storing* turns multipliers into coefficients and judges these; *errors* "
        "are the standard errors. *compile* is what the first run takes longer.",
        [
            "dim",
            "points",
            "compile s",
            "wall s",
            "whole",
            "constant",
            "lattice",
            "storing",
            "errors",
            "worst RGB",
        ],
        [
            [
                str(row.dim),
                f"{row.dim**3:,}",
                f"{row.compile_seconds:.1f}",
                f"{row.wall:.2f}",
                _per_point(row.whole, row.dim),
                f"{(row.entries.median + row.prior.median) * 1e6 / row.dim**3:.2f}",
                _per_point(row.lattice, row.dim),
                _per_point(row.storing, row.dim),
                _per_point(row.errors, row.dim),
                f"{row.worst:.1e}",
            ]
            for row in rows
        ],
    )


def models_table(rows: Sequence[FitTiming]) -> str:
    return table(
        "The fit against the model",
        f"As above, at dim {rows[0].dim}.",
        ["model", "coefficients", "compile s", "whole", "storing", "entries ms", "worst RGB"],
        [
            [
                row.model,
                str(row.count),
                f"{row.compile_seconds:.1f}",
                _per_point(row.whole, row.dim),
                _per_point(row.storing, row.dim),
                f"{row.entries.scaled(1e3):.0f}",
                f"{row.worst:.1e}",
            ]
            for row in rows
        ],
    )


def accelerator_table(rows: Sequence[FitTiming]) -> str:
    """What a GPU does; without one, that nothing was measured."""
    return table(
        "Accelerators",
        "The same fit where JAX finds a GPU: seconds that pass, compiled before. Tests build on three simulated "
        "devices and find the same cube to 1e-9.",
        ["dim", "points", "wall s", "million points/s", "worst RGB"],
        [
            [
                str(row.dim),
                f"{row.dim**3:,}",
                f"{row.wall:.2f}",
                f"{row.dim**3 / row.wall.median / 1e6:.2f}",
                f"{row.worst:.1e}",
            ]
            for row in rows
        ]
        or [[str(dim), f"{dim**3:,}", "not measured: no accelerator here", "", ""] for dim in ACCELERATED],
    )


def nodes_table(rows: Sequence[NodesError]) -> str:
    return table(
        "Fewer wavelengths",
        "What a rule of a few wavelengths misses of the RGB that all 81 give, |linear RGB|: nodes by pivoted QR and "
        "weights by least squares over half of a cube's spectra, judged on the other half. Saturated spectra are steep "
        "as boxes, and a fit to 1e-6 needs nearly all nodes; so the fit keeps them, and made each cheaper instead.",
        ["wavelengths", "any weights: median", "largest", "positive weights: median", "largest"],
        [[str(row.count), *(f"{value:.1e}" for value in (*row.any_sign, *row.positive))] for row in rows],
    )


def _per_point(seconds: Spread, dim: int) -> str:
    return f"{seconds.scaled(1e6 / dim**3):.2f}"


def processes_table(rows: Sequence[ProcessTiming]) -> str:
    return table(
        "Whole processes",
        "Imports, compilation, fit and writing; Macbeth, 9 coefficients.",
        ["command", "wall s", "peak memory MB"],
        [[f"`{row.what}`", f"{row.wall:.2f}", f"{row.megabytes:.0f}"] for row in rows],
    )
