"""Evidence on emission tables: ``make emission`` stores emission.json and a picture."""

from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import uplift
from benchmarks.emission import cost, error_map, exactness
from benchmarks.emission.left_out import SAME_COLOURS, family, predict, unknown_lamps
from benchmarks.emission.methods import NEAREST, nearest, planck, sigmoid_times_d65
from benchmarks.record import ROOT, write
from uplift.atlas import on_grid, read_atlas
from uplift.colorimetry import observer as observers
from uplift.colorimetry.lights import STANDARD_ILLUMINANTS, Lamps
from uplift.common.arrays import Array
from uplift.lights.discs import CLEARANCE, MAX_RADIUS
from uplift.lights.fit import nearest_lights
from uplift.lights.lattice import chromaticity
from uplift.lights.lookup import EmissionTable
from uplift.lights.prior import fit_lamp_prior, relit_delta_e

SURFACES = {"ColorChecker": "macbeth", "CIE 2017": "cie2017"}
TABLE, ALONE = "emission table", "the prior alone"
DIRECTIONS, STEPS = 720, 101
LEVELS = (1e-3, 1.0, 1e3, 1e5)
COLOURS, RUNS, LOOKUP_RUNS = 200_000, 3, 15
SIZES = tuple({"knots": knots, "rings": rings} for knots, rings in ((64, 8), (64, 16), (96, 24), (128, 32)))
THIRDS = 3
PICTURE = ROOT / "docs" / "emission" / "errors.png"


def main() -> None:
    """Measure, draw and store."""
    table, lamps = uplift.load_emission(), observers.lamps()
    surfaces = {label: on_grid(read_atlas(name), observers.grid()) for label, name in SURFACES.items()}
    radiometry = table.data.cmfs / table.data.cmfs[:, 1].sum()
    checker = surfaces["ColorChecker"]
    unknown = unknown_lamps(lamps, checker, radiometry)
    rules, repeated = np.concatenate(list(unknown.values())), np.tile(lamps.power, (len(unknown), 1))
    found = predict(lamps.names, rules, repeated)
    estimates = {
        rule: {TABLE: power, f"{TABLE}, no exact lamps": plain, **others(lamps, unknown[rule], radiometry)}
        for rule, power, plain in zip(
            unknown,
            np.split(found.table, len(unknown)),
            np.split(found.without_discs, len(unknown)),
            strict=True,
        )
    }
    estimates["lamp"] |= independent(table, lamps, checker)
    errors = relit_delta_e(lamps.power, estimates["lamp"][TABLE], checker, radiometry).mean(axis=1)
    PICTURE.parent.mkdir(exist_ok=True)
    error_map.draw(table, lamps.names, lamps.power, errors, PICTURE)
    with tempfile.TemporaryDirectory() as folder:
        sizes = list(cost.sizes(SIZES, RUNS, lamps.power, checker, Path(folder), cost.REFERENCE))
    write(
        "emission",
        "make emission",
        lamps=len(lamps),
        exact=len(table.lamp_names),
        space=table.space,
        shape=table.data.lattice.shape,
        prior=table.data.provenance["prior"],
        clearance=CLEARANCE,
        max_radius=MAX_RADIUS,
        same_colours=SAME_COLOURS,
        left_out={rule: float(rows.sum(axis=1).mean()) for rule, rows in unknown.items()},
        families=len({family(name) for name in lamps.names}),
        rows=list(rows(lamps, estimates, surfaces, radiometry)),
        worst=worst(lamps, estimates["lamp"][TABLE], errors, table),
        calibration=list(calibration(np.split(found.expected, len(unknown))[0], errors)),
        exactness=list(exactness.exactness(table, exactness.spokes(table, DIRECTIONS, STEPS))),
        mixtures=exactness.mixtures(table),
        round_trips=list(exactness.round_trips(table, LEVELS, COLOURS // 10)),
        white=list(exactness.white_lights(table, lamps, STANDARD_ILLUMINANTS, checker)),
        sizes=sizes,
        lookups=list(cost.lookups(COLOURS, LOOKUP_RUNS)),
    )


def others(lamps: Lamps, unknown: NDArray[np.bool_], radiometry: Array) -> dict[str, Array]:
    """Return the lights (L, N) by methods that use other lamps."""
    uv = chromaticity(lamps.power @ radiometry)
    found = {}
    for label, count in {"nearest lamp": 1, f"mean of the {NEAREST} nearest": NEAREST}.items():
        power = nearest(lamps, unknown, radiometry, count)
        found |= {label: power, f"{label}, moved": nearest_lights(power, uv, radiometry)}
    return found


def independent(table: EmissionTable, lamps: Lamps, checker: Array) -> dict[str, Array]:
    """Return the lights (L, N) of the prior alone, and by methods that need no measured lamps but D65."""
    radiometry = table.data.cmfs / table.data.cmfs[:, 1].sum()
    sigmoid = sigmoid_times_d65(
        lamps.power, radiometry, np.linalg.inv(table.rgb_to_xyz), lamps.power[lamps.names.index("D65")]
    )
    return {
        ALONE: fit_lamp_prior(lamps.power, checker, radiometry)[1],
        "sigmoid × D65": sigmoid.power,
        "Planck, moved": planck(lamps.power, radiometry, table.wavelengths),
    }


def rows(
    lamps: Lamps,
    estimates: dict[str, dict[str, Array]],
    surfaces: dict[str, Array],
    radiometry: Array,
) -> Iterator[dict[str, Any]]:
    """Yield mean, median and 95th percentile over the lamps of the mean ΔE00, by rule, method and surfaces."""
    for rule, methods in estimates.items():
        for method, power in methods.items():
            row: dict[str, Any] = {"rule": rule, "method": method}
            for label, reflectances in surfaces.items():
                errors = relit_delta_e(lamps.power, power, reflectances, radiometry).mean(axis=1)
                row[label] = {
                    "mean": float(errors.mean()),
                    "median": float(np.median(errors)),
                    "p95": float(np.percentile(errors, 95)),
                }
            yield row


def worst(lamps: Lamps, power: Array, errors: Array, table: EmissionTable, count: int = 8) -> list[dict[str, Any]]:
    """Return the lamps with the largest errors, and how far answers are from their chromaticity."""
    radiometry = table.data.cmfs
    missed = chromaticity(power @ radiometry) - chromaticity(lamps.power @ radiometry)
    return [
        {
            "lamp": lamps.names[row],
            "error": float(errors[row]),
            "uv_error": float(np.linalg.norm(missed[row])),
        }
        for row in np.argsort(errors)[: -count - 1 : -1]
    ]


def calibration(expected: Array, errors: Array) -> Iterator[dict[str, float]]:
    """Yield the mean expected and measured errors of thirds of the lamps, by expected error."""
    for part in np.array_split(np.argsort(expected, kind="stable"), THIRDS):
        yield {"expected": float(expected[part].mean()), "measured": float(errors[part].mean())}


if __name__ == "__main__":
    main()
