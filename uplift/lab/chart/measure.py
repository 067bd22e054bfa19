"""Measurement of methods: their answers are checked first, and only correct ones are
timed.
"""

import time
import warnings
from collections.abc import Sequence
from dataclasses import fields, replace

import numpy as np

from uplift.colorimetry import Light, delta_e_rgb, observer
from uplift.common.arrays import Array, Values
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.common.text import pluralise
from uplift.extras.colour.light_sets import CHART_LIGHTS
from uplift.extras.images.processes import ChildError, call_in_child
from uplift.lab.chart.call_times import BrokenError, UpliftRgb, call_times
from uplift.lab.chart.results import Chart, MethodResult, State
from uplift.lab.chart.task import ChartTask
from uplift.lab.method import (
    Description,
    Method,
    NotInstalledError,
    PreparedMethod,
)
from uplift.lab.timing import environment, run_call

MAX_CLAIM_RATIO = 10
"""A method is broken if its mean round-trip error is larger than the claimed one by
more than this factor.
"""


def measure_methods(
    methods: Sequence[Method],
    task: ChartTask,
    progress: ProgressCallback = ignore_progress,
) -> Chart:
    """Measure methods at a task."""
    results = []
    begin = time.perf_counter()
    machine = environment()
    effort = task.effort
    for method in methods:
        results.append(measure_method(method, task))
        progress(Progress("methods", len(results), len(methods)))
    wavelengths = pluralise(len(task.unseen.sensor.wavelengths), "wavelength")
    summary = (
        f"CPU time of all threads; up to {effort.runs} runs of calls of at most "
        f"{effort.longest:g} s, spectra at {wavelengths}; errors of slow methods are "
        f"of the colours of {effort.seconds_per_error:g} s; "
        f"{(time.perf_counter() - begin) / 60:.1f} minutes in all"
    )
    return Chart({**machine, **task.facts, "effort": summary}, tuple(results))


def measure_method(method: Method, task: ChartTask) -> MethodResult:
    """Measure one method."""
    state = State.MEASURED
    why = ""
    numbers = {}
    try:
        # Other packages warn, and cubes do about entries that all of them leave out.
        with warnings.catch_warnings(action="ignore"):
            if method.needs:
                limit = task.effort.limit
                numbers = call_in_child(_numbers, method, task, seconds=limit)
            else:
                numbers = _numbers(method, task)
    except NotInstalledError as error:
        state = State.MISSING
        why = str(error)
    except Exception as error:  # code of other packages may raise anything
        state = State.BROKEN
        why = f"raises {type(error).__name__}: {str(error)[:80]}"
        if isinstance(error, BrokenError | ChildError):
            why = str(error)
        if method.needs:
            why += f"; it needs {method.needs}"
    texts = {field.name: getattr(method, field.name) for field in fields(Description)}
    texts["label"] = method.label or method.title
    return MethodResult(**texts, state=state, why=why, numbers=numbers)


def _numbers(method: Method, task: ChartTask) -> dict[str, float]:
    prepared = method.prepare(task.unseen)
    effort = task.effort

    wavelengths = task.unseen.sensor.wavelengths

    def uplift(rgb: Values) -> Values:
        return prepared.uplift(rgb, wavelengths)

    # The first call may compile, which is charged to the set-up.
    rgb = task.colours[:1].astype(method.dtype)
    first, second = (run_call(lambda: uplift(rgb)) for _ in range(2))
    load = prepared.load_s + max(first.cpu - second.cpu, 0.0)
    build = {} if prepared.build_s is None else {"build_s": prepared.build_s}
    count = len(task.colours)
    if not method.batch:
        count = _affordable(uplift, task.colours, effort.seconds_per_error)
    checked = _checked(method, prepared)
    return {
        "bytes": prepared.bytes,
        **build,
        "load_s": load,
        "setup_s": sum(build.values()) + load,
        **_round_trips(method, checked, task, count),
        **_errors(checked, task, count),
        **call_times(uplift, method.dtype, effort),
    }


def _affordable(uplift: UpliftRgb, rgb: Array, seconds: float) -> int:
    """Count the colours, from the first, that take some CPU seconds one by one."""
    begin = time.process_time()
    for count in range(1, len(rgb)):
        uplift(rgb[count - 1 : count])
        if time.process_time() - begin > seconds:
            return count
    return len(rgb)


def _checked(method: Method, prepared: PreparedMethod) -> PreparedMethod:
    """Return a method that raises `BrokenError` for invalid answers."""
    dtype = method.dtype
    low, high = method.claimed_range

    def uplift(rgb: Values, wavelengths: Array) -> Values:
        spectra = prepared.uplift(rgb.astype(dtype), wavelengths)
        shape = (len(rgb), len(wavelengths))
        if spectra.shape != shape:
            raise BrokenError(f"spectra have shape {spectra.shape} instead of {shape}")
        if spectra.dtype != dtype:
            raise BrokenError(f"spectra are {spectra.dtype} instead of {dtype}")
        infinite = ~np.isfinite(spectra).all(axis=1)
        if infinite.any():
            count = infinite.sum()
            raise BrokenError(f"{count} of {len(rgb)} spectra are not finite")
        if spectra.min() < low or spectra.max() > high:
            raise BrokenError(
                f"reflectances from {spectra.min():.4g} to {spectra.max():.4g}, "
                f"{low:g} to {high:g} are claimed"
            )
        return spectra.astype(float)

    return replace(prepared, uplift=uplift, stated=None)


def _round_trips(
    method: Method, checked: PreparedMethod, task: ChartTask, count: int
) -> dict[str, float]:
    """Judge at 1 nm with the stated white and matrix, and with the tables that cubes
    are fitted to.
    """
    rgb = task.colours[:count]
    stated = method.reference_sensor()
    errors, coarse = (
        delta_e_rgb(sensor, rgb, sensor.rgb(checked.uplift(rgb, sensor.wavelengths)))
        for sensor in (stated, task.unseen.sensor)
    )
    claimed = method.claimed_error
    if claimed is not None and errors.mean() > MAX_CLAIM_RATIO * claimed:
        raise BrokenError(
            f"mean round-trip ΔE00 is {errors.mean():.3g}, {claimed:g} is claimed"
        )
    return {
        **_summary("round_trip", errors),
        **_summary("coarse_round_trip", coarse),
        "round_trip_colours": len(rgb),
    }


def _errors(checked: PreparedMethod, task: ChartTask, count: int) -> dict[str, float]:
    """Compare spectra with those of materials that the method does not know, and that
    it knows.
    """
    lights: list[Light] = [observer.light(name) for name in CHART_LIGHTS]
    own = replace(task.unseen, queried=task.own)
    numbers: dict[str, float] = {}
    for name, prefix, materials in ("unseen", "", task.unseen), ("own", "own_", own):
        queried = replace(materials, queried=materials.queried[:count])
        errors = checked.errors(queried, lights)
        for light, delta_e in zip(CHART_LIGHTS, errors.delta_e.T, strict=True):
            numbers |= _summary(f"{prefix}{light}", delta_e)
        numbers |= _summary(f"{prefix}lights", errors.delta_e.mean(axis=1))
        numbers |= _summary(f"{prefix}rms", np.asarray(errors.rms))
        numbers[f"{name}_spectra"] = len(errors.delta_e)
    return numbers


def _summary(name: str, values: Array) -> dict[str, float]:
    return {
        f"{name}_mean": float(values.mean()),
        f"{name}_p99": float(np.quantile(values, 0.99)),
        f"{name}_max": float(values.max()),
    }
