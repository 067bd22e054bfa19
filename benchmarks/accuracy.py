"""Round-trip accuracy of cubes: ``make accuracy`` writes docs/data/accuracy.json."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from functools import partial

import numpy as np

import uplift
from benchmarks.record import ROOT, write
from uplift.atlas import on_grid
from uplift.colorimetry.sensor import Sensor
from uplift.lab.chart import judge
from uplift.lookup import MODES, Cube

MACBETH = ROOT / "atlases" / "macbeth.txt"
RANGES = (
    (380, 780, 10),
    (380, 780, 5),
    (380, 780, 1),
    (360, 830, 10),
    (360, 830, 5),
    (360, 830, 1),
    (360, 1000, 5),
)
"""First and last wavelength and step in nm."""
VISIBLE = np.arange(400, 701, 5)
QUERIES = np.random.default_rng(20000).random((20000, 3))


def main() -> None:
    """Measure and store."""
    warnings.simplefilter("ignore", uplift.UpliftWarning)
    fitted, round_trips = [], []
    for name, cube in cubes():
        fitted.append({"cube": name, **fit_quality(cube)})
        errors = {mode: round_trip(cube, mode) for mode in MODES}
        fine = {mode: round_trip_at_1_nm(cube, mode) for mode in MODES}
        round_trips.append({"cube": name, "errors": errors, "fine": fine})
    figures = {"fitted": fitted, "round_trips": round_trips, "ranges": [at_range(*each) for each in RANGES]}
    write("accuracy", "make accuracy", queries=len(QUERIES), **figures)


def cubes() -> Iterator[tuple[str, Cube]]:
    """Build the cubes, with their names."""
    build = partial(uplift.build, debug=True)
    for dim in (16, 32, 64):
        yield f"moments, Macbeth, {dim}³", build(MACBETH, dim=dim)
        yield f"moments, no atlas, {dim}³", build(dim=dim)
        yield f"sigmoid, Macbeth, {dim}³", build(MACBETH, dim=dim, model="sigmoid")
        yield f"sigmoid, no atlas, {dim}³", build(dim=dim, model="sigmoid")
    for count in (3, 17):
        yield f"{count} coefficients, Macbeth, 32³", build(MACBETH, dim=32, coefficients=count)


def at_range(shortest: int, longest: int, step: int) -> dict[str, object]:
    """Build the ColorChecker at a range; return errors at 1 nm, and those of the spectra of its entries."""
    cube = uplift.build(MACBETH, shortest=shortest, longest=longest, step=step)
    measured = dict(zip(uplift.read_atlas(MACBETH).names, on_grid(uplift.read_atlas(MACBETH), VISIBLE), strict=True))
    answers = cube.reflectance(cube.data.atlas.rgb, VISIBLE)
    off = answers - [measured[name] for name in cube.data.atlas.names]
    names = {"range": f"{shortest}–{longest} nm", "step": step}
    return {**names, "fine": round_trip_at_1_nm(cube), "rms": float(np.sqrt((off**2).mean()))}


def fit_quality(cube: Cube) -> dict[str, float]:
    """Return the rounds of growth, counts of nodes and the largest residual."""
    counts, data = cube.data.points.counts(), cube.data.points
    return {
        "rounds": int(data.round.max()) + 1 if data.round is not None else 0,
        "improved": counts["improved"],
        "unfitted": counts["unfitted"],
        "worst": float(data.distance.max()),
    }


def round_trip(cube: Cube, mode: str, sensor: Sensor | None = None) -> list[float]:
    """Return the mean and the largest ΔE00 between the requested colours and those of the spectra, for a judge."""
    sensor = sensor or cube.data.sensor
    spectra = cube.reflectance(QUERIES, sensor.wavelengths, mode)
    errors = judge.round_trip(sensor, QUERIES, spectra)
    return [float(errors.mean()), float(errors.max())]


def round_trip_at_1_nm(cube: Cube, mode: str = "spectra") -> list[float]:
    """Return the same as `round_trip` for the judge of the chart, whom no cube is fitted to."""
    return round_trip(cube, mode, judge.at_1_nm(cube.data.sensor))


if __name__ == "__main__":
    main()
