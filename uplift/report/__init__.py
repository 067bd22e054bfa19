"""Quality of a cube: assessment by its lattice and by measured spectra, as data, JSON and HTML page."""

from __future__ import annotations

from uplift.report.assessment import Assessment, assess
from uplift.report.calibration import Calibration, check_calibration
from uplift.report.crowding import Crowding, find_crowding
from uplift.report.failures import Failures, collect_failures
from uplift.report.fidelity import EntryErrors, EntryQuery, entry_errors
from uplift.report.json_export import to_json
from uplift.report.page import render_report
from uplift.report.regression import RebuildDifference, compare_rebuilt
from uplift.report.round_trip import round_trip_errors
from uplift.report.smoothness import Smoothness, compute_smoothness
from uplift.report.summary import summarise

__all__ = [
    "Assessment",
    "Calibration",
    "Crowding",
    "EntryErrors",
    "EntryQuery",
    "Failures",
    "RebuildDifference",
    "Smoothness",
    "assess",
    "check_calibration",
    "collect_failures",
    "compare_rebuilt",
    "compute_smoothness",
    "entry_errors",
    "find_crowding",
    "render_report",
    "round_trip_errors",
    "summarise",
    "to_json",
]
