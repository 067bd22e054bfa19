"""Recommendation of a cube from the measurements of a chart."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.resources import files

from uplift.colorimetry.lights import CHART_LIGHTS, DEFAULT_ILLUMINANT
from uplift.common.errors import OptionError, unknown_name
from uplift.lab.chart.panels import CLEAR_RATIO
from uplift.lab.chart.table import Chart, MethodResult, parse_chart
from uplift.viz.format import format_error, format_time

MEASURED = "measured.csv"


def shipped_chart() -> Chart:
    """Return the chart of docs/chart.md, which is part of the package.

    Returns
    -------
    Chart
        The chart.

    Examples
    --------
    >>> shipped_chart().facts["commit"] != ""
    True
    """
    return parse_chart(files("uplift.lab.chart").joinpath(MEASURED).read_text(encoding="utf-8"), MEASURED)


@dataclass(frozen=True)
class Requirement:
    """Limits for time and error; at least one is required.

    Parameters
    ----------
    time_ns : float, optional
        Largest CPU time per RGB, in ns.
    delta_e : float, optional
        Largest mean ΔE00.
    light : str, optional
        Light of the ΔE00, by default all lights of the chart; the illuminant D65 stands for round trips.
    own : bool, default False
        Whether the ΔE00 is of materials of the atlas itself, not of unseen ones.

    Raises
    ------
    OptionError
        Without a limit, or if one is not a positive number.
    UnknownNameError
        If the chart has no such light.
    """

    time_ns: float | None = None
    delta_e: float | None = None
    light: str | None = None
    own: bool = False

    def __post_init__(self) -> None:
        limits = {"time_ns": self.time_ns, "delta_e": self.delta_e}
        if all(limit is None for limit in limits.values()):
            raise OptionError("time_ns or delta_e is required", code="no-requirements", hint="give one or both")
        for name, limit in limits.items():
            if limit is not None and not 0 < limit < float("inf"):
                raise OptionError(f"{name} must be a positive number, got {limit:g}", code="limit-not-positive")
        if self.light not in (None, DEFAULT_ILLUMINANT, *CHART_LIGHTS):
            raise unknown_name(str(self.light), (DEFAULT_ILLUMINANT, *CHART_LIGHTS), "light")

    @property
    def error(self) -> str:
        """Return the name of the error in `MethodResult.numbers`."""
        if self.light == DEFAULT_ILLUMINANT:
            return "round_trip_mean"
        return f"{'own_' if self.own else ''}{self.light or 'lights'}_mean"

    @property
    def description(self) -> str:
        """Return the conditions of the error as text."""
        if self.light == DEFAULT_ILLUMINANT:
            return "of the round trip"
        lights = f"under {self.light}" if self.light else f"under {', '.join(CHART_LIGHTS)}"
        return f"{lights}, for {'materials of the atlas' if self.own else 'unseen materials'}"


def recommend_cube(chart: Chart, requirement: Requirement) -> MethodResult:
    """Choose a cube: the fastest that is accurate enough or, without a limit for the error, the most accurate in time.

    Parameters
    ----------
    chart : Chart
        Measurements.
    requirement : Requirement
        Limits for time and error.

    Returns
    -------
    MethodResult
        A cube of this package; ``build`` is the command that builds it.

    Raises
    ------
    OptionError
        If no measured cube meets the requirement; the hint names the closest one.
    """
    cubes = [
        result for result in chart.measured if result.build and {"time_ns", requirement.error} <= result.numbers.keys()
    ]
    if not cubes:
        raise OptionError(
            f"the chart has no cube with {requirement.error}",
            code="chart-without-cubes",
            hint="measure one with uplift.lab.chart.measure",
        )

    def time(result: MethodResult) -> float:
        return result.numbers["time_ns"]

    def error(result: MethodResult) -> float:
        return result.numbers[requirement.error]

    fast = [cube for cube in cubes if requirement.time_ns is None or time(cube) <= requirement.time_ns]
    if not fast:
        fastest = min(cubes, key=time)
        raise OptionError(
            f"no cube takes at most {format_time(requirement.time_ns or 0)} per RGB",
            code="requirements-not-met",
            hint=f"the fastest, {fastest.method}, takes {format_time(time(fastest))}",
        )
    if requirement.delta_e is None:
        smallest = min(map(error, fast))
        return min((cube for cube in fast if CLEAR_RATIO * error(cube) <= smallest), key=time)
    sufficient = [cube for cube in fast if error(cube) <= requirement.delta_e]
    if not sufficient:
        best = min(fast, key=error)
        raise OptionError(
            f"no cube has at most ΔE00 {requirement.delta_e:g} {requirement.description}",
            code="requirements-not-met",
            hint=f"the most accurate, {best.method}, has {format_error(error(best))}",
        )
    return min(sufficient, key=time)
