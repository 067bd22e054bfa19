"""Local-linear regression of reflectance on colour, a plain baseline of cubes.

Cleveland & Devlin 1988, "Locally weighted regression", JASA 83(403).
"""

from collections.abc import Callable
from itertools import product

import numpy as np
from scipy.spatial.distance import cdist

from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_spectra, rgb_to_lab
from uplift.colorimetry.illuminants import SCENE_LIGHTS
from uplift.colorimetry.sensor import Sensor, in_unit_cube
from uplift.common.arrays import Array
from uplift.extras.timing import stopwatch
from uplift.lab.method import (
    Method,
    PreparedMethod,
    interpolated,
    ours,
)
from uplift.lab.runner import KNOWN, Known, Task
from uplift.lookup.refine import FIRST_DAMPING, MAX_STEPS
from uplift.models.minimum_norm import forward_map, minimum_norm_step
from uplift.models.moments import Moments

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


def tune(sensor: Sensor, known: Array) -> Callable[[Array], Array]:
    """Return the regression on known reflectances (E, N), those within the space, whose
    bandwidth and ridge have the least mean leave-one-out ΔE00 under the lights of a
    build.
    """
    known = known[in_unit_cube(sensor.rgb(known))]
    lights = observer.lights(SCENE_LIGHTS, sensor.observer, sensor.range)
    colours = np.clip(sensor.rgb(known), 0, 1)
    left_out = squared_distances(sensor, colours, colours)
    np.fill_diagonal(left_out, np.inf)

    def error(smoothing: tuple[float, float]) -> float:
        spectra = regress(sensor, known, colours, left_out, smoothing)
        errors = [delta_e_spectra(light, spectra, known) for light in lights]
        return float(np.mean(errors))

    smoothing = min(product(BANDWIDTHS, RIDGES), key=error)

    def predict(rgb: Array) -> Array:
        squares = squared_distances(sensor, rgb, colours)
        return regress(sensor, known, rgb, squares, smoothing)

    return predict


def squared_distances(sensor: Sensor, rgb: Array, known: Array) -> Array:
    """Squares (n, E) of the distances of colours in CIE L*a*b*."""
    places = rgb_to_lab(sensor, rgb), rgb_to_lab(sensor, known)
    return cdist(*places, "sqeuclidean")


def regress(
    sensor: Sensor,
    known: Array,
    rgb: Array,
    squares: Array,
    smoothing: tuple[float, float],
) -> Array:
    """Predict reflectances (n, N) of linear RGB (n, 3) from known ones (E, N) at
    squared distances (n, E), with a bandwidth and a ridge.
    """
    width, ridge = smoothing
    # Far queries keep the weight of the nearest colour.
    beyond_nearest = squares - squares.min(axis=1, keepdims=True)
    weights = np.exp(-beyond_nearest / (2 * width**2))
    weights /= weights.sum(axis=1, keepdims=True)
    offsets = np.clip(sensor.rgb(known), 0, 1)[None] - rgb[:, None]
    terms = np.concatenate([np.ones((*offsets.shape[:2], 1)), offsets], axis=2)
    weighted = weights[:, :, None] * terms
    matrix = weighted.mT @ terms + ridge * np.diag([0.0, 1, 1, 1])
    first = np.linalg.solve(matrix, np.broadcast_to(np.eye(4)[:, :1], (len(rgb), 4, 1)))
    spectra = (weighted @ first)[:, :, 0] @ known
    clipped = np.clip(spectra, LOWEST, 1 - LOWEST)
    return with_least_change(sensor, clipped, rgb)


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


def prepare(task: Task, known: Known = KNOWN) -> PreparedMethod:
    """Tune a regression on the known spectra of a task."""
    spectra = known(task)
    regression, run = stopwatch(lambda: tune(task.sensor, spectra))
    return interpolated(regression, task, spectra.nbytes, run.cpu)


METHODS = (
    Method(
        method="local-linear",
        title="Local-linear regression",
        source=(
            "Cleveland & Devlin, Locally weighted regression, JASA 83(403), 1988, of "
            "reflectance on RGB"
        ),
        prepare=prepare,
        reference_sensor=ours,
        note="measured spectra as those of cubes with an atlas, without a table",
    ),
)
