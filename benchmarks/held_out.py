"""Held-out halves of atlases, by cubes and by plain baselines: ``make held-out`` writes docs/data/held-out.json.

Figures are marked as optimistic by `benchmarks.choices`.
"""

from __future__ import annotations

import warnings
from dataclasses import asdict
from typing import Any

import numpy as np

import uplift
from benchmarks.choices import ALONE, ALONE_SMOOTH, CHOICES, OURS, OURS_SMOOTH, is_optimistic
from benchmarks.fidelity.materials import SENSOR, errors, materials, spectra
from benchmarks.record import write
from uplift.colorimetry.lights import HELD_OUT_LIGHTS
from uplift.common.arrays import Array
from uplift.lab.chart.methods import mallett2019, otsu2018, smits1999
from uplift.lab.chart.task import make_task
from uplift.lab.study.baselines import NEIGHBOURS, mismatch_centroids
from uplift.lab.study.held_out import CENTROID, HALF, LOCAL_LINEAR, NO_ATLAS, SIGMOID, HoldoutSplit, holdout

SPLITS = 3
SETS = ("macbeth", "babelcolor", "pmc", "rawtoaces", "cie2017")
"""Sets of at least 20 entries. The others are too small to split."""
PUBLISHED = {
    "Otsu 2018": otsu2018.prepare,
    "Mallett 2019": mallett2019.prepare,
    "Smits 1999": smits1999.prepare,
}


def main() -> None:
    """Measure and store."""
    warnings.simplefilter("ignore", uplift.UpliftWarning)
    write(
        "held-out",
        "make held-out",
        lights=list(HELD_OUT_LIGHTS),
        splits=SPLITS,
        neighbours=NEIGHBOURS,
        choices=[asdict(choice) for choice in CHOICES],
        sets=[measure(name) for name in SETS],
    )


def measure(name: str) -> dict[str, Any]:
    """Return the errors of all methods on the held-out halves of a set, and how they compare."""
    learnt = holdout(spectra(name), SPLITS)
    smooth = holdout(spectra(name), SPLITS, prior="smooth", leave_out=())
    found = {
        OURS: pooled(learnt, HALF),
        OURS_SMOOTH: pooled(smooth, HALF),
        LOCAL_LINEAR: pooled(learnt, LOCAL_LINEAR),
        CENTROID: pooled(learnt, CENTROID),
        ALONE: pooled(learnt, NO_ATLAS),
        ALONE_SMOOTH: pooled(smooth, NO_ATLAS),
        SIGMOID: pooled(learnt, SIGMOID),
        **published(name),
    }
    means = {method: float(np.mean(values[1:])) for method, values in found.items()}
    best = min(means, key=lambda method: means[method])
    rows = [row(name, method, values, method == best) for method, values in found.items()]
    return {
        "set": name,
        "spectra": len(materials(name).rgb),
        "without_metamer": without_metamer(name),
        "best": best,
        "against": {method: means[OURS] / means[method] for method in means},
        "rows": rows,
    }


def pooled(splits: tuple[HoldoutSplit, ...], method: str) -> Array:
    """Mean rms, then mean ΔE00 under each light, over the splits; splits of one set differ by one entry at most."""
    return np.mean([split.errors[method].means() for split in splits], axis=0)


def published(name: str) -> dict[str, Array]:
    """Errors of methods of other authors, which use no atlas, on all materials of a set."""
    some, task = materials(name), make_task({"macbeth": spectra("macbeth")})
    found = {}
    for method, prepare in PUBLISHED.items():
        record = errors(prepare(task).uplift(some.rgb, SENSOR.wavelengths), some)
        found[method] = np.array([record["rms"], *record["errors"].values()])
    return found


def without_metamer(name: str) -> float:
    """Share of the colours of one half that no mixture of the other half has."""
    some = materials(name)
    kept, held_out = np.array_split(np.random.default_rng(0).permutation(len(some.rgb)), 2)
    found = mismatch_centroids(SENSOR, some.measured[kept], some.rgb[held_out], [SENSOR.light])
    return float(np.isnan(found[:, 0, 0]).mean())


def row(name: str, method: str, values: Array, best: bool) -> dict[str, Any]:
    """Return a row of the table."""
    rms, *delta_e = values.tolist()
    return {
        "method": method,
        "rms": None if np.isnan(rms) else rms,
        "mean": float(np.mean(delta_e)),
        "errors": dict(zip(HELD_OUT_LIGHTS, delta_e, strict=True)),
        "best": best,
        "optimistic": is_optimistic([name], method),
    }


if __name__ == "__main__":
    main()
