"""Summary of a finished build."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from .console import say

if TYPE_CHECKING:
    from uplift.cube import CubeData
    from uplift.lookup import Cube


def print_improvements(cube: Cube) -> None:
    """Print a line for each improvement step to standard error."""
    for step in cube.data.provenance["improvements"]:
        say(f"improvement, {step['step']}: tried {step['tried']}, fixed {step['mended']}", err=True)


def print_summary(cube: Cube, path: Path, seconds: float) -> None:
    """Print nodes, entries, accuracy, size and time on one line."""
    from uplift.lattice import Status

    data, counts = cube.data, cube.data.points.counts()
    unfitted, unrealisable = counts["unfitted"], counts["unrealisable"]
    accuracy = f"{unfitted} EXCEED the threshold {data.threshold:g}" if unfitted else f"all within {data.threshold:g}"
    if unrealisable:
        accuracy += f" except {unrealisable} unrealisable ones, stored with less chroma"
    worst = data.points.distance[data.points.status != Status.UNREALISABLE].max(initial=0)
    measured, looks = data.atlas.measured_count, data.atlas.looks
    entries = f"{measured} atlas entries, " if data.provenance["atlases"] else ""
    entries += f"{looks} look{'s' * (looks != 1)}, " if looks else ""
    say(
        f"{path}: {_node_count(data)}, {entries}{accuracy} (worst {worst:.1e}), "
        f"{counts['improved']} improved, {path.stat().st_size / 1e6:.1f} MB, {seconds:.1f} s"
    )


def _node_count(data: CubeData) -> str:
    size = data.lattice.size
    if data.complete_cells is None:
        return f"{size} nodes"
    count = int(data.points.present.sum())
    return f"{count} of {size} nodes ({count / size:.1%})"
