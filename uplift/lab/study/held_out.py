"""Errors on held-out measurements: cubes and a plain baseline that know half of an
atlas predict the other half, compared with methods that know the library.
"""

import warnings
from collections.abc import Mapping, Sequence
from typing import Any

from uplift.atlas import Atlas
from uplift.colorimetry import observer
from uplift.colorimetry.illuminants import ERROR_ILLUMINANT
from uplift.common.errors import AtlasError, UpliftWarning
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.extras.colour.light_sets import HELD_OUT_LIGHTS
from uplift.extras.report.measures import check_calibration
from uplift.lab.look_alikes import families_like
from uplift.lab.methods import burns2019, local_linear, metamer_mean
from uplift.lab.methods.colour_maps import MAPS
from uplift.lab.methods.cubes import cube
from uplift.lab.runner import (
    Errors,
    Prepare,
    Task,
    divided,
    named_lights,
    pooled_errors,
    spectra_of,
    whole,
    within,
)

MIN_ENTRIES = 8
"""Fewest entries within the RGB space of an atlas that is split."""
HALF = "half the atlas"
NO_ATLAS = "without an atlas"
SIGMOID = "sigmoid"
LOCAL_LINEAR = "local-linear regression"
"""Names of cubes, and of a baseline that knows the same half of the atlas."""
LIBRARY_REGRESSION = "local-linear regression of the library"
METAMER_MEAN = "mean of metamers"
BURNS = "Burns 2019"
"""Names of methods that know the library, or nothing."""
LIBRARY_METHODS: Mapping[str, Prepare] = {
    **MAPS,
    LIBRARY_REGRESSION: local_linear.prepare_on_library,
    METAMER_MEAN: metamer_mean.prepare_of_library,
    BURNS: burns2019.prepare,
}


def holdout(
    atlas: Atlas,
    splits: int = 3,
    progress: ProgressCallback = ignore_progress,
    **options: Any,
) -> list[dict[str, Any]]:
    """Divide an atlas in random halves, and predict each half by a cube of the other
    one, built with options of `uplift.build`; return the mean errors by method.

    The prior, and the methods that know the library, do not know the families that
    contain spectra of the atlas or look-alikes of many of them. Methods that do not
    know the atlas predict all of it.
    """
    sensor = observer.sensor()
    entries = within(atlas, sensor)
    if len(entries) < MIN_ENTRIES:
        problem = (
            f"a split needs at least {MIN_ENTRIES} entries within {sensor.space}, got "
            f"{len(entries)}"
        )
        raise AtlasError(problem, code="too-few-entries", hint="use a larger atlas")
    left_out = families_like(spectra_of(atlas, sensor))
    halves = list(divided(entries, left_out, sensor, seeds=splits))
    all_entries = [whole(entries, left_out, sensor)]
    plan: dict[str, tuple[Prepare, Sequence[Task]]] = {
        HALF: (cube(atlas=True, **options), halves),
        NO_ATLAS: (cube(**options), all_entries),
        SIGMOID: (cube(**{**options, "model": "sigmoid"}), all_entries),
        LOCAL_LINEAR: (local_linear.prepare, halves),
    }
    if len(all_entries[0].library):
        for method, prepare in LIBRARY_METHODS.items():
            plan[method] = prepare, all_entries
    lights = named_lights()
    records: list[dict[str, Any]] = []
    for number, (method, (prepare, tasks)) in enumerate(plan.items(), 1):
        with warnings.catch_warnings(action="ignore", category=UpliftWarning):
            errors = pooled_errors(prepare, tasks, list(lights.values()))
        colours = len(tasks[0].queried)
        records.append({"cube": method, "colours": colours, **_means(errors)})
        if method == HALF:
            records[0]["standard_error"] = _calibration(errors)
        progress(Progress("methods", number, len(plan)))
    return records


def _means(errors: Errors) -> dict[str, float | None]:
    """Return the mean rms, None of methods without spectra, and the mean ΔE00."""
    rms = None if errors.rms is None else float(errors.rms.mean())
    delta_e = errors.delta_e.mean(axis=0).tolist()
    return {"rms": rms, **dict(zip(HELD_OUT_LIGHTS, delta_e, strict=True))}


def _calibration(errors: Errors) -> dict[str, float] | None:
    """Compare the errors with the stated ones, under the light of the latter."""
    if errors.stated is None:
        return None
    light = HELD_OUT_LIGHTS.index(ERROR_ILLUMINANT)
    actual = errors.delta_e[:, light]
    calibration = check_calibration(actual, *errors.stated[:, light].T)
    return None if calibration is None else calibration.to_json()
