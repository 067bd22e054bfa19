"""Methods measured: the answers first, and the time of those alone whose answers are not broken."""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Iterable

import numpy as np

from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.colorimetry.lights import CHART_LIGHTS
from uplift.common.arrays import Array
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.lab.chart.method import Claims, Family, Method, NotInstalledError, Uplift
from uplift.lab.chart.table import Chart, MethodResult, State
from uplift.lab.chart.task import Task
from uplift.lab.chart.timing import batch_times, single_times
from uplift.lab.study.held_out import spectrum_errors
from uplift.lab.timing import environment

FAR = 10
"""A mean round trip so many times what is claimed is no slip, it is broken."""
FIRST = 3
"""Colours that tell how long a slow method takes."""

FEW, SAME = 50, 1e-5
"""Of many colours those that are asked once more, and the reflectance by which rounding may change them."""

Ask = Callable[[Array], Array]


class BrokenError(Exception):
    """An answer that is none; the text says why."""


def measure(
    methods: Iterable[tuple[Family, Method]], task: Task, progress: ProgressCallback = ignore_progress
) -> Chart:
    """Every method at the task, in order. ``progress`` hears how many of how many are done."""
    methods, rows, begin, where = list(methods), [], time.perf_counter(), environment()
    for family, method in methods:
        rows.append(measure_one(family, method, task))
        progress(Progress("methods", len(rows), len(methods)))
    effort = task.effort
    told = (
        f"CPU time of all threads, {effort.batch:,} colours at once, spectra at {len(task.sensor.wavelengths)} "
        f"wavelengths; up to {effort.runs} runs; cubes are built {effort.builds}×, the last one counts; "
        f"{(time.perf_counter() - begin) / 60:.1f} minutes in all"
    )
    return Chart({**where, **task.facts, "effort": told}, tuple(rows))


def measure_one(family: Family, method: Method, task: Task) -> MethodResult:
    """A method's row; what is broken or missing has no times."""
    state, why, numbers = State.MEASURED, "", {}
    try:
        with warnings.catch_warnings():
            warnings.simplefilter(
                "ignore"
            )  # what others' code has to say, and entries that all cubes leave out
            numbers = _numbers(method, task)
    except NotInstalledError as error:
        state, why = State.MISSING, str(error)
    except BrokenError as error:
        state, why = State.BROKEN, str(error)
    return MethodResult(
        method=method.name,
        title=method.title,
        label=method.label or method.title,
        family=family.name,
        source=family.source,
        mode=method.mode,
        build=method.build,
        ask=method.ask,
        note=method.note,
        state=state,
        why=why,
        numbers=numbers,
    )


def _numbers(method: Method, task: Task) -> dict[str, float]:
    """Raises `BrokenError`, before anything is timed."""
    ready = method.prepare(task)
    ask = _guarded(ready.uplift, task.sensor.wavelengths)
    numbers: dict[str, float] = {"bytes": ready.bytes}
    if ready.seconds is not None:
        numbers["build_s"] = ready.seconds
    numbers |= _errors(method, ask, task)
    if method.batch:
        _check_long(ask, task.effort.batch)
    single = single_times(ask, task.effort)
    batch = batch_times(ask, task.effort) if method.batch else {}
    return numbers | batch | single | {"time_ns": batch.get("batch_ns", single["single_ns"])}


def _guarded(uplift: Uplift, wavelengths: Array) -> Ask:
    """A function of colours (n, 3) alone, that raises nothing but `BrokenError`."""

    def ask(rgb: Array) -> Array:
        try:
            return uplift(rgb, wavelengths)
        except Exception as error:  # whatever another's code raises is its answer
            raise BrokenError(f"raises {type(error).__name__}: {str(error)[:80]}") from error

    return ask


def _errors(method: Method, ask: Ask, task: Task) -> dict[str, float]:
    rgb, answered = _answered(method, ask, task, task.rgb)
    apart = delta_e_rgb(task.sensor, rgb, task.sensor.rgb(answered))
    _check_round_trip(apart, method.claims)
    numbers = _summary("round_trip", apart) | {"round_trip_colours": len(rgb)}
    for prefix, name, measured in (("", "unseen", task.unseen), ("own_", "own", task.own)):
        asked, answered = _answered(method, ask, task, np.clip(task.sensor.rgb(measured), 0, 1))
        errors = spectrum_errors(answered, measured[: len(asked)], CHART_LIGHTS)
        parts = dict(zip(CHART_LIGHTS, errors.delta_e.T, strict=True))
        parts |= {"lights": errors.delta_e.mean(axis=1), "rms": errors.rms}
        for key, values in parts.items():
            numbers |= _summary(f"{prefix}{key}", values)
        numbers[f"{name}_spectra"] = len(asked)
    return numbers


def _answered(method: Method, ask: Ask, task: Task, rgb: Array) -> tuple[Array, Array]:
    """The colours (k, 3) that there was time for, and their spectra (k, N)."""
    ask(rgb[:1])
    begin = time.process_time()
    first = ask(rgb[:FIRST])
    each = max(time.process_time() - begin, 1e-9) / FIRST
    count = len(rgb) if method.batch else min(len(rgb), int(task.effort.answering / each))
    answered = np.concatenate([first, ask(rgb[FIRST:count])]) if count > FIRST else first
    _check_range(answered, len(task.sensor.wavelengths), method.claims)
    return rgb[: len(answered)], answered


def _check_long(ask: Ask, count: int) -> None:
    """Many colours at once, which is what is timed, may go another way than the few that errors are of."""
    rgb = np.random.default_rng(4).random((count, 3))
    rows = np.linspace(0, count - 1, FEW, dtype=int)
    apart = np.abs(ask(rgb)[rows] - ask(rgb[rows])).max()
    if not apart <= SAME:
        raise BrokenError(f"answers {count:,} colours otherwise than {FEW}, by {apart:.2g} in reflectance")


def _check_range(answered: Array, width: int, claims: Claims) -> None:
    if answered.shape[1:] != (width,):
        raise BrokenError(f"answers of shape {answered.shape[1:]} in place of ({width},)")
    finite = np.isfinite(answered).all(axis=1)
    if not finite.all():
        raise BrokenError(f"{(~finite).sum()} of {len(answered)} spectra are not numbers")
    if answered.min() < claims.least or answered.max() > claims.most:
        raise BrokenError(
            f"reflectances from {answered.min():.4g} to {answered.max():.4g}, "
            f"{claims.least:g} to {claims.most:g} are claimed"
        )


def _check_round_trip(apart: Array, claims: Claims) -> None:
    if claims.round_trip is not None and apart.mean() > FAR * claims.round_trip:
        raise BrokenError(f"round trips miss by ΔE00 {apart.mean():.3g}, {claims.round_trip:g} is claimed")


def _summary(name: str, values: Array) -> dict[str, float]:
    numbers = (values.mean(), np.quantile(values, 0.99), values.max())
    return {
        f"{name}_{kind}": float(number) for kind, number in zip(("mean", "p99", "max"), numbers, strict=True)
    }
