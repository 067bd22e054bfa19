"""Measurement of methods: their answers are checked first, and only correct ones are
timed.
"""

import time
import warnings
from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from uplift.colorimetry import delta_e_rgb, observer
from uplift.common.arrays import Array, Values
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.common.text import pluralise
from uplift.extras.colour.light_sets import CHART_LIGHTS
from uplift.extras.images.processes import ChildError, call_in_child
from uplift.lab.chart.call_times import UpliftRgb, affordable, call_times
from uplift.lab.chart.results import REFERENCE, Chart, MethodResult, State
from uplift.lab.chart.task import ChartTask, Effort
from uplift.lab.method import (
    Description,
    Method,
    NotInstalledError,
    Uplift,
    stopwatch,
)
from uplift.lab.runner import spectrum_errors
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
        f"{effort.longest:g} s, spectra at {wavelengths}; errors of slow "
        "methods are of the colours of "
        f"{effort.seconds_per_error:g} s; {(time.perf_counter() - begin) / 60:.1f} "
        "minutes in all"
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
    except (BrokenError, ChildError) as error:
        state = State.BROKEN
        why = f"{error}; it needs {method.needs}" if method.needs else str(error)
    texts = {field.name: getattr(method, field.name) for field in fields(Description)}
    texts["label"] = method.label or method.title
    return MethodResult(**texts, state=state, why=why, numbers=numbers)


def _numbers(method: Method, task: ChartTask) -> dict[str, float]:
    try:
        prepared = method.prepare(task.unseen)
    except NotInstalledError:
        raise
    except Exception as error:  # code of other packages may raise anything
        raise BrokenError(f"cannot be prepared: {_text(error)}") from error
    effort = task.effort
    checked = CheckedMethod(method, prepared.uplift, effort.seconds_per_error)
    uplift = checked.at(task.unseen.sensor.wavelengths)
    # The first call may compile, which is charged to the set-up.
    first, second = (stopwatch(lambda: uplift(task.colours[:1]))[1] for _ in range(2))
    load = prepared.load_s + max(first - second, 0.0)
    build = {} if prepared.build_s is None else {"build_s": prepared.build_s}
    round_trips = _round_trips(checked, task)
    errors = _errors(checked, task)
    if method.batch:
        _check_batch(uplift, method.dtype, effort)
    return {
        "bytes": prepared.bytes,
        **build,
        "load_s": load,
        "setup_s": sum(build.values()) + load,
        **round_trips,
        **errors,
        **call_times(uplift, method.dtype, effort),
    }


@dataclass(frozen=True, eq=False)
class CheckedMethod:
    """A method that raises no error but `BrokenError`, and ``seconds`` of CPU time for
    the answers of one error.
    """

    method: Method
    uplift: Uplift
    seconds: float

    def at(self, wavelengths: Array) -> UpliftRgb:
        """Return the function of colours (n, 3) alone."""
        dtype = self.method.dtype

        def uplift_rgb(rgb: Array) -> Values:
            try:
                spectra = self.uplift(rgb.astype(dtype, copy=False), wavelengths)
            except Exception as error:  # code of other packages may raise anything
                raise BrokenError(f"raises {_text(error)}") from error
            if spectra.shape != (len(rgb), len(wavelengths)):
                raise BrokenError(
                    f"spectra have shape {spectra.shape} instead of ({len(rgb)}, "
                    f"{len(wavelengths)})"
                )
            if spectra.dtype != dtype:
                raise BrokenError(f"spectra are {spectra.dtype} instead of {dtype}")
            return spectra

        return uplift_rgb

    def spectra(self, rgb: Array, wavelengths: Array) -> Array:
        """Return the spectra (k, N) in float64 of as many of the colours as time
        allows.
        """
        uplift = self.at(wavelengths)
        uplift(rgb[:1])
        step = len(rgb) if self.method.batch else SLOW_STEP
        parts = []
        begin = time.process_time()
        for first in range(0, len(rgb), step):
            parts.append(uplift(rgb[first : first + step]))
            if time.process_time() - begin > self.seconds:
                break
        spectra = np.concatenate(parts).astype(float)
        self._check_range(spectra)
        return spectra

    def _check_range(self, spectra: Array) -> None:
        infinite = ~np.isfinite(spectra).all(axis=1)
        if infinite.any():
            count = infinite.sum()
            raise BrokenError(f"{count} of {len(spectra)} spectra are not finite")
        low, high = self.method.claimed_range
        if spectra.min() < low or spectra.max() > high:
            raise BrokenError(
                f"reflectances from {spectra.min():.4g} to {spectra.max():.4g}, "
                f"{low:g} to {high:g} are claimed"
            )


def _text(error: Exception) -> str:
    return f"{type(error).__name__}: {str(error)[:80]}"


def _round_trips(checked: CheckedMethod, task: ChartTask) -> dict[str, float]:
    """Judge at 1 nm with the stated white and matrix, and with the tables that cubes
    are fitted to.
    """
    method = checked.method
    stated = method.reference_sensor()
    fitted = task.unseen.sensor
    spectra = checked.spectra(task.colours, stated.wavelengths)
    rgb = task.colours[: len(spectra)]
    errors = delta_e_rgb(stated, rgb, stated.rgb(spectra))
    claimed = method.claimed_error
    if claimed is not None and errors.mean() > MAX_CLAIM_RATIO * claimed:
        raise BrokenError(
            f"mean round-trip ΔE00 is {errors.mean():.3g}, {claimed:g} is claimed"
        )
    coarse = checked.at(fitted.wavelengths)(rgb).astype(float)
    return {
        **_summary("round_trip", errors),
        **_summary("coarse_round_trip", delta_e_rgb(fitted, rgb, fitted.rgb(coarse))),
        "round_trip_colours": len(rgb),
    }


def _errors(checked: CheckedMethod, task: ChartTask) -> dict[str, float]:
    """Compare spectra with those of materials that the method does not know, and that
    it knows.
    """
    sensor = task.unseen.sensor
    lights = [observer.light(name) for name in CHART_LIGHTS]
    numbers: dict[str, float] = {}
    for prefix, name, measured in (
        ("", "unseen", task.unseen.queried),
        ("own_", "own", task.own),
    ):
        rgb = np.clip(sensor.rgb(measured), 0, 1)
        spectra = checked.spectra(rgb, sensor.wavelengths)
        queried = measured[: len(spectra)]
        errors = spectrum_errors(spectra, queried, lights)
        for light, delta_e in zip(CHART_LIGHTS, errors.delta_e.T, strict=True):
            numbers |= _summary(f"{prefix}{light}", delta_e)
        numbers |= _summary(f"{prefix}lights", errors.delta_e.mean(axis=1))
        numbers |= _summary(f"{prefix}rms", np.asarray(errors.rms))
        numbers[f"{name}_spectra"] = len(spectra)
    return numbers


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
