"""Recommendation of a cube of a chart by what is required of it."""

from dataclasses import dataclass

from uplift.colorimetry.illuminants import DEFAULT_ILLUMINANT
from uplift.common.errors import OptionError, unknown_name
from uplift.extras.colour.light_sets import CHART_LIGHTS
from uplift.extras.pages.format import format_error, format_time
from uplift.extras.pages.pareto import CLEAR_RATIO
from uplift.lab.chart.results import Chart, MethodResult


@dataclass(frozen=True)
class Requirement:
    """Limits for time and error; at least one is required. Raises `OptionError`,
    `UnknownNameError`.

    ``time_ns``: largest CPU time per RGB, in ns. ``delta_e``: largest mean ΔE00.
    ``light``: light of the ΔE00, by default all lights of the chart; the illuminant D65
    stands for round trips. ``own``: whether the ΔE00 is of materials of the atlas
    itself, not of unseen ones. ``plain``: whether the cube must have no atlas.
    ``smallest``: whether the smallest cube within the limits is chosen, instead of the
    fastest.
    """

    time_ns: float | None = None
    delta_e: float | None = None
    light: str | None = None
    own: bool = False
    plain: bool = False
    smallest: bool = False

    def __post_init__(self) -> None:
        limits = [limit for limit in (self.time_ns, self.delta_e) if limit is not None]
        if not limits or not all(0 < limit < float("inf") for limit in limits):
            got = ", ".join(f"{limit:g}" for limit in limits) or "neither"
            raise OptionError(
                f"time_ns, delta_e or both must be given as positive numbers, got {got}"
            )
        if self.light not in (None, DEFAULT_ILLUMINANT, *CHART_LIGHTS):
            raise unknown_name(
                str(self.light), (DEFAULT_ILLUMINANT, *CHART_LIGHTS), "light"
            )

    def error_of(self, cube: MethodResult) -> float:
        """Return the mean ΔE00 of a cube."""
        name = f"{'own_' if self.own else ''}{self.light or 'lights'}"
        if self.light == DEFAULT_ILLUMINANT:
            name = "round_trip"
        return cube.numbers[f"{name}_mean"]

    @property
    def description(self) -> str:
        """Return the conditions of the error as text."""
        if self.light == DEFAULT_ILLUMINANT:
            return "of the round trip"
        materials = "materials of the atlas" if self.own else "unseen materials"
        return f"under {self.light or ', '.join(CHART_LIGHTS)}, for {materials}"


SITUATIONS = {
    "no measurements": Requirement(delta_e=1.0, plain=True),
    "no measurements, little memory": Requirement(
        delta_e=1.0, plain=True, smallest=True
    ),
    "an atlas whose materials must look right": Requirement(delta_e=0.05, own=True),
    "such an atlas, little memory": Requirement(delta_e=0.05, own=True, smallest=True),
}
"""What is required in common situations."""


def recommend_cube(chart: Chart, requirement: Requirement) -> MethodResult:
    """Choose the fastest or smallest cube within the limits, or the most accurate in
    time. Raises `OptionError`.
    """
    longest = requirement.time_ns
    largest = requirement.delta_e
    cubes = []
    for result in chart.measured:
        is_excluded = requirement.plain and "--atlas" in result.build
        if result.build and not is_excluded:
            cubes.append(result)
    if not cubes:
        raise _unmet("the chart has no such cube", "measure a chart with cubes")
    fastest = min(cubes, key=_time)
    in_time = [cube for cube in cubes if longest is None or _time(cube) <= longest]
    if not in_time:
        raise _unmet(
            f"no cube takes at most {longest:g} ns per RGB",
            f"the fastest, {fastest.method}, takes {format_time(_time(fastest))}",
        )
    best = min(in_time, key=requirement.error_of)
    smallest = requirement.error_of(best)
    limit = smallest / CLEAR_RATIO if largest is None else largest
    sufficient = [cube for cube in in_time if requirement.error_of(cube) <= limit]
    if not sufficient:
        problem = f"no cube has at most ΔE00 {largest:g} {requirement.description}"
        raise _unmet(
            problem, f"the most accurate, {best.method}, has {format_error(smallest)}"
        )
    return min(
        sufficient,
        key=lambda cube: (cube.numbers["bytes"] * requirement.smallest, _time(cube)),
    )


def _time(cube: MethodResult) -> float:
    return cube.numbers["time_ns"]


def _unmet(problem: str, hint: str) -> OptionError:
    return OptionError(problem, code="requirements-not-met", hint=hint)
