"""Errors on held-out measurements: a cube or a baseline that knows half of an atlas predicts the other half."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.atlas import Atlas, resample
from uplift.colorimetry import observer
from uplift.colorimetry.delta_e import delta_e_2000, delta_e_spectra, lab
from uplift.colorimetry.lights import HELD_OUT_LIGHTS
from uplift.common.arrays import Array, Indices
from uplift.common.errors import AtlasError, UpliftWarning
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.cube import CubeData
from uplift.fit.families import families_with
from uplift.lab.study.baselines import local_linear, mismatch_centroids
from uplift.lookup import Cube
from uplift.pipeline.build import build
from uplift.report.measures import Calibration, check_calibration

__all__ = [
    "HoldoutSplit",
    "SpectrumErrors",
    "baseline_errors",
    "holdout",
    "pooled_calibration",
    "spectrum_errors",
]

MIN_ENTRIES = 8
"""Fewest entries within the RGB space of an atlas that is split."""
HALF, NO_ATLAS, SIGMOID = "half the atlas", "without an atlas", "sigmoid"
"""Names of the cubes that are compared."""
LOCAL_LINEAR, CENTROID = "local-linear regression", "centroid of mismatch"
"""Names of the baselines, which know the same half of the atlas (`uplift.lab.study.baselines`)."""


@dataclass(frozen=True, eq=False)
class SpectrumErrors:
    """Errors of n predicted spectra.

    ``rms`` (n,): root mean square over wavelength; NaN for a method that predicts colours only.
    ``delta_e`` (n, L): ΔE00 under L lights.
    """

    rms: Array
    delta_e: Array

    def means(self) -> Array:
        """Average over the spectra. The result has shape (1 + L,)."""
        return np.concatenate([[self.rms.mean()], self.delta_e.mean(axis=0)])


@dataclass(frozen=True, eq=False)
class HoldoutSplit:
    """One split of an atlas and the errors on its held-out half of n entries.

    ``errors``: errors by the name of the cube or baseline.
    ``actual`` (n,): ΔE00 of the cube with half the atlas, under its reference illuminant.
    ``predicted`` (n,): standard errors that this cube predicts, if it has any.
    ``bound`` (n,): error bounds that it predicts, likewise.
    """

    errors: dict[str, SpectrumErrors]
    actual: Array
    predicted: Array | None
    bound: Array | None


def spectrum_errors(predicted: Array, measured: Array, lights: Sequence[str] = HELD_OUT_LIGHTS) -> SpectrumErrors:
    """Compare predicted with measured reflectances. Shapes: ``predicted, measured`` (n, N)."""
    rms = np.sqrt(((predicted - measured) ** 2).mean(axis=1))
    delta_e = [delta_e_spectra(observer.light(name), predicted, measured) for name in lights]
    return SpectrumErrors(rms, np.stack(delta_e, axis=1))


def baseline_errors(
    data: CubeData, known: Array, measured: Array, lights: Sequence[str] = HELD_OUT_LIGHTS
) -> dict[str, SpectrumErrors]:
    """Predict measured reflectances from known ones by `local_linear` and `mismatch_centroids`.

    A colour without a centroid, as no mixture of known materials has it, has the error of the regression.

    Shapes: ``known, measured`` (E, N) and (n, N).
    """
    sensor = data.sensor
    rgb = np.clip(sensor.rgb(measured), 0, 1)
    shine = [observer.light(name) for name in lights]
    linear = spectrum_errors(local_linear(data, known, rgb), measured, lights)
    centroids = mismatch_centroids(sensor, known, rgb, shine)
    without = np.isnan(centroids[:, 0, 0])
    delta_e = [
        delta_e_2000(lab(measured @ light.xyz.T, light.white), lab(centroids[:, number], light.white))
        for number, light in enumerate(shine)
    ]
    of_centroids = np.where(without[:, None], linear.delta_e, np.stack(delta_e, axis=1))
    return {LOCAL_LINEAR: linear, CENTROID: SpectrumErrors(np.full(len(measured), np.nan), of_centroids)}


def holdout(
    atlas: Atlas, splits: int = 3, progress: ProgressCallback = ignore_progress, **options: Any
) -> tuple[HoldoutSplit, ...]:
    """Build cubes from random halves of an atlas and predict the other halves. Raises `AtlasError`."""
    total = 2 + splits
    options = {"leave_out": families_with(resample(atlas, observer.grid()).values), **options}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UpliftWarning)
        others = {NO_ATLAS: build(**options), SIGMOID: build(**{**options, "model": "sigmoid"})}
        progress(Progress("builds", 2, total))
        inside = _entries_in_gamut(atlas, others[SIGMOID])
        results = []
        for seed in range(splits):
            kept, held_out = np.array_split(np.random.default_rng(seed).permutation(len(inside)), 2)
            cube = build(_subset(atlas, inside[kept]), **options)
            known, unknown = (_subset(atlas, inside[rows]) for rows in (kept, held_out))
            results.append(_evaluate({HALF: cube, **others}, known, unknown))
            progress(Progress("builds", 3 + seed, total))
    return tuple(results)


def pooled_calibration(splits: Sequence[HoldoutSplit]) -> Calibration | None:
    """Compare predicted standard errors with actual errors over all splits."""
    parts = [(split.actual, split.predicted, split.bound) for split in splits if split.predicted is not None]
    if not parts:
        return None
    return check_calibration(*(np.concatenate(part) for part in zip(*parts, strict=True)))


def _evaluate(cubes: dict[str, Cube], known: Atlas, held_out: Atlas) -> HoldoutSplit:
    cube = cubes[HALF]
    sensor = cube.data.sensor
    measured = resample(held_out, sensor.wavelengths).values
    rgb = np.clip(sensor.rgb(measured), 0, 1)
    predicted = {name: other.reflectance(rgb) for name, other in cubes.items()}
    light = observer.light(cube.data.error_illuminant, sensor.observer)
    errors = {name: spectrum_errors(spectra, measured) for name, spectra in predicted.items()}
    baselines = baseline_errors(cube.data, resample(known, sensor.wavelengths).values, measured)
    return HoldoutSplit(
        errors | baselines,
        delta_e_spectra(light, predicted[HALF], measured),
        cube.standard_error(rgb),
        cube.error_bound(rgb),
    )


def _entries_in_gamut(atlas: Atlas, cube: Cube) -> Indices:
    """Indices of the entries within the RGB space of the cube."""
    sensor = cube.data.sensor
    rows = np.flatnonzero(sensor.contains(sensor.rgb(resample(atlas, sensor.wavelengths).values)))
    if len(rows) < MIN_ENTRIES:
        raise AtlasError(
            f"a split needs at least {MIN_ENTRIES} entries within {sensor.space}, got {len(rows)}",
            code="too-few-entries",
            hint="use a larger atlas",
        )
    return rows


def _subset(atlas: Atlas, rows: Indices) -> Atlas:
    return Atlas(tuple(atlas.entries[row] for row in rows))
