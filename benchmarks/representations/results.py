"""Rows of docs/data/representations.json."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from benchmarks.representations.thesis import Printed
from uplift.lab.comparison.filters import NONE, TunedFilter
from uplift.lab.comparison.measure import Comparison, RepresentationResult
from uplift.lab.comparison.recommend import cheapest
from uplift.lab.comparison.statistics import Statistics
from uplift.viz.format import capitalise

TARGETS = (2.0, 1.0, 0.5)
TABLE = 81
"""Floats of a light that is kept as its 5 nm table."""
Thesis = Mapping[tuple[str, str], Printed]
ThesisFilters = Mapping[tuple[str, int, str], Printed]
Row = dict[str, Any]


def advice(comparison: Comparison) -> Iterator[Row]:
    """Yield the cheapest representation for each set of lights and target, with and without tables of lights."""
    compact = Comparison(
        comparison.facts,
        comparison.sets,
        tuple(row for row in comparison.results if row.light_floats < TABLE),
    )
    for name, title in comparison.sets.items():
        for target in TARGETS:
            yield {
                "lights": title,
                "target": target,
                "cheapest": _named(cheapest(comparison, name, target)),
                "without_light_table": _named(cheapest(compact, name, target)),
            }


def _named(row: RepresentationResult | None) -> Row | None:
    return {"name": row.name, "floats": row.floats, "light_floats": row.light_floats} if row else None


def ranking(comparison: Comparison, thesis: Thesis) -> Iterator[Row]:
    """Yield the errors and costs of every representation under each set of lights, smallest mean first."""
    for name in comparison.sets:
        for row in comparison.of(name):
            printed = thesis.get((name, row.name))
            yield {
                "lights": name,
                "name": row.name,
                **_statistics(row.statistics),
                "thesis_mean": printed.mean if printed else None,
                "thesis_p97_5": printed.q97_5 if printed else None,
                "floats": row.floats,
                "light_floats": row.light_floats,
                "time": row.ns.median,
            }


def _statistics(errors: Statistics) -> Row:
    return {
        "mean": errors.mean,
        "std": errors.deviation,
        "median": errors.median,
        "p2_5": errors.q2_5,
        "p25": errors.q25,
        "p75": errors.q75,
        "p97_5": errors.q97_5,
    }


def filters(tuned: Sequence[TunedFilter], thesis: ThesisFilters) -> list[Row]:
    """Return the best filter of each kind; ``change`` is relative to no filter, None for that row."""
    unfiltered = {(one.lights, one.count): one.statistics.mean for one in tuned if one.kind == NONE}
    rows = []
    for one in tuned:
        printed, bare = thesis[one.lights, one.count, one.kind], thesis[one.lights, one.count, NONE]
        mean, reference = one.statistics.mean, unfiltered[one.lights, one.count]
        rows.append(
            {
                "lights": one.lights,
                "samples": one.count,
                "filter": one.kind,
                "mean": mean,
                "std": one.statistics.deviation,
                "change": None if one.kind == NONE else mean / reference - 1,
                "parameters": one.parameters,
                "thesis": {
                    "mean": printed.mean,
                    "change": None if one.kind == NONE else printed.mean / bare.mean - 1,
                    "parameters": printed.parameters,
                },
            }
        )
    return sorted(rows, key=lambda row: (row["lights"], row["samples"], row["mean"]))


def titles(*comparisons: Comparison) -> dict[str, str]:
    """Return the headings of the sets of lights."""
    return {name: capitalise(title) for one in comparisons for name, title in one.sets.items()}
