"""Panels of the chart and their Pareto fronts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.colorimetry.lights import CHART_LIGHTS
from uplift.lab.chart.table import Chart, MethodResult
from uplift.viz.format import format_build_time, format_error, format_time
from uplift.viz.scatter import pareto_front

MIN_TIMES = {"time_ns": 1.0, "build_s": 1e-3}
"""Left ends of the time axes; methods with nothing to build are drawn there."""
MIN_ERROR = 1e-4
"""Smaller errors are not visible and are drawn here, so that the faster of two such methods is on the front."""
CLEAR_RATIO = 0.99
"""Share of an error below which another one is clearly smaller; the rest is noise."""


@dataclass(frozen=True)
class Panel:
    """A panel of error over time.

    Parameters
    ----------
    title : str
        Title.
    error : str
        Name of the error in `MethodResult.numbers`, without ``_mean``; the mean is drawn.
    unit : str
        Its unit.
    time : str
        Name of the time.
    whiskers : bool
        Whether lines join the mean with the 99 % quantile and the largest error.
    """

    title: str
    error: str
    unit: str
    time: str = "time_ns"
    whiskers: bool = False

    def point(self, result: MethodResult) -> tuple[float, float] | None:
        """Return time and mean error, None if either is unknown."""
        time, error = result.numbers.get(self.time), result.numbers.get(f"{self.error}_mean")
        if time is None or error is None:
            return None
        return max(time, MIN_TIMES[self.time]), max(error, MIN_ERROR)

    def labels(self, result: MethodResult) -> tuple[str, str]:
        """Return time and mean error as text."""
        time = result.numbers[self.time]
        label = format_build_time(time) if self.time == "build_s" else format_time(time)
        return label, format_error(result.numbers[f"{self.error}_mean"])

    def whisker(self, result: MethodResult) -> tuple[float, float]:
        """Return the 99 % quantile and the largest error."""
        p99, largest = (result.numbers[f"{self.error}_{kind}"] for kind in ("p99", "max"))
        return max(p99, MIN_ERROR), max(largest, MIN_ERROR)

    def front(self, chart: Chart) -> tuple[MethodResult, ...]:
        """Return the Pareto front, fastest first: each is clearly more accurate than all faster methods."""
        points = [(result, point) for result in chart.measured if (point := self.point(result)) is not None]
        array = np.array([point for _, point in points]).reshape(-1, 2)
        return tuple(points[row][0] for row in pareto_front(array, CLEAR_RATIO))


PANELS = (
    Panel("Round trip under D65", "round_trip", "ΔE00", whiskers=True),
    *(Panel(f"Unseen materials under {light}", light, "ΔE00") for light in CHART_LIGHTS),
    Panel("Unseen materials, the spectrum", "rms", "rms of reflectance"),
    Panel("Materials of the atlas itself, mean of the five lights", "own_lights", "ΔE00"),
    Panel("Building: unseen materials, mean of the five lights", "lights", "ΔE00", time="build_s"),
)
AXES = {"time_ns": "CPU time per RGB", "build_s": "CPU time to build"}
