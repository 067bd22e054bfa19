"""A comparison as flat records: for JSON and CSV."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict
from typing import Any

from uplift.lab.comparison.filters import Tuned
from uplift.lab.comparison.measure import Comparison, RepresentationResult


def records(found: Comparison) -> list[dict[str, Any]]:
    """A record a row; ``ns`` has its least and its most beside it."""
    return [_record(row) for row in found.rows]


def filter_records(tuned: Iterable[Tuned]) -> list[dict[str, Any]]:
    """A record a filter."""
    return [
        {"lights": one.lights, "samples": one.count, "filter": one.kind, "parameters": one.told}
        | asdict(one.statistics)
        for one in tuned
    ]


def _record(row: RepresentationResult) -> dict[str, Any]:
    return {
        "lights": row.lights,
        "representation": row.name,
        "family": row.family,
        **asdict(row.statistics),
        "floats": row.floats,
        "light_floats": row.light_floats,
        "ns": row.ns.median,
        "ns_least": row.ns.least,
        "ns_most": row.ns.most,
    }
