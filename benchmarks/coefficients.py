"""Bytes that a number of coefficients per node would save, part of ``make study``.

Writes docs/data/coefficients.json for docs/moments.md. Each node of a cube gets the smallest number of coefficients
whose spectrum, moved to exactly the colour of the node, stays within a tolerance of that of all coefficients, under
each of four lights.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np

import uplift
from benchmarks.record import ROOT, write
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.common.arrays import Array
from uplift.cube import CubeData
from uplift.lookup.refine import refine_to_rgb
from uplift.models import Moments, evaluate, reflectance

LIGHTS = ("A", "FL2", "FL11", "HP1")
TOLERANCES = (0.1, 0.2, 0.5, 1.0, 2.0)
"""Largest ΔE00 of a node under any of the lights."""
FLOAT_BYTES = 4
COUNT_BYTES = 1
"""Size of the number of coefficients of a node."""
FEWEST = 3


def main() -> None:
    """Build, measure and store."""
    warnings.simplefilter("ignore", uplift.UpliftWarning)
    macbeth = uplift.read_atlas(ROOT / "atlases" / "macbeth.txt")
    cubes = {
        "installed, no atlas": uplift.load().data,
        "macbeth": uplift.build(macbeth, dim=32).data,
        "macbeth, 17 coefficients": uplift.build(macbeth, dim=32, coefficients=17).data,
    }
    write(
        "coefficients",
        "make study",
        lights=list(LIGHTS),
        cubes=[measure(name, data) for name, data in cubes.items()],
    )


def measure(name: str, data: CubeData) -> dict[str, Any]:
    """Return the saving by tolerance, and the error of each number of coefficients in all nodes."""
    model = data.model
    if not isinstance(model, Moments):
        raise TypeError("variable numbers of coefficients need moments")
    errors = node_errors(data, model)
    counts = np.array(sorted(errors))
    worst = np.stack([errors[count] for count in counts], axis=1)
    return {
        "name": name,
        "dim": data.lattice.dim,
        "nodes": len(worst),
        "coefficients": model.count,
        "tolerances": [saving(worst, counts, tolerance, model.count) for tolerance in TOLERANCES],
        "uniform": [
            _one_count(int(count), column) for count, column in zip(counts, worst.T, strict=True) if count < model.count
        ],
    }


def node_errors(data: CubeData, model: Moments) -> Mapping[int, Array]:
    """Return the largest ΔE00 (n,) under the lights of the realisable nodes, by number of coefficients."""
    wavelengths = data.sensor.wavelengths
    kept = np.asarray(data.points.distance <= data.threshold)
    coefficients = np.asarray(data.points.coefficients[kept], dtype=float)
    full = reflectance(model, coefficients, wavelengths)
    rgb = data.sensor.rgb(full)
    lights = [observer.light(light, data.sensor.observer, *data.sensor.range) for light in LIGHTS]
    errors = {model.count: np.zeros(len(full))}
    for count in range(FEWEST, model.count):
        fewer = Moments(count, model.phase)
        multipliers = refine_to_rgb(data, fewer, fewer.from_storage(coefficients[:, :count]), rgb)
        spectra = evaluate(fewer, multipliers, wavelengths)
        found = np.max([delta_e_spectra(light, full, spectra) for light in lights], axis=0)
        inexact = np.abs(data.sensor.rgb(spectra) - rgb).max(axis=1) > data.threshold
        errors[count] = np.where(inexact, np.inf, found)
    return errors


def _one_count(count: int, errors: Array) -> dict[str, float]:
    """Return the errors of one number of coefficients in all nodes, and the share of nodes whose colour it reaches."""
    reached = errors[np.isfinite(errors)]
    return {
        "coefficients": count,
        "reached": len(reached) / len(errors),
        "mean": float(reached.mean()),
        "p95": float(np.percentile(reached, 95)),
        "largest": float(reached.max()),
    }


def saving(worst: Array, counts: Array, tolerance: float, full: int) -> dict[str, float]:
    """Return the mean number of coefficients within a tolerance, and the share of bytes saved."""
    within = worst <= tolerance
    smallest = counts[within.argmax(axis=1)]
    size = FLOAT_BYTES * smallest.mean() + COUNT_BYTES
    return {
        "tolerance": tolerance,
        "mean_count": float(smallest.mean()),
        "three": float((smallest == FEWEST).mean()),
        "all": float((smallest == full).mean()),
        "saved": float(1 - size / (FLOAT_BYTES * full)),
    }


if __name__ == "__main__":
    main()
