"""Measurement of methods: their answers are checked first, and only correct ones are
timed.
"""

import time
import warnings
from collections.abc import Sequence
from dataclasses import fields

import numpy as np

from uplift.colorimetry import delta_e_rgb
from uplift.common.arrays import Array, Values
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.common.text import pluralise
from uplift.extras.colour.light_sets import CHART_LIGHTS
from uplift.extras.images.processes import ChildError, call_in_child
from uplift.lab.chart.call_times import UpliftRgb, affordable, call_times
from uplift.lab.chart.method import (
    Description,
    Effort,
    Method,
    NotInstalledError,
    PreparedMethod,
    Task,
    stopwatch,
)
from uplift.lab.chart.results import REFERENCE, Chart, MethodResult, State
from uplift.lab.study.held_out import spectrum_errors
from uplift.lab.timing import environment

MAX_CLAIM_RATIO = 10
"""A method is broken if its mean round-trip error is larger than the claimed one by
more than this factor.
"""
SLOW_STEP = 3
"""Colours of slow methods between two looks at the time."""
SAMPLE = 50
"""Colours of a large batch that are computed again in a small one."""
SAMPLE_TOLERANCE = 2e-5
"""Reflectance that rounding may change."""


class BrokenError(Exception):
    """An answer is wrong; the text gives the reason."""


def measure_methods(
    methods: Sequence[Method], task: Task, progress: ProgressCallback = ignore_progress
) -> Chart:
    """Measure methods at a task."""
    results = []
    begin = time.perf_counter()
    machine = environment()
    effort = task.effort
    for method in methods:
        results.append(measure_method(method, task))
        progress(Progress("methods", len(results), len(methods)))
    summary = (
        f"CPU time of all threads; up to {effort.runs} runs of calls of at most "
        f"{effort.longest:g} s, spectra at "
        f"{pluralise(len(task.sensor.wavelengths), 'wavelength')}; errors of slow "
        "methods are of the colours of "
        f"{effort.seconds_per_error:g} s; {(time.perf_counter() - begin) / 60:.1f} "
        "minutes in all"
    )
    return Chart({**machine, **task.facts, "effort": summary}, tuple(results))


def measure_method(method: Method, task: Task) -> MethodResult:
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
    except (BrokenError, ChildError) as error:
        state = State.BROKEN
        why = f"{error}; it needs {method.needs}" if method.needs else str(error)
    texts = {field.name: getattr(method, field.name) for field in fields(Description)}
    return MethodResult(
        **texts | {"label": method.label or method.title},
        state=state,
        why=why,
        numbers=numbers,
    )


def _numbers(method: Method, task: Task) -> dict[str, float]:
    try:
        prepared = method.prepare(task)
    except NotInstalledError:
        raise
    except Exception as error:  # code of other packages may raise anything
        raise BrokenError(f"cannot be prepared: {_text(error)}") from error
    uplift = _guarded(method, prepared, task.sensor.wavelengths)
    # The first call may compile, which is charged to the set-up.
    first, second = (stopwatch(lambda: uplift(task.rgb[:1]))[1] for _ in range(2))
    load = prepared.load_s + max(first - second, 0.0)
    build = {} if prepared.build_s is None else {"build_s": prepared.build_s}
    round_trips = _round_trips(method, prepared, uplift, task)
    errors = _errors(method, uplift, task)
    if method.batch:
        _check_batch(uplift, method.dtype, task.effort)
    return {
        "bytes": prepared.bytes,
        **build,
        "load_s": load,
        "setup_s": sum(build.values()) + load,
        **round_trips,
        **errors,
        **call_times(uplift, method.dtype, task.effort),
    }


def _guarded(method: Method, prepared: PreparedMethod, wavelengths: Array) -> UpliftRgb:
    """Function of colours (n, 3) alone that raises no error but `BrokenError`."""

    def uplift_rgb(rgb: Array) -> Values:
        try:
            spectra = prepared.uplift(rgb.astype(method.dtype, copy=False), wavelengths)
        except Exception as error:  # code of other packages may raise anything
            raise BrokenError(f"raises {_text(error)}") from error
        if spectra.shape != (len(rgb), len(wavelengths)):
            raise BrokenError(
                f"spectra have shape {spectra.shape} instead of ({len(rgb)}, "
                f"{len(wavelengths)})"
            )
        if spectra.dtype != method.dtype:
            raise BrokenError(f"spectra are {spectra.dtype} instead of {method.dtype}")
        return spectra

    return uplift_rgb


def _text(error: Exception) -> str:
    return f"{type(error).__name__}: {str(error)[:80]}"


def _round_trips(
    method: Method, prepared: PreparedMethod, uplift: UpliftRgb, task: Task
) -> dict[str, float]:
    """Judge at 1 nm with the stated white and matrix, and with the tables that cubes
    are fitted to.
    """
    sensor = method.reference_sensor()
    fine = _guarded(method, prepared, sensor.wavelengths)
    rgb, spectra = _spectra(method, fine, task, task.rgb)
    errors = delta_e_rgb(sensor, rgb, sensor.rgb(spectra))
    claimed = method.claimed_error
    if claimed is not None and errors.mean() > MAX_CLAIM_RATIO * claimed:
        raise BrokenError(
            f"mean round-trip ΔE00 is {errors.mean():.3g}, {claimed:g} is claimed"
        )
    fitted = delta_e_rgb(task.sensor, rgb, task.sensor.rgb(uplift(rgb).astype(float)))
    return {
        **_summary("round_trip", errors),
        **_summary("coarse_round_trip", fitted),
        "round_trip_colours": len(rgb),
    }


def _errors(method: Method, uplift: UpliftRgb, task: Task) -> dict[str, float]:
    numbers: dict[str, float] = {}
    for prefix, name, measured in (
        ("", "unseen", task.unseen),
        ("own_", "own", task.own),
    ):
        colours = np.clip(task.sensor.rgb(measured), 0, 1)
        rgb, spectra = _spectra(method, uplift, task, colours)
        errors = spectrum_errors(spectra, measured[: len(rgb)], CHART_LIGHTS)
        values = dict(zip(CHART_LIGHTS, errors.delta_e.T, strict=True))
        values |= {"lights": errors.delta_e.mean(axis=1), "rms": errors.rms}
        for key, array in values.items():
            numbers |= _summary(f"{prefix}{key}", array)
        numbers[f"{name}_spectra"] = len(rgb)
    return numbers


def _spectra(
    method: Method, uplift: UpliftRgb, task: Task, rgb: Array
) -> tuple[Array, Array]:
    """As many of the colours as time allows, (k, 3), and their spectra (k, N) in
    float64.
    """
    uplift(rgb[:1])
    step = len(rgb) if method.batch else SLOW_STEP
    parts = []
    begin = time.process_time()
    for first in range(0, len(rgb), step):
        parts.append(uplift(rgb[first : first + step]))
        if time.process_time() - begin > task.effort.seconds_per_error:
            break
    spectra = np.concatenate(parts)
    finite = np.isfinite(spectra).all(axis=1)
    low, high = method.claimed_range
    if not finite.all():
        raise BrokenError(f"{(~finite).sum()} of {len(spectra)} spectra are not finite")
    if spectra.min() < low or spectra.max() > high:
        raise BrokenError(
            f"reflectances from {spectra.min():.4g} to {spectra.max():.4g}, {low:g} to "
            f"{high:g} are claimed"
        )
    return rgb[: len(spectra)], spectra.astype(float)


def _check_batch(uplift: UpliftRgb, dtype: str, effort: Effort) -> None:
    """Check that large batches, which are timed, give the spectra of small ones."""
    size = min(effort.batches[-1], REFERENCE)
    count = affordable(uplift, dtype, size, effort.longest)
    rgb = np.random.default_rng(4).random((count, 3))
    rows = np.linspace(0, count - 1, SAMPLE, dtype=int)
    difference = np.abs(uplift(rgb)[rows] - uplift(rgb[rows])).max()
    if not difference <= SAMPLE_TOLERANCE:
        raise BrokenError(
            f"{pluralise(count, 'colour')} per call give other reflectances than "
            f"{SAMPLE}, by {difference:.2g}"
        )


def _summary(name: str, values: Array) -> dict[str, float]:
    return {
        f"{name}_mean": float(values.mean()),
        f"{name}_p99": float(np.quantile(values, 0.99)),
        f"{name}_max": float(values.max()),
    }
