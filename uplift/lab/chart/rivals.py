"""Methods that compute spectra from measured ones without a table: local-linear
regression, and the mean of metamers. Burns 2019 needs no measured spectra.

Domain: linear sRGB in [0, 1] under D65. Range: reflectance in [0, 1], of Burns not
limited to 1. The measured spectra are those that cubes with an atlas know. Spectra at
the wavelengths of cubes are interpolated linearly.
"""

from collections.abc import Callable
from functools import partial

import numpy as np

from uplift.common.arrays import Array
from uplift.lab.chart.method import (
    Method,
    PreparedMethod,
    Task,
    nbytes,
    ours,
    stopwatch,
)
from uplift.lab.study.burns2019 import reconstruct
from uplift.lab.study.local_linear import tune
from uplift.lab.study.metamer_mean import metamer_mean
from uplift.lookup import load


def prepare_regression(task: Task) -> PreparedMethod:
    """Tune a local-linear regression on the measured spectra."""
    regression, seconds = stopwatch(lambda: tune(load().data, task.own))
    return _interpolated(regression, task, nbytes(task.own), seconds)


def prepare_metamers(task: Task) -> PreparedMethod:
    """Mix metamers from the measured spectra."""
    spectra = partial(metamer_mean, load().data, task.own)
    return _interpolated(spectra, task, nbytes(task.own))


def prepare_burns(task: Task) -> PreparedMethod:
    """Solve for reflectances."""
    sensor = task.sensor

    def spectra(rgb: Array) -> Array:
        return reconstruct(sensor.light.xyz, sensor.xyz(rgb))

    return _interpolated(spectra, task, nbytes(sensor.light.xyz))


def _interpolated(
    spectra: Callable[[Array], Array], task: Task, size: int, seconds: float = 0.0
) -> PreparedMethod:
    """Return a method whose spectra are at the wavelengths of the task."""

    def uplift(rgb: Array, wavelengths: Array) -> Array:
        rows = [
            np.interp(wavelengths, task.sensor.wavelengths, row) for row in spectra(rgb)
        ]
        return np.stack(rows)

    return PreparedMethod(uplift, size, seconds)


METHODS = (
    Method(
        method="local-linear",
        title="Local-linear regression",
        family="Local-linear regression",
        source=(
            "Cleveland & Devlin, Locally weighted regression, JASA 83(403), 1988, of "
            "reflectance on RGB"
        ),
        prepare=prepare_regression,
        reference_sensor=ours,
        batch=False,
        note="measured spectra as those of cubes with an atlas, without a table",
    ),
    Method(
        method="metamer-mean",
        title="Mean of metamers",
        family="Mean of metamers",
        source=(
            "after Zhang, Funt & Mirzaei, Metamer mismatching in practice versus "
            "theory, JOSA A 33(3), 2016"
        ),
        prepare=prepare_metamers,
        reference_sensor=ours,
        batch=False,
        note="measured spectra as those of cubes with an atlas, mixed for each colour",
    ),
    Method(
        method="burns2019",
        title="Burns 2019",
        family="Burns 2019",
        source=(
            "Burns, Chromatic adaptation transform by spectral reconstruction, Color "
            "Research & Application 44(5), 2019"
        ),
        prepare=prepare_burns,
        reference_sensor=ours,
        claimed_range=(0, 1000),
        batch=False,
        note="our solver; reflectances may exceed 1",
    ),
)
