"""Measurement of methods: their answers are checked first, and only correct ones are timed."""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Iterable
from itertools import cycle, islice
from typing import Any

import numpy as np
from numpy.typing import NDArray

from uplift.colorimetry.lights import CHART_LIGHTS
from uplift.common.arrays import Array
from uplift.common.processes import ChildError, call_in_child
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.lab.chart.method import (
    Claims,
    Effort,
    Family,
    Method,
    NotInstalledError,
    PreparedMethod,
    Task,
    Uplift,
    round_trip,
    stopwatch,
)
from uplift.lab.chart.table import Chart, MethodResult, State
from uplift.lab.study.held_out import spectrum_errors
from uplift.lab.timing import Spread, environment, time_calls

MIN_RUNS = 3
MAX_LAPS = 15
"""Duration of all runs together, in units of `Effort.lap`, unless `MIN_RUNS` take longer."""
TRIAL = 512
"""Colours from which the duration of the first batch of more than one is estimated."""
INPUTS, INPUT_COLOURS = 64, 1 << 16
"""Different inputs of repeated calls: at most so many, with so many colours in all."""
REFERENCE = 65_536
"""Colours per call of the time by which cubes are recommended."""

Call = Callable[[Any], object]


def call_times(uplift: Call, dtype: str, effort: Effort, *, batch: bool) -> dict[str, float]:
    """Time calls with each number of colours of an effort, after one that warms up."""
    numbers: dict[str, float] = {}
    found, shortened = None, False
    for size in effort.batches:
        if shortened and found is not None:  # as many colours per call as before
            numbers |= _time_numbers(size, *found)
            continue
        if found is not None and (found[1] > 1 or not batch):
            count = _count(size, found[0].median, effort)
        else:
            count = affordable(uplift, dtype, size, effort, batch=batch)
        found, shortened = (_timed(uplift, dtype, count, effort), count), count < size
        numbers |= _time_numbers(size, *found)
    reference = max((size for size in effort.batches if size <= REFERENCE), default=effort.batches[0])
    return numbers | {"time_ns": numbers[f"ns_{reference}"]}


def affordable(uplift: Call, dtype: str, size: int, effort: Effort, *, batch: bool = True) -> int:
    """Return the number of colours, at most ``size``, that a call of `Effort.longest` has, from a call with few."""
    count = min(size, TRIAL) if batch else 1
    rgb = _colours(1, count, dtype)[0]
    uplift(rgb)
    _, cpu = time_calls(lambda: uplift(rgb), 1)
    return _count(size, cpu.median / count, effort)


def _count(size: int, seconds: float, effort: Effort) -> int:
    return max(min(size, int(effort.longest / max(seconds, 1e-12))), 1)


def _timed(uplift: Call, dtype: str, count: int, effort: Effort) -> Spread:
    """CPU seconds per colour of calls with ``count`` colours."""
    inputs = _colours(max(1, min(INPUTS, INPUT_COLOURS // count)), count, dtype)
    _, once = time_calls(lambda: uplift(inputs[0]), 1)
    if once.min < effort.lap * MAX_LAPS:
        _, once = time_calls(lambda: uplift(inputs[0]), 1)
    calls = max(1, min(int(effort.lap / 5 / max(once.min, 1e-9)), 1000))

    def run() -> None:
        for rgb in islice(cycle(inputs), calls):
            uplift(rgb)

    runs = int(MAX_LAPS * effort.lap / max(calls * once.min, 1e-9))
    _, cpu = time_calls(run, min(max(runs, MIN_RUNS), effort.runs))
    return cpu.scaled(1 / (calls * count))


def _colours(inputs: int, count: int, dtype: str) -> NDArray[Any]:
    """Random RGB (inputs, count, 3)."""
    return np.random.default_rng(2).random((inputs, count, 3)).astype(dtype)


def _time_numbers(size: int, seconds: Spread, count: int) -> dict[str, float]:
    ns = seconds.scaled(1e9)
    key = f"ns_{size}"
    return {
        key: ns.median,
        f"{key}_least": ns.min,
        f"{key}_most": ns.max,
        f"{key}_runs": ns.runs,
        f"{key}_colours": count,
    }


MAX_CLAIM_RATIO = 10
"""A method is broken if its mean round-trip error is larger than the claimed one by more than this factor."""
SLOW_STEP = 3
"""Colours of slow methods between two looks at the time."""
SAMPLE, SAMPLE_TOLERANCE = 50, 2e-5
"""Colours of a large batch that are computed again in a small one, and the reflectance that rounding may change."""

UpliftRgb = Callable[[Array], Array]


class BrokenError(Exception):
    """An answer is wrong; the text gives the reason."""


def measure_methods(
    methods: Iterable[tuple[Family, Method]], task: Task, progress: ProgressCallback = ignore_progress
) -> Chart:
    """Measure methods at a task."""
    methods, results, begin, machine = list(methods), [], time.perf_counter(), environment()
    for family, method in methods:
        results.append(measure_method(family, method, task))
        progress(Progress("methods", len(results), len(methods)))
    effort = task.effort
    summary = (
        f"CPU time of all threads, {', '.join(f'{size:,}' for size in effort.batches)} colours per call, spectra at "
        f"{len(task.sensor.wavelengths)} wavelengths; up to {effort.runs} runs; calls longer than {effort.longest:g} s "
        f"take fewer colours; errors of slow methods are of the colours of {effort.seconds_per_error:g} s; "
        f"cubes are built {effort.builds}×, the last build counts; "
        f"{(time.perf_counter() - begin) / 60:.1f} minutes in all"
    )
    return Chart({**machine, **task.facts, "effort": summary}, tuple(results))


def measure_method(family: Family, method: Method, task: Task) -> MethodResult:
    """Measure one method."""
    state, why, numbers = State.MEASURED, "", {}
    try:
        with warnings.catch_warnings():
            # Other packages warn, and so do cubes about the entries that all of them leave out.
            warnings.simplefilter("ignore")
            if method.needs:
                numbers = call_in_child(_numbers, method, task, seconds=task.effort.limit)
            else:
                numbers = _numbers(method, task)
    except NotInstalledError as error:
        state, why = State.MISSING, str(error)
    except BrokenError as error:
        state, why = State.BROKEN, str(error)
    except ChildError as error:
        state, why = State.BROKEN, f"{error}{_advice(method)}"
    return MethodResult(
        method=method.name,
        title=method.title,
        label=method.label or method.title,
        family=family.name,
        source=family.source,
        mode=method.mode,
        dtype=method.dtype,
        build=method.build,
        ask=method.call,
        note=method.note,
        state=state,
        why=why,
        numbers=numbers,
    )


def _numbers(method: Method, task: Task) -> dict[str, float]:
    prepared = _prepared(method, task)
    uplift = _guarded(prepared.uplift, task.sensor.wavelengths, method.dtype)
    numbers: dict[str, float] = {"bytes": prepared.bytes}
    if prepared.build_s is not None:
        numbers["build_s"] = prepared.build_s
    numbers["load_s"] = prepared.load_s + _first_call(uplift, task.rgb[:1])
    numbers["setup_s"] = numbers.get("build_s", 0.0) + numbers["load_s"]
    numbers |= _round_trips(method, prepared, uplift, task) | _errors(method, uplift, task)
    if method.batch:
        _check_batch(uplift, affordable(uplift, method.dtype, min(task.effort.batches[-1], REFERENCE), task.effort))
    return numbers | call_times(uplift, method.dtype, task.effort, batch=method.batch)


def _prepared(method: Method, task: Task) -> PreparedMethod:
    try:
        return method.prepare(task)
    except NotInstalledError:
        raise
    except Exception as error:  # code of other packages may raise anything
        raise BrokenError(f"cannot be prepared: {_text(error)}{_advice(method)}") from error


def _advice(method: Method) -> str:
    return f"; it needs {method.needs}" if method.needs else ""


def _first_call(uplift: UpliftRgb, rgb: Array) -> float:
    """CPU seconds that the first call takes longer than the second."""
    first, second = (stopwatch(lambda: uplift(rgb))[1] for _ in range(2))
    return max(first - second, 0.0)


def _guarded(uplift: Uplift, wavelengths: Array, dtype: str) -> UpliftRgb:
    """Function of colours (n, 3) alone that raises no error but `BrokenError`."""
    width = len(wavelengths)

    def uplift_rgb(rgb: Array) -> Array:
        try:
            spectra = uplift(rgb.astype(dtype, copy=False), wavelengths)
        except Exception as error:  # code of other packages may raise anything
            raise BrokenError(f"raises {_text(error)}") from error
        if spectra.shape != (len(rgb), width):
            raise BrokenError(f"spectra have shape {spectra.shape} instead of ({len(rgb)}, {width})")
        if spectra.dtype != dtype:
            raise BrokenError(f"spectra are {spectra.dtype} instead of {dtype}")
        return spectra

    return uplift_rgb


def _text(error: Exception) -> str:
    return f"{type(error).__name__}: {str(error)[:80]}"


def _round_trips(method: Method, prepared: PreparedMethod, uplift: UpliftRgb, task: Task) -> dict[str, float]:
    """Judge at 1 nm with the stated white and matrix, and with the tables that cubes are fitted to."""
    sensor = method.judge()
    rgb, spectra = _spectra(method, _guarded(prepared.uplift, sensor.wavelengths, method.dtype), task, task.rgb)
    errors = round_trip(sensor, rgb, spectra)
    _check_round_trip(errors, method.claims)
    fitted = round_trip(task.sensor, rgb, uplift(rgb))
    return _summary("round_trip", errors) | _summary("coarse_round_trip", fitted) | {"round_trip_colours": len(rgb)}


def _errors(method: Method, uplift: UpliftRgb, task: Task) -> dict[str, float]:
    numbers: dict[str, float] = {}
    for prefix, name, measured in (("", "unseen", task.unseen), ("own_", "own", task.own)):
        rgb, spectra = _spectra(method, uplift, task, np.clip(task.sensor.rgb(measured), 0, 1))
        errors = spectrum_errors(spectra, measured[: len(rgb)], CHART_LIGHTS)
        values = dict(zip(CHART_LIGHTS, errors.delta_e.T, strict=True))
        values |= {"lights": errors.delta_e.mean(axis=1), "rms": errors.rms}
        for key, array in values.items():
            numbers |= _summary(f"{prefix}{key}", array)
        numbers[f"{name}_spectra"] = len(rgb)
    return numbers


def _spectra(method: Method, uplift: UpliftRgb, task: Task, rgb: Array) -> tuple[Array, Array]:
    """As many of the colours as time allows, (k, 3), and their spectra (k, N) in float64."""
    uplift(rgb[:1])
    step = len(rgb) if method.batch else SLOW_STEP
    parts, begin = [], time.process_time()
    for first in range(0, len(rgb), step):
        parts.append(uplift(rgb[first : first + step]))
        if time.process_time() - begin > task.effort.seconds_per_error:
            break
    spectra = np.concatenate(parts)
    _check_range(spectra, method.claims)
    return rgb[: len(spectra)], spectra.astype(float)


def _check_batch(uplift: UpliftRgb, count: int) -> None:
    """Large batches are timed; check that they give the same spectra as small ones, whose errors are measured."""
    rgb = np.random.default_rng(4).random((count, 3))
    rows = np.linspace(0, count - 1, SAMPLE, dtype=int)
    difference = np.abs(uplift(rgb)[rows] - uplift(rgb[rows])).max()
    if not difference <= SAMPLE_TOLERANCE:
        raise BrokenError(f"{count:,} colours per call give other reflectances than {SAMPLE}, by {difference:.2g}")


def _check_range(spectra: Array, claims: Claims) -> None:
    finite = np.isfinite(spectra).all(axis=1)
    if not finite.all():
        raise BrokenError(f"{(~finite).sum()} of {len(spectra)} spectra are not finite")
    if spectra.min() < claims.min or spectra.max() > claims.max:
        raise BrokenError(
            f"reflectances from {spectra.min():.4g} to {spectra.max():.4g}, "
            f"{claims.min:g} to {claims.max:g} are claimed"
        )


def _check_round_trip(errors: Array, claims: Claims) -> None:
    if claims.round_trip is not None and errors.mean() > MAX_CLAIM_RATIO * claims.round_trip:
        raise BrokenError(f"mean round-trip ΔE00 is {errors.mean():.3g}, {claims.round_trip:g} is claimed")


def _summary(name: str, values: Array) -> dict[str, float]:
    return {
        f"{name}_mean": float(values.mean()),
        f"{name}_p99": float(np.quantile(values, 0.99)),
        f"{name}_max": float(values.max()),
    }
