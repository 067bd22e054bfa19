"""Errors on held-out measurements: cubes and a plain baseline that know half of an
atlas predict the other half, compared with methods that know the library.
"""

import warnings
from collections.abc import Mapping
from functools import partial
from typing import Any

from uplift.atlas.atlas import Atlas
from uplift.colorimetry import observer
from uplift.colorimetry.illuminants import ERROR_ILLUMINANT
from uplift.common.errors import AtlasError, UpliftWarning
from uplift.common.progress import ProgressCallback, ignore_progress, reported
from uplift.extras.colour.light_sets import HELD_OUT_LIGHTS
from uplift.lab.look_alikes import families_like
from uplift.lab.methods import burns2019, local_linear, metamer_mean
from uplift.lab.methods.colour_maps import MAPS
from uplift.lab.methods.cubes import cube
from uplift.lab.runner import (
    LIBRARY,
    Prepare,
    Task,
    divided,
    named_lights,
    pooled_errors,
    spectra_of,
    within,
)

MIN_ENTRIES = 8
"""Fewest entries within the RGB space of an atlas that is split."""
HALF = "half the atlas"
LOCAL_LINEAR = "local-linear regression"
"""Names of a cube, and of a baseline that knows the same half of the atlas."""
NO_ATLAS = "without an atlas"
SIGMOID = "sigmoid"
LIBRARY_REGRESSION = "local-linear regression of the library"
METAMER_MEAN = "mean of metamers"
LIBRARY_METHODS: Mapping[str, Prepare] = {
    **MAPS,
    LIBRARY_REGRESSION: partial(local_linear.prepare, known=LIBRARY),
    METAMER_MEAN: partial(metamer_mean.prepare, known=LIBRARY),
    "Burns 2019": burns2019.prepare,
}
"""Methods that know the library, as the prior does, or nothing."""


def holdout(
    atlas: Atlas,
    progress: ProgressCallback = ignore_progress,
    *,
    dim: int = 32,
    coefficients: int = 9,
) -> list[dict[str, Any]]:
    """Divide an atlas in random halves, and predict each half by a cube of the other
    one, in linear sRGB under D65; return the mean errors by method.

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
    halves = list(divided(entries, left_out, sensor))
    all_entries = [Task(sensor, Atlas(), spectra_of(entries, sensor), left_out)]
    of_size = partial(cube, dim=dim, coefficients=coefficients)
    methods: dict[str, Prepare] = {
        HALF: of_size(atlas=True),
        NO_ATLAS: of_size(),
        SIGMOID: of_size(model="sigmoid"),
        LOCAL_LINEAR: local_linear.prepare,
    }
    if len(all_entries[0].library):
        methods |= LIBRARY_METHODS
    lights = list(named_lights().values())
    records: list[dict[str, Any]] = []
    for method in reported(list(methods), "methods", progress):
        tasks = halves if method in (HALF, LOCAL_LINEAR) else all_entries
        with warnings.catch_warnings(action="ignore", category=UpliftWarning):
            errors = pooled_errors(methods[method], tasks, lights)
        rms = None if errors.rms is None else float(errors.rms.mean())
        delta_e = errors.delta_e.mean(axis=0).tolist()
        means = {"rms": rms, **dict(zip(HELD_OUT_LIGHTS, delta_e, strict=True))}
        records.append({"cube": method, "colours": len(tasks[0].queried), **means})
        if method == HALF:
            calibration = errors.calibration(HELD_OUT_LIGHTS.index(ERROR_ILLUMINANT))
            records[0]["standard_error"] = calibration or None
    return records
