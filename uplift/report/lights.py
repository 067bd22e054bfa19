"""Quality of an emission table: exact colours, powers that are not negative, and expected errors."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.common.arrays import Array
from uplift.lights.lattice import chromaticity
from uplift.lights.lookup import EmissionTable
from uplift.report.round_trip import COLOURS, SEED
from uplift.report.summary import summarise_emission
from uplift.viz.histogram import Histogram, linear_edges, log_edges, make_histogram

MIN_DISTANCE = 1e-9
"""Smaller distances in u′v′ are rounding errors and are counted in the lowest bin."""
PEAKS = 40
"""Exponent of the random powers: large ones leave few wavelengths, so that colours reach the spectral locus."""


@dataclass(frozen=True, eq=False)
class LightAssessment:
    """Quality of one emission table.

    Parameters
    ----------
    name : str
        Base name of its file.
    size : int
        Bytes of the file.
    table : EmissionTable
        The table.
    facts : dict
        The result of `summarise_emission`.
    round_trip : Histogram
        Distance in u′v′ of random lights from the answers.
    smallest_power : float
        Smallest power of these answers.
    expected_error : Histogram
        Expected ΔE00 of the ColorChecker lit by these answers instead of a measured lamp.
    lamp_errors : ndarray, shape (E,)
        Expected ΔE00 at the chromaticities of the exact lamps, of another lamp of the same chromaticity.
    lamp_rgb : ndarray, shape (E, 3)
        Linear RGB of the exact lamps at luminance 1.
    """

    name: str
    size: int
    table: EmissionTable
    facts: dict[str, Any]
    round_trip: Histogram
    smallest_power: float
    expected_error: Histogram
    lamp_errors: Array
    lamp_rgb: Array


def assess_lights(table: EmissionTable, name: str, size: int) -> LightAssessment:
    """Assess an emission table by random lights and by its lamps.

    Parameters
    ----------
    table : EmissionTable
        The table.
    name : str
        Base name of its file.
    size : int
        Bytes of the file.

    Returns
    -------
    LightAssessment
        All numbers of a report.
    """
    radiometry = table.data.cmfs / table.data.cmfs[:, 1].sum()
    xyz = np.random.default_rng(SEED).random((COLOURS, len(radiometry))) ** PEAKS @ radiometry
    power = table.spectrum_of_xyz(xyz)
    distance = np.linalg.norm(chromaticity(power @ radiometry) - chromaticity(xyz), axis=1)
    expected = table.expected_error(table.rgb_of_xyz(xyz))
    lamps = table.data.entries.spectra @ radiometry
    lamp_rgb = table.rgb_of_xyz(lamps / lamps[:, 1:2])
    return LightAssessment(
        name=name,
        size=size,
        table=table,
        facts=summarise_emission(table.data),
        round_trip=make_histogram(distance, log_edges(distance, MIN_DISTANCE)),
        smallest_power=float(power.min()),
        expected_error=make_histogram(expected, linear_edges(expected)),
        lamp_errors=table.expected_error(lamp_rgb),
        lamp_rgb=lamp_rgb,
    )


def lights_to_json(assessment: LightAssessment) -> dict[str, Any]:
    """Return the numbers of an assessment as JSON values.

    Parameters
    ----------
    assessment : LightAssessment
        The assessment.

    Returns
    -------
    dict
        JSON values.
    """
    entries = assessment.table.data.entries
    rows = zip(entries.names, entries.uv.tolist(), entries.radius.tolist(), assessment.lamp_errors, strict=True)
    return {
        "table": assessment.name,
        "bytes": assessment.size,
        "facts": assessment.facts,
        "random_lights": COLOURS,
        "round_trip_uv": _statistics(assessment.round_trip),
        "smallest_power": assessment.smallest_power,
        "expected_error": _statistics(assessment.expected_error),
        "lamps": [
            {"name": name, "uv": uv, "disc": radius, "expected_error": float(error)} for name, uv, radius, error in rows
        ],
    }


def _statistics(values: Histogram) -> dict[str, float]:
    return {"mean": values.mean, "median": values.median, "p95": values.p95, "max": values.largest}
