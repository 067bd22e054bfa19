"""An assessment as JSON values: the numbers of the page, for machines."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import asdict
from typing import Any

import numpy as np

from uplift.colorimetry.sensor import Sensor
from uplift.colorimetry.srgb import hex_codes
from uplift.report.assessment import Assessment
from uplift.report.fidelity import EntryErrors
from uplift.report.round_trip import SEED
from uplift.viz.histogram import Histogram


def to_json(found: Assessment) -> dict[str, Any]:
    """Plain values; what is not finite is None, so that every JSON reader takes it."""
    return _plain(
        {
            "cube": found.name,
            "bytes": found.size,
            "build": found.facts,
            "failures": _failures(found),
            "fitting_distance": _histogram(found.distance),
            "round_trip": {
                "colours": found.round_trips["spectra"].counts.sum(),
                "seed": SEED,
                "illuminant": found.data.sensor.illuminant,
                "delta_e_2000": {mode: _histogram(part) for mode, part in found.round_trips.items()},
            },
            "standard_error": _standard_error(found),
            "smoothness": {**_histogram(found.smoothness), "steepest": found.steepest},
            "lights": [seen.illuminant for seen in found.lights],
            "atlas": {
                "files": found.sources,
                "own": found.own,
                "outside": found.outside,
                "absent": found.absent,
            },
            "delta_e_2000": {light: _histogram(part) for light, part in found.delta_e.items()},
            "entries": [] if found.entries is None else _entries(found.entries, found.lights),
            "crowding": _crowding(found),
        }
    )


def _failures(found: Assessment) -> dict[str, Any]:
    failed, data = found.failures, found.data
    return {
        "status": failed.counts,
        "over_threshold": failed.missed,
        "worst": [
            {
                "rgb": data.lattice.points[point],
                "lattice_rgb": data.points.rgb[point],
                "distance": data.points.distance[point],
            }
            for point in failed.points
        ],
        "improvements": failed.improvements,
        "left_out": failed.left_out,
        "skipped": failed.skipped,
    }


def _standard_error(found: Assessment) -> dict[str, Any]:
    return {
        "light": found.data.error_illuminant,
        "delta_e_2000": None if found.standard_error is None else _histogram(found.standard_error),
        "calibration": None if found.calibration is None else asdict(found.calibration),
    }


def _crowding(found: Assessment) -> dict[str, Any] | None:
    if (crowding := found.crowding) is None:
        return None
    listed = zip(_entries(crowding.entries, found.lights), crowding.nearest, crowding.apart, strict=True)
    return {
        "against": "measured" if found.own else "stored",
        "lost": [{"name": name, "same_colour": other} for name, other in crowding.lost],
        "entries": [entry | {"nearest": other, "apart": apart} for entry, other, apart in listed],
    }


def _histogram(part: Histogram) -> dict[str, Any]:
    return {
        "mean": part.mean,
        "median": part.median,
        "p95": part.p95,
        "max": part.largest,
        "edges": part.edges,
        "counts": part.counts,
    }


def _entries(found: EntryErrors, lights: tuple[Sensor, ...]) -> list[dict[str, Any]]:
    names = [seen.illuminant for seen in lights]

    def by_light(values: Any) -> dict[str, Any] | None:
        return None if values is None else dict(zip(names, values, strict=True))

    def at(values: Any, row: int) -> Any:
        return None if values is None else values[row]

    shown = {seen.illuminant: swatches(found, seen) for seen in lights}
    return [
        {
            "name": name,
            "rgb": found.rgb[row],
            "cell": found.cells[row],
            "delta_e_2000": by_light(found.delta_e[row]),
            "delta_e_2000_lattice": by_light(at(found.delta_e_lattice, row)),
            "rms": found.rms[row],
            "rms_lattice": at(found.rms_lattice, row),
            "delta_e_2000_reference": found.real[row],
            "standard_error": at(found.stated, row),
            "reach": at(found.reach, row),
            "reach_codes": at(found.codes, row),
            "srgb": {
                light: dict(zip(("wanted", "answered", "lattice"), codes[row], strict=False))
                for light, codes in shown.items()
            },
        }
        for row, name in enumerate(found.names)
    ]


def swatches(found: EntryErrors, seen: Sensor) -> list[tuple[str, ...]]:
    """``#rrggbb`` of every entry under a light: as wanted, as answered, and by the lattice alone if it is own."""
    parts = [part for part in (found.wanted, found.answered, found.lattice) if part is not None]
    return list(zip(*(hex_codes(seen.rgb(part)) for part in parts), strict=True))


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {str(key): _plain(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(inner) for inner in value]
    if isinstance(value, np.ndarray | np.generic):
        return _plain(value.tolist())
    return None if isinstance(value, float) and not math.isfinite(value) else value
