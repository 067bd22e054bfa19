"""Quality of a cube: assessment by its lattice and by measured spectra, as data, JSON and HTML page."""

from __future__ import annotations

from uplift.report.assessment import Assessment, assess
from uplift.report.calibration import Calibration, calibration
from uplift.report.crowding import Crowding, crowding
from uplift.report.failures import Failures, failures
from uplift.report.fidelity import EntryErrors, EntryQuery, entry_errors
from uplift.report.json_export import to_json
from uplift.report.page import page
from uplift.report.regression import RebuildDifference, compare_rebuilt
from uplift.report.round_trip import round_trips
from uplift.report.smoothness import Smoothness, smoothness
from uplift.report.summary import summary

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
    "calibration",
    "compare_rebuilt",
    "crowding",
    "entry_errors",
    "failures",
    "page",
    "round_trips",
    "smoothness",
    "summary",
    "to_json",
]
