"""A comparison as flat records, for JSON and CSV."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict
from typing import Any

from uplift.lab.comparison.filters import TunedFilter
from uplift.lab.comparison.measure import Comparison, RepresentationResult


def records(comparison: Comparison) -> list[dict[str, Any]]:
    """Convert the results of a comparison to records.

    Parameters
    ----------
    comparison : Comparison
        The comparison.

    Returns
    -------
    list of dict
        One record per result; ``ns`` is a median, ``ns_least`` and ``ns_most`` are the extremes.
    """
    return [_record(result) for result in comparison.results]


def filter_records(tuned: Iterable[TunedFilter]) -> list[dict[str, Any]]:
    """Convert tuned filters to records.

    Parameters
    ----------
    tuned : iterable of Tuned
        The filters.

    Returns
    -------
    list of dict
        One record per filter.
    """
    return [
        {"lights": each.lights, "samples": each.count, "filter": each.kind, "parameters": each.parameters}
        | asdict(each.statistics)
        for each in tuned
    ]


def _record(result: RepresentationResult) -> dict[str, Any]:
    return {
        "lights": result.lights,
        "representation": result.name,
        "family": result.family,
        **asdict(result.statistics),
        "floats": result.floats,
        "light_floats": result.light_floats,
        "ns": result.ns.median,
        "ns_least": result.ns.min,
        "ns_most": result.ns.max,
    }
