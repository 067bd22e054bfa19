"""Other tools at our task: CPU time per fitted point, and how good what they find is."""

from __future__ import annotations

from collections.abc import Sequence

from benchmarks.page import table
from benchmarks.peers.alone import alone
from benchmarks.peers.ceres import ceres
from benchmarks.peers.colour_science import colour_science
from benchmarks.peers.mitsuba_table import mitsuba_table
from benchmarks.peers.optimistix_dogleg import optimistix_dogleg
from benchmarks.peers.ours import ours
from benchmarks.peers.row import Peer
from benchmarks.peers.scipy_least_squares import scipy_least_squares

__all__ = ["Peer", "section", "time_peers"]

TOOLS = (ours, ceres, mitsuba_table, colour_science, scipy_least_squares, optimistix_dogleg)
MOST_RUNS = 3
"""Some take half a minute for a few points."""


def time_peers(runs: int) -> list[Peer]:
    """Every tool in turn; one that is not installed has rows that say so."""
    return [row for tool in TOOLS for row in alone(tool, min(runs, MOST_RUNS))]


def section(rows: Sequence[Peer]) -> str:
    """The table of `time_peers`."""
    runs = max(row.cpu.runs for row in rows if row.cpu)
    return table(
        "Peers: fitting a lattice without an atlas",
        f"CPU time of all threads per point, {runs} runs; *within* is the share of points whose spectrum has its "
        "linear sRGB to 1e-4. Moments are solved for *in p*, by their multipliers, as ours are, or *in c*, themselves. "
        "Slow tools are given fewer points; all are judged by our task, which some were not made for. numpy's linear "
        "algebra keeps to one thread here: more only made some tools slower. `make peers` installs Mitsuba and "
        "optimistix; Ceres is the system's.",
        ["tool", "model", "coefficients", "points", "CPU µs/point", "within", "worst RGB", "notes"],
        [_cells(row) for row in rows],
    )


def _cells(row: Peer) -> list[str]:
    cpu = "" if row.cpu is None else f"{row.cpu:,.1f}" if row.cpu.median < 1000 else f"{row.cpu:,.0f}"
    share, worst = ("", "") if row.answer is None else (f"{row.answer.share:.2%}", f"{row.answer.worst:.1e}")
    points = f"{row.points:,}" if row.points else ""
    return [row.tool, row.model, str(row.count), points, cpu, share, worst, row.notes]
