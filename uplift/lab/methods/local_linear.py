"""Local-linear regression of reflectance on colour, a plain baseline of cubes.

Cleveland & Devlin 1988, "Locally weighted regression", JASA 83(403).
"""

from dataclasses import dataclass
from functools import partial
from itertools import product, starmap

import numpy as np
from scipy.spatial.distance import cdist

from uplift.colorimetry import (
    Sensor,
    delta_e_spectra,
    in_unit_cube,
    observer,
    rgb_to_lab,
)
from uplift.colorimetry.illuminants import SCENE_LIGHTS
from uplift.common.arrays import Array
from uplift.lab.method import (
    Method,
    PreparedMethod,
    interpolated,
    nbytes,
    ours,
    stopwatch,
)
from uplift.lab.runner import Task
from uplift.lookup.refine import FIRST_DAMPING, MAX_STEPS
from uplift.models import Moments, forward_map, minimum_norm_step

BANDWIDTHS = (7.0, 10.0, 14.0, 20.0, 28.0, 40.0, 80.0, 1e4)
"""Standard deviations of the Gaussian weights, in CIE L*a*b*; the last one weighs all
materials alike.
"""
RIDGES = (1e-6, 1e-4, 1e-3, 1e-2, 1e-1, 1e3)
"""Weights of small slopes, relative to the sum of the weights; with the last one,
predictions are weighted means.
"""
LOWEST = 1e-4
"""Least distance of predicted reflectances from 0 and 1 before they move to their
colours.
"""
MODEL = Moments()
"""Model in which predictions move to their colours."""


@dataclass(frozen=True, eq=False)
class LocalLinear:
    """Regression on known reflectances (E, N), with a bandwidth and a ridge."""

    sensor: Sensor
    known: Array
    width: float
    ridge: float

    def __call__(self, rgb: Array, leave_out: bool = False) -> Array:
        """Predict reflectances (n, N) of linear RGB (n, 3); ``leave_out`` ignores a
        query's own row.
        """
        spectra = regress(
            self.sensor, self.known, rgb, self.width, self.ridge, leave_out
        )
        clipped = np.clip(spectra, LOWEST, 1 - LOWEST)
        return with_least_change(self.sensor, clipped, rgb)


def tune(sensor: Sensor, known: Array) -> LocalLinear:
    """Choose the bandwidth and the ridge with the least mean leave-one-out ΔE00 of the
    known materials under the lights of a build.
    """
    lights = [
        observer.light(name, sensor.observer, *sensor.range) for name in SCENE_LIGHTS
    ]
    colours = np.clip(sensor.rgb(known), 0, 1)

    def error(regression: LocalLinear) -> float:
        spectra = regression(colours, leave_out=True)
        errors = [delta_e_spectra(light, spectra, known) for light in lights]
        return float(np.mean(errors))

    smoothings = product(BANDWIDTHS, RIDGES)
    return min(starmap(partial(LocalLinear, sensor, known), smoothings), key=error)


def with_least_change(sensor: Sensor, spectra: Array, rgb: Array) -> Array:
    """Move spectra (n, N) to linear RGB (n, 3) by multipliers that are added to them
    and change them least.
    """
    forward = forward_map(MODEL, sensor.wavelengths, sensor.matrix)
    linear = MODEL.from_reflectance(spectra.T)
    damping = np.zeros(len(rgb))
    missed = rgb.T - sensor.matrix @ spectra.T
    for _ in range(MAX_STEPS):
        # Overflowing steps are rejected.
        with np.errstate(over="ignore", invalid="ignore"):
            step = minimum_norm_step(forward, linear, missed, damping)
            trial = linear + forward.basis @ step
            left = rgb.T - sensor.matrix @ MODEL.to_reflectance(trial)
        # As by Levenberg and Marquardt: the damping falls after a step that helped, and
        # rises after one that did not.
        better = (left**2).sum(axis=0) < (missed**2).sum(axis=0)
        linear = np.where(better, trial, linear)
        missed = np.where(better, left, missed)
        damping = np.where(
            better, damping / 10, np.maximum(10 * damping, FIRST_DAMPING)
        )
    return MODEL.to_reflectance(linear).T


def regress(
    sensor: Sensor,
    known: Array,
    rgb: Array,
    width: float,
    ridge: float,
    leave_out: bool = False,
) -> Array:
    """Local-linear predictions (n, N) at linear RGB (n, 3); ``leave_out`` ignores a
    query's own row.
    """
    colours = np.clip(sensor.rgb(known), 0, 1)
    squares = cdist(rgb_to_lab(sensor, rgb), rgb_to_lab(sensor, colours), "sqeuclidean")
    if leave_out:
        np.fill_diagonal(squares, np.inf)
    # Far queries keep the weight of the nearest colour.
    squares -= squares.min(axis=1, keepdims=True)
    weights = np.exp(-squares / (2 * width**2))
    weights /= weights.sum(axis=1, keepdims=True)
    offsets = colours[None] - rgb[:, None]
    terms = np.concatenate([np.ones((*offsets.shape[:2], 1)), offsets], axis=2)
    weighted = weights[:, :, None] * terms
    matrix = weighted.mT @ terms + ridge * np.diag([0.0, 1, 1, 1])
    first = np.linalg.solve(matrix, np.broadcast_to(np.eye(4)[:, :1], (len(rgb), 4, 1)))
    return (weighted @ first)[:, :, 0] @ known


def prepare(task: Task) -> PreparedMethod:
    """Tune a regression on the known spectra."""
    return _on_spectra(task, task.known_spectra)


def prepare_on_library(task: Task) -> PreparedMethod:
    """Tune a regression on the library within the space of the sensor."""
    colours = task.sensor.rgb(task.library)
    return _on_spectra(task, task.library[in_unit_cube(colours)])


def _on_spectra(task: Task, known: Array) -> PreparedMethod:
    regression, seconds = stopwatch(lambda: tune(task.sensor, known))
    return interpolated(regression, task, nbytes(known), seconds)


METHODS = (
    Method(
        method="local-linear",
        title="Local-linear regression",
        family="Local-linear regression",
        source=(
            "Cleveland & Devlin, Locally weighted regression, JASA 83(403), 1988, of "
            "reflectance on RGB"
        ),
        prepare=prepare,
        reference_sensor=ours,
        batch=False,
        note="measured spectra as those of cubes with an atlas, without a table",
    ),
)
