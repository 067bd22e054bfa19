"""Other tools on the same task: CPU time per fitted node, and the accuracy of the fits."""

from __future__ import annotations

from benchmarks.peers.alone import alone
from benchmarks.peers.ceres import ceres
from benchmarks.peers.colour_science import colour_science
from benchmarks.peers.mitsuba_table import mitsuba_table
from benchmarks.peers.optimistix_dogleg import optimistix_dogleg
from benchmarks.peers.ours import ours
from benchmarks.peers.row import Peer
from benchmarks.peers.scipy_least_squares import scipy_least_squares

__all__ = ["Peer", "time_peers"]

TOOLS = (ours, ceres, mitsuba_table, colour_science, scipy_least_squares, optimistix_dogleg)
MOST_RUNS = 3
"""Some tools take half a minute for a few nodes."""


def time_peers(runs: int) -> list[Peer]:
    """Time each tool; the rows of a tool that is not installed have no figures."""
    return [row for tool in TOOLS for row in alone(tool, min(runs, MOST_RUNS))]
