"""Errors on held-out measurements: cubes and a plain baseline that know half of an
atlas predict the other half, compared with methods that know the library.
"""

import warnings
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from uplift.atlas import Atlas, resample
from uplift.colorimetry import delta_e_spectra, in_unit_cube, observer
from uplift.common.arrays import Array, Indices
from uplift.common.errors import AtlasError, UpliftWarning
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.extras.colour.light_sets import HELD_OUT_LIGHTS
from uplift.extras.report.fidelity import Answers, compare_spectra
from uplift.extras.report.measures import check_calibration
from uplift.lab.study.local_linear import local_linear
from uplift.lab.study.look_alikes import families_like
from uplift.lab.study.rivals import library_spectra, rival_errors
from uplift.lookup import Cube
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

    ``errors``: errors by the name of the cube or of the baseline. ``colours``: ΔE00 (n,
    L) under `HELD_OUT_LIGHTS` of methods that know the library instead, by name.
    ``actual`` (n,): ΔE00 of the cube with half the atlas, under its reference
    illuminant. ``predicted``, ``bound`` (n,): standard errors and error bounds that
    this cube predicts, if it has any.
    """

    errors: dict[str, Answers]
    colours: dict[str, Array]
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

    By default the prior, and the methods that know the library, do not know the
    families that contain spectra of the atlas or look-alikes of many of them.
    """
    total = 2 + 2 * splits
    unknown = families_like(resample(atlas, observer.grid()).values)
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
        colours = _library_errors(
            others[NO_ATLAS], measured[inside], settings.leave_out
        )
        results: list[HoldoutSplit] = []
        for kept, other in halves_both_ways(inside, splits):
            cube = build(Atlas(tuple(atlas.entries[row] for row in kept)), **options)
            cubes = {HALF: cube, **others}
            rows = np.searchsorted(inside, other)
            of_others = {name: errors[rows] for name, errors in colours.items()}
            results.append(_evaluate(cubes, measured[kept], measured[other], of_others))
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


def _library_errors(
    cube: Cube, measured: Array, leave_out: Collection[str]
) -> dict[str, Array]:
    """ΔE00 (n, L), by method, of methods that know the library without families; none
    without all of them.
    """
    known = library_spectra(leave_out)
    if not len(known):
        return {}
    lights = [observer.light(name) for name in HELD_OUT_LIGHTS]
    return rival_errors(cube.data, known, measured, lights)


def _evaluate(
    cubes: dict[str, Cube], known: Array, measured: Array, colours: dict[str, Array]
) -> HoldoutSplit:
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
    return HoldoutSplit(
        errors, colours, actual, cube.standard_error(rgb), cube.error_bound(rgb)
    )


def spectrum_errors(
    predicted: Array, measured: Array, lights: Sequence[str] = HELD_OUT_LIGHTS
) -> Answers:
    """Compare predicted with measured reflectances (n, N)."""
    return compare_spectra(predicted, measured, map(observer.light, lights))


def split_records(splits: Sequence[HoldoutSplit]) -> list[dict[str, Any]]:
    """Return mean errors over the splits by method, and the first's calibration.

    Methods that know the library have no rms.
    """
    first = splits[0]
    means: dict[str, list[float | None]] = {}
    for method in first.errors:
        of_splits = [split.errors[method].means() for split in splits]
        means[method] = np.mean(of_splits, axis=0).tolist()
    for method in first.colours:
        of_splits = [split.colours[method].mean(axis=0) for split in splits]
        means[method] = [None, *np.mean(of_splits, axis=0).tolist()]
    records: list[dict[str, Any]] = []
    for method, values in means.items():
        errors = dict(zip(("rms", *HELD_OUT_LIGHTS), values, strict=True))
        records.append({"cube": method, "colours": len(first.actual), **errors})
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
