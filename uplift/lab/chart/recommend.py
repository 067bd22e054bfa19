"""Which cube to build, from what was measured."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.resources import files

from uplift.colorimetry.lights import CHART_LIGHTS, DEFAULT_ILLUMINANT
from uplift.common.errors import OptionError, unknown_name
from uplift.lab.chart.panels import NOTABLE
from uplift.lab.chart.table import Chart, MethodResult, parse_chart
from uplift.viz.format import format_error, format_time

MEASURED = "measured.csv"


def shipped() -> Chart:
    """The chart of docs/chart.md, which the package carries."""
    return parse_chart(files("uplift.lab.chart").joinpath(MEASURED).read_text(encoding="utf-8"), MEASURED)


@dataclass(frozen=True)
class Requirement:
    """What answers may cost, in ns per RGB, and how far they may be off: mean ΔE00 under a light.

    Without a light, under all that were measured; ``own`` asks for materials of the atlas itself, not for unseen ones.
    Raises `OptionError` for limits that are no positive numbers, and for none; `UnknownNameError` for another light.
    """

    time_ns: float | None = None
    delta_e: float | None = None
    light: str | None = None
    own: bool = False

    def __post_init__(self) -> None:
        limits = [limit for limit in (self.time_ns, self.delta_e) if limit is not None]
        if not limits:
            raise OptionError("nothing is wished for", hint="give --time-ns, --delta-e or both")
        if not all(0 < limit < float("inf") for limit in limits):
            raise OptionError("a limit is no positive number", hint="give ns, and ΔE00, above 0")
        if self.light not in (None, DEFAULT_ILLUMINANT, *CHART_LIGHTS):
            raise unknown_name(str(self.light), (DEFAULT_ILLUMINANT, *CHART_LIGHTS), "light of the chart")

    @property
    def error(self) -> str:
        """The name of the number that is looked at."""
        if self.light == DEFAULT_ILLUMINANT:
            return "round_trip_mean"
        return f"{'own_' if self.own else ''}{self.light or 'lights'}_mean"

    @property
    def about(self) -> str:
        """What the error is of."""
        if self.light == DEFAULT_ILLUMINANT:
            return "of the round trip"
        where = f"under {self.light}" if self.light else f"under {', '.join(CHART_LIGHTS)}"
        return f"{where}, for {'materials of the atlas' if self.own else 'unseen materials'}"


def recommend(chart: Chart, wish: Requirement) -> MethodResult:
    """Of the cubes measured the quickest that is near enough; where only time is limited, as near as any in that time.

    Raises `OptionError` where nothing measured is, with what comes closest.
    """
    cubes = [row for row in chart.measured if row.build and {"time_ns", wish.error} <= row.numbers.keys()]
    if not cubes:
        raise OptionError("the chart has no cube with such numbers", hint="measure one with 'uplift chart'")

    def time(row: MethodResult) -> float:
        return row.numbers["time_ns"]

    def error(row: MethodResult) -> float:
        return row.numbers[wish.error]

    quick = [row for row in cubes if wish.time_ns is None or time(row) <= wish.time_ns]
    if not quick:
        least = min(cubes, key=time)
        raise OptionError(
            f"no cube answers in {format_time(wish.time_ns or 0)} per RGB",
            hint=f"the quickest, {least.method}, takes {format_time(time(least))}",
        )
    if wish.delta_e is None:
        least_error = min(map(error, quick))
        return min((row for row in quick if NOTABLE * error(row) <= least_error), key=time)
    near = [row for row in quick if error(row) <= wish.delta_e]
    if not near:
        least = min(quick, key=error)
        raise OptionError(
            f"no cube comes within ΔE00 {wish.delta_e:g} {wish.about}",
            hint=f"the nearest, {least.method}, has {format_error(error(least))}",
        )
    return min(near, key=time)
