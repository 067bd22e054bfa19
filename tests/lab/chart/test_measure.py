"""Answers are checked before they are timed; broken methods have no times."""

import time

import numpy as np
import pytest
from numpy.testing import assert_allclose

from tests.lab.chart.conftest import method_of
from tests.lab.conftest import grey
from uplift.extras.colour.light_sets import CHART_LIGHTS
from uplift.lab.chart.measure import MAX_CLAIM_RATIO, measure_method
from uplift.lab.chart.results import State
from uplift.lab.method import PreparedMethod, ours
from uplift.lab.runner import named_lights, spectrum_errors


def nan(rgb, wavelengths):
    return np.where(rgb[:, :1] > 0.5, np.nan, grey(rgb, wavelengths))


def fail(rgb, wavelengths):
    raise ZeroDivisionError("by the last of these")


def lazy(rgb, wavelengths):
    return grey(rgb if len(rgb) != 64 else rgb[:1].repeat(64, axis=0), wavelengths)


def burn(seconds):
    """Use CPU time."""
    begin = time.process_time()
    while time.process_time() < begin + seconds:
        pass


@pytest.mark.parametrize(
    ("uplift", "fields", "why"),
    [
        (lazy, {}, "64 colours per call give other reflectances than 50, by 0."),
        (nan, {}, "spectra are not finite"),
        (lambda rgb, at: 1.1 + grey(rgb, at), {}, "0 to 1 are claimed"),
        (grey, {"claimed_error": 0.01}, "0.01 is claimed"),
        (lambda rgb, at: grey(rgb, at[1:]), {}, "spectra have shape ("),
        (fail, {}, "raises ZeroDivisionError: by the last of these"),
        (
            lambda rgb, at: grey(rgb.astype(float), at),
            {"dtype": "float32"},
            "spectra are float64 instead of float32",
        ),
    ],
)
def test_broken_answer_is_reported_and_not_timed(small_task, uplift, fields, why):
    row = measure_method(method_of(uplift, **fields), small_task)
    assert row.state == State.BROKEN
    assert why in row.why
    assert row.numbers == {}


def test_errors_are_those_of_the_runner(small_task):
    """A method is broken only if it is far off its claim."""
    numbers = measure_method(method_of(grey), small_task).numbers
    claim = 1.01 * numbers["round_trip_mean"] / MAX_CLAIM_RATIO
    claimed = method_of(grey, claimed_error=claim)
    assert measure_method(claimed, small_task).state == State.MEASURED
    unseen = small_task.unseen
    sensor = unseen.sensor
    lights = named_lights(CHART_LIGHTS)
    for prefix, measured in (("", unseen.queried), ("own_", unseen.known_spectra)):
        spectra = grey(sensor.rgb(measured), sensor.wavelengths)
        errors = spectrum_errors(spectra, measured, list(lights.values()))
        of_lights = [numbers[f"{prefix}{light}_mean"] for light in lights]
        assert_allclose(of_lights, errors.delta_e.mean(axis=0))
        assert_allclose(numbers[f"{prefix}lights_mean"], errors.delta_e.mean())
        assert_allclose(numbers[f"{prefix}rms_p99"], np.quantile(errors.rms, 0.99))


@pytest.mark.parametrize(
    ("call", "colour", "is_whole"), [(0, 0.01, False), (0.004, 0, True)]
)
def test_calls_have_as_many_colours_as_time_allows(small_task, call, colour, is_whole):
    """Seconds of a call and of each of its colours."""

    def slow(rgb, wavelengths):
        burn(call + colour * len(rgb))
        return grey(rgb, wavelengths)

    numbers = measure_method(method_of(slow), small_task).numbers
    count = numbers["round_trip_colours"]
    assert numbers["unseen_spectra"] == min(count, len(small_task.unseen.queried))
    assert (1 <= count <= 5) != is_whole
    assert numbers["ns_1_colours"] == 1
    assert numbers["ns_64_least"] <= numbers["ns_64"] <= numbers["ns_64_most"]
    assert (numbers["ns_64_colours"] == 64) == is_whole


def test_set_up_is_charged(small_task):
    """Building and loading as stated, and what the first call takes longer."""
    calls = []

    def uplift(rgb, wavelengths):
        if not calls:
            burn(0.05)
        calls.append(1)
        return grey(rgb, wavelengths)

    prepared = PreparedMethod(uplift, 8, build_s=3.0, load_s=2.0)
    numbers = measure_method(method_of(None, lambda task: prepared), small_task).numbers
    assert numbers["build_s"] == 3.0
    assert 2.03 < numbers["load_s"] < 2.5
    assert numbers["setup_s"] == 3.0 + numbers["load_s"]


def test_reference_sensor_is_the_stated_sensor_at_1_nm(small_task):
    """Spectra that are exact for one sensor are not for another, and the tables of
    cubes come second.
    """
    weights = np.linalg.pinv(ours().matrix)

    def exact(rgb, wavelengths):
        is_fine = len(wavelengths) == len(ours().wavelengths)
        return rgb @ weights.T if is_fine else grey(rgb, wavelengths)

    free = {"claimed_range": (-10, 10)}
    method = method_of(exact, reference_sensor=ours, **free)
    numbers = measure_method(method, small_task).numbers
    assert numbers["round_trip_max"] < 1e-6
    assert numbers["coarse_round_trip_mean"] > 1
    numbers = measure_method(method_of(exact, **free), small_task).numbers
    assert 1e-3 < numbers["round_trip_mean"] < 0.1
