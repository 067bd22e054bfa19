"""Measurement of methods: their answers are checked first, and only correct ones are
timed.
"""

import time
import warnings
from collections.abc import Sequence
from dataclasses import fields, replace

import numpy as np

from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.common.arrays import Array, Values
from uplift.common.progress import Progress, ProgressCallback, ignore_progress
from uplift.common.text import pluralise
from uplift.extras.colour.light_sets import CHART_LIGHTS
from uplift.extras.processes import ChildError, call_in_child
from uplift.extras.timing import environment, run_call
from uplift.lab.chart.call_times import BrokenError, affordable, call_times
from uplift.lab.chart.results import SUMMARY, Chart, MethodResult, State
from uplift.lab.chart.task import ChartTask
from uplift.lab.description import Description
from uplift.lab.method import Method, NotInstalledError, PreparedMethod
from uplift.lab.runner import named_lights

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
        f"CPU time of all threads; {effort.runs} runs of calls of at most "
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
    texts["family"] = method.family or method.title.partition(",")[0]
    return MethodResult(**texts, state=state, why=why, numbers=numbers)


def _numbers(method: Method, task: ChartTask) -> dict[str, float]:
    prepared = method.prepare(task.unseen)
    effort = task.effort
    dtype = method.dtype

    def uplift(rgb: Values) -> Values:
        return prepared.uplift(rgb, task.unseen.sensor.wavelengths)

    # The first call may compile, which is charged to the set-up.
    rgb = task.colours[:1].astype(dtype)
    first, second = (run_call(lambda: uplift(rgb)) for _ in range(2))
    load = prepared.load_s + max(first.cpu - second.cpu, 0.0)
    build = {} if prepared.build_s is None else {"build_s": prepared.build_s}
    count = affordable(uplift, dtype, len(task.colours), effort.seconds_per_error)
    errors = _errors(method, _checked(method, prepared), task, count)
    numbers = {"bytes": prepared.bytes, **build, "load_s": load}
    numbers["setup_s"] = sum(build.values()) + load
    for name, values in errors.items():
        for kind, summarise in SUMMARY.items():
            numbers[f"{name}_{kind}"] = float(summarise(values))
    return {
        **numbers,
        "round_trip_colours": len(errors["round_trip"]),
        "unseen_spectra": len(errors["rms"]),
        "own_spectra": len(errors["own_rms"]),
        **call_times(uplift, dtype, effort),
    }


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


def _errors(
    method: Method, checked: PreparedMethod, task: ChartTask, count: int
) -> dict[str, Array]:
    """Return errors of the first colours and materials by name.

    Round trips are judged at 1 nm with the stated white and matrix, and with the tables
    that cubes are fitted to, spectra by materials that the method does not know, and
    that it knows.
    """
    rgb = task.colours[:count]
    errors: dict[str, Array] = {}
    sensors = {"": method.reference_sensor(), "coarse_": task.unseen.sensor}
    for prefix, sensor in sensors.items():
        answers = sensor.rgb(checked.uplift(rgb, sensor.wavelengths))
        errors[f"{prefix}round_trip"] = delta_e_rgb(sensor, rgb, answers)
    claimed = method.claimed_error
    mean = errors["round_trip"].mean()
    if claimed is not None and mean > MAX_CLAIM_RATIO * claimed:
        raise BrokenError(f"mean round-trip ΔE00 is {mean:.3g}, {claimed:g} is claimed")
    lights = named_lights(CHART_LIGHTS)
    own = np.random.default_rng(1).permutation(task.unseen.known_spectra)
    for prefix, measured in {"": task.unseen.queried, "own_": own}.items():
        queried = replace(task.unseen, queried=measured[:count])
        found = checked.errors(queried, list(lights.values()))
        for light, delta_e in zip(lights, found.delta_e.T, strict=True):
            errors[prefix + light] = delta_e
        errors[f"{prefix}lights"] = found.delta_e.mean(axis=1)
        errors[f"{prefix}rms"] = np.asarray(found.rms)
    return errors
