"""Panels of the chart and their Pareto fronts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from uplift.lab.chart.table import Chart, MethodResult
from uplift.viz.format import format_error, format_time
from uplift.viz.scatter import pareto_front

MIN_TIME = 1.0
"""Left end of the time axes in ns."""
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
        Title, without the number of colours.
    error : str
        Name of the error in `MethodResult.numbers`, without ``_mean``; the mean is drawn.
    unit : str
        Its unit.
    batch : int
        Number of colours per call.
    whole : bool
        Whether time is that of all colours of the batch and of the set-up, instead of that per RGB.
    whiskers : bool
        Whether lines join the mean with the 99 % quantile and the largest error.
    """

    title: str
    error: str
    unit: str
    batch: int
    whole: bool = False
    whiskers: bool = False

    @property
    def colours(self) -> str:
        """Return the number of colours per call as text."""
        return f"{self.batch:,} colour{'s' if self.batch > 1 else ''} per call"

    @property
    def axis(self) -> str:
        """Return the label of the time axis."""
        return "CPU time of a call, with set-up" if self.whole else "CPU time per RGB"

    def time(self, result: MethodResult) -> float | None:
        """Return the time in ns, None if it is unknown."""
        each = result.numbers.get(f"ns_{self.batch}")
        if each is None or not self.whole:
            return each
        return 1e9 * result.numbers["setup_s"] + self.batch * each

    def point(self, result: MethodResult) -> tuple[float, float] | None:
        """Return time and mean error, None if either is unknown."""
        time, error = self.time(result), result.numbers.get(f"{self.error}_mean")
        if time is None or error is None:
            return None
        return max(time, MIN_TIME), max(error, MIN_ERROR)

    def labels(self, result: MethodResult) -> tuple[str, str]:
        """Return time and mean error as text."""
        return format_time(self.time(result) or 0.0), format_error(result.numbers[f"{self.error}_mean"])

    def whisker(self, result: MethodResult) -> tuple[float, float]:
        """Return the 99 % quantile and the largest error."""
        p99, largest = (result.numbers[f"{self.error}_{kind}"] for kind in ("p99", "max"))
        return max(p99, MIN_ERROR), max(largest, MIN_ERROR)

    def front(self, chart: Chart) -> tuple[MethodResult, ...]:
        """Return the Pareto front, fastest first: each is clearly more accurate than all faster methods."""
        points = [(result, point) for result in chart.measured if (point := self.point(result)) is not None]
        array = np.array([point for _, point in points]).reshape(-1, 2)
        return tuple(points[row][0] for row in pareto_front(array, CLEAR_RATIO))


UNSEEN = "Unseen materials, mean of five lights"


def panels_of(batch: int) -> tuple[Panel, ...]:
    """Return the panels of a number of colours per call.

    Parameters
    ----------
    batch : int
        Number of colours.

    Returns
    -------
    tuple of Panel
        Round trip, unseen materials, their spectra, and those of the atlas over the time per RGB; unseen materials over
        the time of all colours with set-up.
    """
    return (
        Panel("Round trip, judged at 1 nm", "round_trip", "ΔE00", batch, whiskers=True),
        Panel(UNSEEN, "lights", "ΔE00", batch),
        Panel(f"{UNSEEN}, with set-up", "lights", "ΔE00", batch, whole=True),
        Panel("Unseen materials, the spectrum", "rms", "rms of reflectance", batch),
        Panel("Materials of the atlas itself, mean of five lights", "own_lights", "ΔE00", batch),
    )


def all_panels(chart: Chart) -> tuple[Panel, ...]:
    """Return the panels of all numbers of colours per call, those of one number together.

    Parameters
    ----------
    chart : Chart
        The chart.

    Returns
    -------
    tuple of Panel
        The panels, by ascending number.
    """
    return tuple(panel for batch in chart.batches for panel in panels_of(batch))
