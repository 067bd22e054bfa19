"""The panels of the chart, and in each the methods that no other beats in both respects."""

from __future__ import annotations

from dataclasses import dataclass

from uplift.colorimetry.lights import CHART_LIGHTS
from uplift.lab.chart.table import Chart, MethodResult
from uplift.viz.format import format_build_time, format_error, format_time

FLOORS = {"time_ns": 1.0, "build_s": 1e-3}
"""Where the axes of time begin: what has nothing to build stands there."""
LEAST = 1e-4
"""Errors below are drawn there: nobody sees less, and who is quicker is ahead."""
NOTABLE = 0.99
"""The share of another's error that is worth more time: what differs by less is noise."""


@dataclass(frozen=True)
class Panel:
    """``across`` a time, the mean of an ``error`` upwards; ``whiskers`` from there to its 99 % and its largest."""

    title: str
    error: str
    unit: str
    across: str = "time_ns"
    whiskers: bool = False

    def point(self, row: MethodResult) -> tuple[float, float] | None:
        """Where a method stands; None where that is not known."""
        time, error = row.numbers.get(self.across), row.numbers.get(f"{self.error}_mean")
        if time is None or error is None:
            return None
        return max(time, FLOORS[self.across]), max(error, LEAST)

    def told(self, row: MethodResult) -> tuple[str, str]:
        """Time and mean error, to be read."""
        time = row.numbers[self.across]
        told = format_build_time(time) if self.across == "build_s" else format_time(time)
        return told, format_error(row.numbers[f"{self.error}_mean"])

    def reach(self, row: MethodResult) -> tuple[float, float]:
        """The 99 % and the largest error."""
        return max(row.numbers[f"{self.error}_p99"], LEAST), max(row.numbers[f"{self.error}_max"], LEAST)

    def front(self, chart: Chart) -> tuple[MethodResult, ...]:
        """The Pareto front, fastest first: who is slower than another on it is notably nearer."""
        points = {row: self.point(row) for row in chart.measured}
        known = {row: point for row, point in points.items() if point is not None}
        found: list[MethodResult] = []
        for row in sorted(known, key=lambda row: known[row]):
            if not found or known[row][1] < NOTABLE * known[found[-1]][1]:
                found.append(row)
        return tuple(found)


PANELS = (
    Panel("Round trip under D65", "round_trip", "ΔE00", whiskers=True),
    *(Panel(f"Unseen materials under {light}", light, "ΔE00") for light in CHART_LIGHTS),
    Panel("Unseen materials, the spectrum", "rms", "rms of reflectance"),
    Panel("Materials of the atlas itself, mean of the five lights", "own_lights", "ΔE00"),
    Panel("Building: unseen materials, mean of the five lights", "lights", "ΔE00", across="build_s"),
)
AXES = {"time_ns": "CPU time per RGB", "build_s": "CPU time to build"}
