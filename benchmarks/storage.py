"""How exactly coefficients must be stored → docs/stability-storage.json, for docs/stability.md.

Whole lattices are fitted without an atlas, their coefficients rounded to half, single and double precision, and read
back: how much further from their colours are the points, by `uplift.fit.store`'s own measure?
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from itertools import product

import numpy as np

from benchmarks.timing import ROOT
from uplift import fit
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.common.errors import UpliftError
from uplift.fit.grow import grow
from uplift.fit.store import MAX_LOSS
from uplift.lattice import Lattice
from uplift.models import Model, Moments, Sigmoid, evaluate
from uplift.models.minimum_norm import forward_map

SPACES = ("sRGB", "P3-D65", "ITU-R BT.2020", "ProPhoto RGB")
MODELS: tuple[Model, ...] = (*(Moments(count) for count in (3, 5, 9, 13, 17)), Sigmoid())
DIM, THRESHOLD = 17, 1e-4
LIGHT = "FL11"
PATH = ROOT / "docs" / "stability-storage.json"
COLUMNS = (
    "space",
    "model",
    "coefficients",
    "half: no spectrum",
    "half: RGB",
    "single: RGB",
    "single: ΔE00",
    "single: points that lose",
    "a cube has",
)
NOTES = (
    f"Lattices of {DIM}³ points without an atlas. RGB: the largest change of any point's linear RGB by rounding "
    f"its coefficients; ΔE00: the largest change under {LIGHT}.",
    "No spectrum: points whose rounded coefficients are the moments of no reflectance.",
    f"Points that lose end more than {MAX_LOSS:g} of the threshold of {THRESHOLD:g} further from their colours in "
    "single precision. The rule: where there is none, a cube has float32, otherwise float64; every build decides "
    "for itself, as its file's reader would (`fit/store.py`).",
    "More moments do not ask for more digits. Wide spaces do: their saturated colours have spectra as steep as "
    "boxes, whose moments lie next to the boundary of the moment space, and the few moments worst, as they have "
    "no other spectrum to give.",
)


def main() -> None:
    table = {
        "title": "How exactly coefficients are stored",
        "command": "python -m benchmarks.storage",
        "columns": COLUMNS,
        "rows": list(_rows()),
        "notes": NOTES,
    }
    PATH.write_text(json.dumps(table, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


def _rows() -> Iterator[list[str]]:
    for space, model in product(SPACES, MODELS):
        sensor = observer.sensor(space)
        problem = _problem(model, sensor)
        coefficients, distance = _fitted(problem, sensor)
        exact = _spectra(model, sensor, coefficients)
        half, single = (
            _spectra(model, sensor, coefficients.astype(kind)) for kind in (np.float16, np.float32)
        )
        missed = np.abs(sensor.rgb(single) - problem.goal(np.arange(len(single)))).max(axis=1)
        lost = int((missed > distance + MAX_LOSS * THRESHOLD).sum())
        yield [
            space,
            model.name,
            str(model.count),
            str(int(np.isnan(half[:, 0]).sum())),
            *(f"{np.nanmax(np.abs(sensor.rgb(found) - sensor.rgb(exact))):.1e}" for found in (half, single)),
            f"{_difference(single, exact).max():.1e}",
            str(lost),
            "float64" if lost else "float32",
        ]


def _problem(model: Model, sensor: Sensor) -> fit.Problem:
    lattice = Lattice(observer.axis_nodes("srgb", DIM))
    beyond = fit.unrealisable(lattice, sensor, THRESHOLD / 2)
    ahead = forward_map(model, sensor.wavelengths, sensor.matrix)
    return fit.Problem(model, ahead, lattice, THRESHOLD, beyond)


def _fitted(problem: fit.Problem, sensor: Sensor) -> tuple[Array, Array]:
    """Coefficients (n, C) in double precision, and how far (n,) the multipliers are from their goals."""
    nothing, light = np.empty((0, len(sensor.wavelengths))), observer.light("A")
    entries = fit.fit_entries(
        problem.model, problem.forward, nothing, np.empty((0, 3)), [sensor.light], light, problem.tolerance
    )
    prior = fit.fit_prior(problem, sensor, entries, light)
    grown = grow(problem, lambda points: prior(problem.goal(points)), lambda done: None)
    return problem.model.to_storage(grown.multipliers), grown.distance


def _spectra(model: Model, sensor: Sensor, coefficients: Array) -> Array:
    """Reflectance (n, N) of coefficients (n, C); NaN of those that no reflectance has."""
    try:
        return evaluate(model, model.from_storage(coefficients.astype(float)), sensor.wavelengths)
    except UpliftError:
        if len(coefficients) == 1:
            return np.full((1, len(sensor.wavelengths)), np.nan)
        return np.concatenate([_spectra(model, sensor, part) for part in np.array_split(coefficients, 2)])


def _difference(found: Array, exact: Array) -> Array:
    light = observer.light(LIGHT)
    seen = (lab(spectra @ light.xyz.T, light.white) for spectra in (found, exact))
    return delta_e_2000(*seen)


if __name__ == "__main__":
    main()
