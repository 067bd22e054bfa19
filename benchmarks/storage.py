"""Precision of stored coefficients: writes docs/data/stability-storage.json.

Lattices are fitted without an atlas and their coefficients rounded to half and single precision. The residuals of the
rounded coefficients are evaluated as `uplift.fit.store` does.
"""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np

from benchmarks.record import write
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_2000, lab
from uplift.colorimetry.sensor import Sensor
from uplift.common.arrays import Array
from uplift.common.errors import UpliftError
from uplift.common.progress import ignore_progress
from uplift.fit.base import learn_base
from uplift.fit.growth import grow_from_prior
from uplift.fit.prior import Prior
from uplift.fit.problem import Nodes, Problem, nodes_of
from uplift.fit.store import MAX_LOSS
from uplift.lattice import Lattice
from uplift.models import Model, Moments, Sigmoid, evaluate

SPACES = ("sRGB", "P3-D65", "ITU-R BT.2020", "ProPhoto RGB")
MODELS: tuple[Model, ...] = (*(Moments(count) for count in (3, 5, 9, 13, 17)), Sigmoid())
DIM, THRESHOLD = 17, 1e-4
LIGHT = "FL11"


def main() -> None:
    """Measure and store."""
    write(
        "stability-storage",
        "python -m benchmarks.storage",
        dim=DIM,
        light=LIGHT,
        loss=MAX_LOSS,
        threshold=THRESHOLD,
        rows=[precision(space, model) for space, model in product(SPACES, MODELS)],
    )


def precision(space: str, model: Model) -> dict[str, Any]:
    """Fit a lattice, round its coefficients, and return the largest errors."""
    sensor = observer.sensor(space)
    nodes = nodes_of(Lattice(observer.axis_nodes("srgb", DIM)), sensor, THRESHOLD / 2)
    coefficients, distance = _fitted(Problem(sensor, model, threshold=THRESHOLD), nodes)
    exact = _spectra(model, sensor, coefficients)
    half, single = (_spectra(model, sensor, coefficients.astype(kind)) for kind in (np.float16, np.float32))
    residual = np.abs(sensor.rgb(single) - nodes.goal(nodes.points)).max(axis=1)
    lossy = int((residual > distance + MAX_LOSS * THRESHOLD).sum())
    half_rgb, single_rgb = (
        float(np.nanmax(np.abs(sensor.rgb(spectra) - sensor.rgb(exact)))) for spectra in (half, single)
    )
    return {
        "space": space,
        "model": model.name,
        "coefficients": model.count,
        "no_spectrum": int(np.isnan(half[:, 0]).sum()),
        "half_rgb": half_rgb,
        "single_rgb": single_rgb,
        "single_delta_e": float(_difference(single, exact).max()),
        "lossy": lossy,
        "dtype": "float64" if lossy else "float32",
    }


def _fitted(problem: Problem, nodes: Nodes) -> tuple[Array, Array]:
    """Return coefficients (n, C) in double precision, and the residuals (n,) of the multipliers."""
    prior = Prior(problem.model, problem.sensor, learn_base(problem)[0])
    nobody = np.zeros(0, dtype=np.int64)
    grown = grow_from_prior(problem, nodes, lambda points: prior(nodes.goal(points)), nobody, ignore_progress)
    return problem.model.to_storage(grown.multipliers), grown.distance


def _spectra(model: Model, sensor: Sensor, coefficients: Array) -> Array:
    """Return reflectances (n, N) of coefficients (n, C); NaN if they are the moments of no reflectance."""
    try:
        return evaluate(model, model.from_storage(coefficients.astype(float)), sensor.wavelengths)
    except UpliftError:
        if len(coefficients) == 1:
            return np.full((1, len(sensor.wavelengths)), np.nan)
        return np.concatenate([_spectra(model, sensor, part) for part in np.array_split(coefficients, 2)])


def _difference(spectra: Array, exact: Array) -> Array:
    light = observer.light(LIGHT)
    labs = (lab(one @ light.xyz.T, light.white) for one in (spectra, exact))
    return delta_e_2000(*labs)


if __name__ == "__main__":
    main()
