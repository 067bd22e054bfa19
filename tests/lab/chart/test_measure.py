"""Answers are checked before they are timed; broken methods have no times."""

import time

import numpy as np
import pytest

from tests.lab.chart.conftest import BATCHES, method_of
from uplift.extras.colour.light_sets import CHART_LIGHTS
from uplift.lab.chart.measure import MAX_CLAIM_RATIO, SLOW_STEP, measure_method
from uplift.lab.chart.results import State
from uplift.lab.method import PreparedMethod, ours
from uplift.lab.runner import named_lights, spectrum_errors


def grey(rgb, wavelengths):
    """A valid answer with a large error."""
    return np.repeat(rgb.mean(axis=1, keepdims=True), len(wavelengths), axis=1)


def nan(rgb, wavelengths):
    return np.where(rgb[:, :1] > 0.5, np.nan, grey(rgb, wavelengths))


def fail(rgb, wavelengths):
    raise ZeroDivisionError("by the last of these")


def lazy(rgb, wavelengths):
    return grey(rgb if len(rgb) < 60 else rgb[:1].repeat(len(rgb), axis=0), wavelengths)


def burn(seconds):
    """Use CPU time."""
    begin = time.process_time()
    while time.process_time() < begin + seconds:
        pass


def unprepared(task):
    raise OSError("libLLVM.so: cannot open")


@pytest.mark.parametrize(
    ("uplift", "fields", "why"),
    [
        (lazy, {}, "64 colours per call give other reflectances than 50, by 0."),
        (nan, {}, "spectra are not finite"),
        (lambda rgb, at: 1.1 + grey(rgb, at), {}, "0 to 1 are claimed"),
        (lambda rgb, at: grey(rgb, at) - 0.2, {}, "0 to 1 are claimed"),
        (grey, {"claimed_error": 0.01}, "0.01 is claimed"),
        (
            lambda rgb, at: grey(rgb, at)[:, :-1],
            {},
            "spectra have shape (1, 80) instead of (1, 81)",
        ),
        (lambda rgb, at: grey(rgb, at).squeeze(), {}, "shape (81,) instead of (1, 81)"),
        (fail, {}, "raises ZeroDivisionError: by the last of these"),
        (
            lambda rgb, at: grey(rgb.astype(float), at),
            {"dtype": "float32"},
            "spectra are float64 instead of float32",
        ),
        (
            None,
            {"prepare": unprepared},
            "cannot be prepared: OSError: libLLVM.so: cannot open",
        ),
    ],
)
def test_broken_answer_is_reported_and_not_timed(small_task, uplift, fields, why):
    row = measure_method(method_of(uplift, **fields), small_task)
    assert row.state == State.BROKEN
    assert why in row.why
    assert row.numbers == {}


def test_answer_is_broken_only_if_far_off_its_claim(small_task):
    miss = measure_method(method_of(grey), small_task).numbers["round_trip_mean"]
    for ratio, state in ((1.01, State.MEASURED), (0.99, State.BROKEN)):
        claimed = method_of(grey, claimed_error=ratio * miss / MAX_CLAIM_RATIO)
        assert measure_method(claimed, small_task).state == state


def test_errors_are_those_of_the_runner(small_task):
    numbers = measure_method(method_of(grey), small_task).numbers
    sensor = small_task.unseen.sensor
    lights = list(named_lights(CHART_LIGHTS).values())
    for prefix, measured in (("", small_task.unseen.queried), ("own_", small_task.own)):
        spectra = grey(sensor.rgb(measured), sensor.wavelengths)
        errors = spectrum_errors(spectra, measured, lights)
        for column, light in enumerate(CHART_LIGHTS):
            assert numbers[f"{prefix}{light}_mean"] == pytest.approx(
                errors.delta_e[:, column].mean()
            )
            assert numbers[f"{prefix}{light}_max"] == pytest.approx(
                errors.delta_e[:, column].max()
            )
        assert numbers[f"{prefix}rms_p99"] == pytest.approx(
            np.quantile(errors.rms, 0.99)
        )
        assert numbers[f"{prefix}lights_mean"] == pytest.approx(errors.delta_e.mean())


def test_each_number_of_colours_is_timed_in_the_type_of_the_method(small_task):
    calls = set()

    def uplift(rgb, wavelengths):
        calls.add((len(rgb), rgb.dtype))
        return grey(rgb, wavelengths)

    numbers = measure_method(method_of(uplift, dtype="float32"), small_task).numbers
    for batch in BATCHES:
        assert (batch, np.dtype("float32")) in calls
        assert (
            numbers[f"ns_{batch}_least"]
            <= numbers[f"ns_{batch}"]
            <= numbers[f"ns_{batch}_most"]
        )
        assert numbers[f"ns_{batch}_colours"] == batch
    assert numbers["time_ns"] == numbers["ns_64"]
    assert {dtype for _, dtype in calls} == {np.dtype("float32")}


def test_slow_methods_process_as_many_colours_as_time_allows(small_task):
    """The share of the time is not predicted from the first colours."""
    count = 0

    def slow(rgb, wavelengths):
        nonlocal count
        count += len(rgb)
        burn(0.02 * len(rgb) if count > 2 * SLOW_STEP else 0)
        return grey(rgb, wavelengths)

    numbers = measure_method(method_of(slow, batch=False), small_task).numbers
    assert SLOW_STEP < numbers["round_trip_colours"] <= 3 * SLOW_STEP
    assert numbers["ns_1_colours"] == 1
    assert 1 <= numbers["ns_64_colours"] < 64


@pytest.mark.parametrize("build", [3.0, None])
def test_set_up_is_charged(small_task, build):
    """Building and loading as stated, and what the first call takes longer."""
    calls = []

    def uplift(rgb, wavelengths):
        if not calls:
            burn(0.05)
        calls.append(1)
        return grey(rgb, wavelengths)

    method = method_of(
        None, lambda task: PreparedMethod(uplift, 8, build_s=build, load_s=2.0)
    )
    numbers = measure_method(method, small_task).numbers
    assert numbers.get("build_s") == build
    assert 2.03 < numbers["load_s"] < 2.5
    assert numbers["setup_s"] == (build or 0) + numbers["load_s"]


def test_reference_sensor_is_the_stated_sensor_at_1_nm(small_task):
    """Spectra that are exact for one sensor are not for another, and the tables of
    cubes come second.
    """
    weights = np.linalg.pinv(ours().matrix)

    def exact(rgb, wavelengths):
        return (
            rgb @ weights.T
            if len(wavelengths) == len(ours().wavelengths)
            else grey(rgb, wavelengths)
        )

    free = {"claimed_range": (-10, 10)}
    numbers = measure_method(
        method_of(exact, reference_sensor=ours, **free), small_task
    ).numbers
    assert numbers["round_trip_max"] < 1e-6
    assert numbers["coarse_round_trip_mean"] > 1
    assert (
        1e-3
        < measure_method(method_of(exact, **free), small_task).numbers[
            "round_trip_mean"
        ]
        < 0.1
    )
