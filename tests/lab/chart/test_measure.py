"""Answers are checked before they are timed; broken methods have no times."""

from __future__ import annotations

import time

import numpy as np
import pytest

from tests.lab.chart.conftest import BATCHES
from tests.pages import Page
from uplift.colorimetry.lights import CHART_LIGHTS
from uplift.common.progress import Progress
from uplift.lab.chart.measure import MAX_CLAIM_RATIO, SLOW_STEP, measure_method, measure_methods
from uplift.lab.chart.method import Claims, Method, PreparedMethod, ours
from uplift.lab.chart.methods.mallett2019 import FAMILIES
from uplift.lab.chart.picture import render_chart
from uplift.lab.chart.table import State, all_panels
from uplift.lab.study.held_out import spectrum_errors


def grey(rgb, wavelengths):
    """A valid answer with a large error."""
    return np.repeat(rgb.mean(axis=1, keepdims=True), len(wavelengths), axis=1)


def nan(rgb, wavelengths):
    return np.where(rgb[:, :1] > 0.5, np.nan, grey(rgb, wavelengths))


def fail(rgb, wavelengths):
    raise ZeroDivisionError("by the last of these")


def lazy(rgb, wavelengths):
    return grey(rgb if len(rgb) < 60 else rgb[:1].repeat(len(rgb), axis=0), wavelengths)


BROKEN = {
    "wrong in large batches": (lazy, Claims(), "64 colours per call give other reflectances than 50, by 0."),
    "not finite": (nan, Claims(), "spectra are not finite"),
    "too bright": (lambda rgb, at: 1.1 + grey(rgb, at), Claims(), "0 to 1 are claimed"),
    "negative": (lambda rgb, at: grey(rgb, at) - 0.2, Claims(), "0 to 1 are claimed"),
    "wrong colour": (grey, Claims(round_trip=0.01), "0.01 is claimed"),
    "wrong shape": (
        lambda rgb, at: grey(rgb, at)[:, :-1],
        Claims(),
        "spectra have shape (1, 80) instead of (1, 81)",
    ),
    "no axis of colours": (
        lambda rgb, at: grey(rgb, at).squeeze(),
        Claims(),
        "shape (81,) instead of (1, 81)",
    ),
    "an exception": (fail, Claims(), "raises ZeroDivisionError: by the last of these"),
}


@pytest.mark.parametrize("name", BROKEN)
def test_broken_answer_is_reported_and_not_timed(small_task, greys, method_of, name):
    uplift, claims, why = BROKEN[name]
    row = measure_method(greys, method_of(uplift, claims=claims), small_task)
    assert row.state == State.BROKEN
    assert why in row.why
    assert row.numbers == {}


def test_broken_method_is_listed_and_not_drawn(small_task, greys, method_of):
    (mallett,) = FAMILIES
    broken = method_of(nan)
    chart = measure_methods([(mallett, mallett.methods[0]), (greys, broken)], small_task)
    good, bad = chart.results
    assert (good.state, bad.state) == (State.MEASURED, State.BROKEN)
    assert chart.measured == (good,)
    assert all(bad not in panel.front(chart) and panel.point(bad) is None for panel in all_panels(chart))
    (row,) = Page(render_chart(chart)).table("method", "state", "reason")
    assert [cell.text for cell in row] == [bad.title, "broken", bad.why]


def test_answer_is_broken_only_if_far_off_its_claim(small_task, greys, method_of):
    miss = measure_method(greys, method_of(grey), small_task).numbers["round_trip_mean"]
    for claimed, state in (
        (1.01 * miss / MAX_CLAIM_RATIO, State.MEASURED),
        (0.99 * miss / MAX_CLAIM_RATIO, State.BROKEN),
    ):
        assert measure_method(greys, method_of(grey, claims=Claims(claimed)), small_task).state == state


def test_errors_are_those_of_the_holdout_study(small_task, greys, method_of):
    numbers = measure_method(greys, method_of(grey), small_task).numbers
    for prefix, measured in (("", small_task.unseen), ("own_", small_task.own)):
        errors = spectrum_errors(
            grey(small_task.sensor.rgb(measured), small_task.sensor.wavelengths), measured, CHART_LIGHTS
        )
        for column, light in enumerate(CHART_LIGHTS):
            assert numbers[f"{prefix}{light}_mean"] == pytest.approx(errors.delta_e[:, column].mean())
            assert numbers[f"{prefix}{light}_max"] == pytest.approx(errors.delta_e[:, column].max())
        assert numbers[f"{prefix}rms_p99"] == pytest.approx(np.quantile(errors.rms, 0.99))
        assert numbers[f"{prefix}lights_mean"] == pytest.approx(errors.delta_e.mean())


def test_each_number_of_colours_is_timed_in_the_type_of_the_method(small_task, greys, method_of):
    calls = set()

    def uplift(rgb, wavelengths):
        calls.add((len(rgb), rgb.dtype))
        return grey(rgb, wavelengths)

    numbers = measure_method(greys, method_of(uplift, dtype="float32"), small_task).numbers
    for batch in BATCHES:
        assert (batch, np.dtype("float32")) in calls
        assert numbers[f"ns_{batch}_least"] <= numbers[f"ns_{batch}"] <= numbers[f"ns_{batch}_most"]
        assert numbers[f"ns_{batch}_colours"] == batch
    assert numbers["time_ns"] == numbers["ns_64"]
    assert {dtype for _, dtype in calls} == {np.dtype("float32")}


def test_answers_in_another_type_are_broken(small_task, greys, method_of):
    double = method_of(lambda rgb, at: grey(rgb.astype(float), at), dtype="float32")
    row = measure_method(greys, double, small_task)
    assert (row.state, row.why) == (State.BROKEN, "spectra are float64 instead of float32")


def test_method_without_batches_processes_fewer_colours(small_task, greys, method_of):
    def slow(rgb, wavelengths):
        for _ in range(len(rgb) * 100_000):
            pass
        return grey(rgb, wavelengths)

    numbers = measure_method(greys, method_of(slow, batch=False), small_task).numbers
    assert numbers["ns_1_colours"] == 1
    assert 1 <= numbers["ns_64_colours"] < 64
    assert 3 <= numbers["round_trip_colours"] < len(small_task.rgb)


def test_colours_that_are_slower_than_the_first_end_with_the_time(small_task, greys, method_of):
    """The share of the time is not predicted from the first colours."""
    count = 0

    def slow(rgb, wavelengths):
        nonlocal count
        count += len(rgb)
        end = time.process_time() + (0.02 * len(rgb) if count > 2 * SLOW_STEP else 0)
        while time.process_time() < end:
            pass
        return grey(rgb, wavelengths)

    numbers = measure_method(greys, method_of(slow, batch=False), small_task).numbers
    assert SLOW_STEP < numbers["round_trip_colours"] <= 3 * SLOW_STEP


def test_set_up_is_charged(small_task, greys):
    """Building and loading as stated, and what the first call takes longer."""
    calls = []

    def uplift(rgb, wavelengths):
        if not calls:
            burn(0.05)
        calls.append(1)
        return grey(rgb, wavelengths)

    method = Method("test", "Test", lambda task: PreparedMethod(uplift, 8, build_s=3.0, load_s=2.0))
    numbers = measure_method(greys, method, small_task).numbers
    assert numbers["build_s"] == 3
    assert 2.03 < numbers["load_s"] < 2.5
    assert numbers["setup_s"] == numbers["build_s"] + numbers["load_s"]
    elsewhere = Method("test", "Test", lambda task: PreparedMethod(grey, 8, build_s=None, load_s=2.0))
    numbers = measure_method(greys, elsewhere, small_task).numbers
    assert "build_s" not in numbers
    assert numbers["setup_s"] == numbers["load_s"]


def burn(seconds):
    """Use CPU time."""
    begin = time.process_time()
    while time.process_time() < begin + seconds:
        pass


def test_judge_is_the_stated_sensor_at_1_nm(small_task, greys, method_of):
    """Spectra that are exact for one judge are not for another, and the tables of cubes come second."""
    weights = np.linalg.pinv(ours().matrix)

    def exact(rgb, wavelengths):
        if len(wavelengths) == len(ours().wavelengths):
            return rgb @ weights.T
        return grey(rgb, wavelengths)

    free = Claims(min=-10, max=10)
    numbers = measure_method(greys, method_of(exact, judge=ours, claims=free), small_task).numbers
    assert numbers["round_trip_max"] < 1e-6
    assert numbers["coarse_round_trip_mean"] > 1
    other = measure_method(greys, method_of(exact, claims=free), small_task).numbers
    assert 1e-3 < other["round_trip_mean"] < 0.1


def test_chart_describes_test_set_and_environment(small_task, greys, method_of):
    events = []
    chart = measure_methods([(greys, method_of(grey))] * 2, small_task, events.append)
    assert events == [Progress("methods", 1, 2), Progress("methods", 2, 2)]
    assert "16 random" in chart.facts["colours"]
    assert "12 of 24 entries of macbeth" in chart.facts["spectra"]
    assert "numpy" in chart.facts["versions"]
    assert "1, 64 colours per call" in chart.facts["effort"]


def test_a_method_that_cannot_be_prepared_is_broken(small_task, greys):
    def prepare(task):
        raise OSError("libLLVM.so: cannot open")

    row = measure_method(greys, Method("absent", "Absent", prepare), small_task)
    assert (row.state, row.why) == (State.BROKEN, "cannot be prepared: OSError: libLLVM.so: cannot open")
