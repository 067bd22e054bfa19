"""Comparison of spectral representations for renderers: errors, cost, filters, recommendations and pictures."""

from __future__ import annotations

from uplift.lab.comparison.filters import TunedFilter, tune_filters
from uplift.lab.comparison.measure import (
    Comparison,
    RepresentationResult,
    TimingOptions,
    compare,
    error_statistics,
)
from uplift.lab.comparison.recommend import cheapest, check_target, most_accurate
from uplift.lab.comparison.scene import LightSet, Scene, make_scene
from uplift.lab.comparison.statistics import Statistics, compute_statistics
from uplift.lab.comparison.table import filter_records, records

__all__ = [
    "Comparison",
    "LightSet",
    "RepresentationResult",
    "Scene",
    "Statistics",
    "TimingOptions",
    "TunedFilter",
    "cheapest",
    "check_target",
    "compare",
    "compute_statistics",
    "error_statistics",
    "filter_records",
    "make_scene",
    "most_accurate",
    "records",
    "tune_filters",
]
