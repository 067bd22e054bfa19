"""Errors on held-out measurements: cubes and a plain baseline that know half of an
atlas predict the other half.
"""

import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from scipy.spatial.distance import cdist

from uplift.atlas import Atlas, resample
from uplift.colorimetry import (
    Sensor,
    delta_e_spectra,
    in_unit_cube,
    observer,
    rgb_to_lab,
)
from uplift.colorimetry.illuminants import SCENE_LIGHTS
from uplift.common.arrays import Array, Indices
from uplift.common.errors import AtlasError, UpliftWarning
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.cube import CubeData
from uplift.extras.colour.light_sets import HELD_OUT_LIGHTS
from uplift.extras.report.fidelity import Answers, compare_spectra
from uplift.extras.report.measures import check_calibration
from uplift.fit import families_with
from uplift.lookup import Cube
from uplift.lookup.refine import FIRST_DAMPING, MAX_STEPS
from uplift.models import forward_map, minimum_norm_step
from uplift.pipeline.build import build
from uplift.pipeline.options import Options
from uplift.pipeline.stages import problem_of

MIN_ENTRIES = 8
"""Fewest entries within the RGB space of an atlas that is split."""
HALF = "half the atlas"
NO_ATLAS = "without an atlas"
SIGMOID = "sigmoid"
LOCAL_LINEAR = "local-linear regression"
"""Names of cubes, and of a baseline that knows the same half of the atlas."""


@dataclass(frozen=True, eq=False)
class HoldoutSplit:
    """Half of an atlas, and the errors on the other half of n entries.

    ``errors``: errors by the name of the cube or of the baseline. ``actual`` (n,): ΔE00
    of the cube with half the atlas, under its reference illuminant. ``predicted``,
    ``bound`` (n,): standard errors and error bounds that this cube predicts, if it has
    any.
    """

    errors: dict[str, Answers]
    actual: Array
    predicted: Array | None
    bound: Array | None


def holdout(
    atlas: Atlas,
    splits: int = 3,
    progress: ProgressCallback = ignore_progress,
    **options: Any,
) -> tuple[HoldoutSplit, ...]:
    """Divide an atlas in random halves, and predict each half by a cube of the other
    one: two results per split.

    By default the prior does not know the families that contain spectra of the atlas.
    """
    total = 2 + 2 * splits
    unknown = families_with(resample(atlas, observer.grid()).values)
    options = {"leave_out": unknown, **options}
    settings = Options(**options)
    sensor = problem_of(settings, settings.observer, settings.solver)[1].sensor
    measured = resample(atlas, sensor.wavelengths).values
    inside = np.flatnonzero(in_unit_cube(sensor.rgb(measured)))
    if len(inside) < MIN_ENTRIES:
        problem = (
            f"a split needs at least {MIN_ENTRIES} entries within {sensor.space}, got "
            f"{len(inside)}"
        )
        raise AtlasError(problem, code="too-few-entries", hint="use a larger atlas")
    with warnings.catch_warnings(action="ignore", category=UpliftWarning):
        others = {
            NO_ATLAS: build(**options),
            SIGMOID: build(**{**options, "model": "sigmoid"}),
        }
        progress(Progress("builds", 2, total))
        results: list[HoldoutSplit] = []
        for kept, other in halves_both_ways(inside, splits):
            cube = build(Atlas(tuple(atlas.entries[row] for row in kept)), **options)
            cubes = {HALF: cube, **others}
            results.append(_evaluate(cubes, measured[kept], measured[other]))
            progress(Progress("builds", 2 + len(results), total))
    return tuple(results)


def halves_both_ways(rows: Indices, splits: int) -> Iterator[tuple[Indices, Indices]]:
    """Yield random halves of rows, known and queried, in both directions."""
    for seed in range(splits):
        first, second = (rows[half] for half in random_halves(len(rows), seed))
        yield first, second
        yield second, first


def random_halves(count: int, seed: int) -> tuple[Indices, Indices]:
    """Divide the numbers up to ``count`` at random; the first half is the larger."""
    first, second = np.array_split(np.random.default_rng(seed).permutation(count), 2)
    return first, second


def _evaluate(cubes: dict[str, Cube], known: Array, measured: Array) -> HoldoutSplit:
    """Predict reflectances (n, N) by cubes, and by a baseline that knows (E, N)."""
    cube = cubes[HALF]
    sensor = cube.data.sensor
    rgb = np.clip(sensor.rgb(measured), 0, 1)
    predicted = {name: other.reflectance(rgb) for name, other in cubes.items()}
    predicted[LOCAL_LINEAR] = local_linear(cube.data, known, rgb)
    errors = {
        name: spectrum_errors(spectra, measured) for name, spectra in predicted.items()
    }
    light = observer.light(cube.data.error_illuminant, sensor.observer)
    actual = delta_e_spectra(light, predicted[HALF], measured)
    return HoldoutSplit(errors, actual, cube.standard_error(rgb), cube.error_bound(rgb))


def spectrum_errors(
    predicted: Array, measured: Array, lights: Sequence[str] = HELD_OUT_LIGHTS
) -> Answers:
    """Compare predicted with measured reflectances (n, N)."""
    return compare_spectra(predicted, measured, map(observer.light, lights))


def split_records(splits: Sequence[HoldoutSplit]) -> list[dict[str, Any]]:
    """Return mean errors over the splits by method, and the first's calibration."""
    records: list[dict[str, Any]] = []
    for method in splits[0].errors:
        means = np.mean([split.errors[method].means() for split in splits], axis=0)
        named = zip(("rms", *HELD_OUT_LIGHTS), means.tolist(), strict=True)
        records.append(
            {"cube": method, "colours": len(splits[0].actual), **dict(named)}
        )
    # Over all splits together; small atlases have no standard errors.
    triples = [
        (split.actual, split.predicted, split.bound)
        for split in splits
        if split.predicted is not None
    ]
    calibration = None
    if triples:
        pooled = map(np.concatenate, zip(*triples, strict=True))
        calibration = check_calibration(*pooled)
    records[0]["standard_error"] = calibration and calibration.to_json()
    return records


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


def local_linear(data: CubeData, known: Array, rgb: Array) -> Array:
    """Predict reflectances (n, N) of linear RGB (n, 3) by a local-linear regression on
    known ones (E, N).

    Bandwidth and ridge have the least mean leave-one-out ΔE00 of the known materials
    under the lights of a build. Predictions are moved to their colours. Cleveland &
    Devlin 1988, "Locally weighted regression", JASA 83(403).
    """
    lights = [
        observer.light(name, data.sensor.observer, *data.sensor.range)
        for name in SCENE_LIGHTS
    ]
    colours = np.clip(data.sensor.rgb(known), 0, 1)

    def predict(
        queries: Array, width: float, ridge: float, leave_out: bool = False
    ) -> Array:
        spectra = regress(data.sensor, known, queries, width, ridge, leave_out)
        clipped = np.clip(spectra, LOWEST, 1 - LOWEST)
        return with_least_change(data, clipped, queries)

    def error(smoothing: tuple[float, float]) -> float:
        spectra = predict(colours, *smoothing, leave_out=True)
        errors = [delta_e_spectra(light, spectra, known) for light in lights]
        return float(np.mean(errors))

    return predict(rgb, *min(product(BANDWIDTHS, RIDGES), key=error))


def with_least_change(data: CubeData, spectra: Array, rgb: Array) -> Array:
    """Move spectra (n, N) to linear RGB (n, 3) by multipliers that are added to them
    and change them least.
    """
    model = data.model
    sensor = data.sensor
    forward = forward_map(model, sensor.wavelengths, sensor.matrix)
    linear = model.from_reflectance(spectra.T)
    damping = np.zeros(len(rgb))
    missed = rgb.T - sensor.matrix @ spectra.T
    for _ in range(MAX_STEPS):
        # Overflowing steps are rejected.
        with np.errstate(over="ignore", invalid="ignore"):
            step = minimum_norm_step(forward, linear, missed, damping)
            trial = linear + forward.basis @ step
            left = rgb.T - sensor.matrix @ model.to_reflectance(trial)
        # As by Levenberg and Marquardt: the damping falls after a step that helped, and
        # rises after one that did not.
        better = (left**2).sum(axis=0) < (missed**2).sum(axis=0)
        linear = np.where(better, trial, linear)
        missed = np.where(better, left, missed)
        damping = np.where(
            better, damping / 10, np.maximum(10 * damping, FIRST_DAMPING)
        )
    return model.to_reflectance(linear).T


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
