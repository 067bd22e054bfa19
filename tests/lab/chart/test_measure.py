"""Answers are checked before they are timed, and what is broken has no time."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.colorimetry.lights import CHART_LIGHTS
from uplift.lab.chart.measure import FAR, measure, measure_one
from uplift.lab.chart.method import Claims, Method, NotInstalledError
from uplift.lab.chart.methods.mallett2019 import FAMILIES
from uplift.lab.chart.page import page
from uplift.lab.chart.panels import PANELS
from uplift.lab.chart.table import State
from uplift.lab.study.held_out import spectrum_errors
from uplift.viz.markup import Markup


def grey(rgb, wavelengths):
    """An honest answer, though hardly a good one."""
    return np.repeat(rgb.mean(axis=1, keepdims=True), len(wavelengths), axis=1)


def nan(rgb, wavelengths):
    return np.where(rgb[:, :1] > 0.5, np.nan, grey(rgb, wavelengths))


def fail(rgb, wavelengths):
    raise ZeroDivisionError("by the last of these")


def lazy(rgb, wavelengths):
    return grey(rgb if len(rgb) < 60 else rgb[:1].repeat(len(rgb), axis=0), wavelengths)


BROKEN = {
    "lazy with many": (lazy, Claims(), "answers 64 colours otherwise than 50, by 0."),
    "not numbers": (nan, Claims(), "spectra are not numbers"),
    "too bright": (lambda rgb, at: 1.1 + grey(rgb, at), Claims(), "0 to 1 are claimed"),
    "below nothing": (lambda rgb, at: grey(rgb, at) - 0.2, Claims(), "0 to 1 are claimed"),
    "another colour": (grey, Claims(round_trip=0.01), "0.01 is claimed"),
    "another shape": (lambda rgb, at: grey(rgb, at)[:, :-1], Claims(), "answers of shape (80,)"),
    "an exception": (fail, Claims(), "raises ZeroDivisionError: by the last of these"),
}


@pytest.mark.parametrize("name", BROKEN)
def test_a_broken_answer_is_flagged_and_not_timed(small_task, greys, method_of, name):
    uplift, claims, why = BROKEN[name]
    row = measure_one(greys, method_of(uplift, claims=claims), small_task)
    assert row.state == State.BROKEN
    assert why in row.why
    assert row.numbers == {}


def test_a_broken_method_is_listed_and_not_drawn_as_fast(small_task, greys, method_of):
    (mallett,) = FAMILIES
    broken = method_of(nan)
    chart = measure([(mallett, mallett.methods[0]), (greys, broken)], small_task)
    good, bad = chart.rows
    assert (good.state, bad.state) == (State.MEASURED, State.BROKEN)
    assert chart.measured == (good,)
    assert all(bad not in panel.front(chart) and panel.point(bad) is None for panel in PANELS)
    assert f'<td class="bad">broken</td><td>{bad.why}</td>' in page(chart, Markup(""))


def test_the_same_answer_is_no_error_where_less_is_claimed(small_task, greys, method_of):
    miss = measure_one(greys, method_of(grey), small_task).numbers["round_trip_mean"]
    for claimed, state in ((1.01 * miss / FAR, State.MEASURED), (0.99 * miss / FAR, State.BROKEN)):
        assert measure_one(greys, method_of(grey, claims=Claims(claimed)), small_task).state == state


def test_errors_are_those_of_the_study_of_halves(small_task, greys, method_of):
    numbers = measure_one(greys, method_of(grey), small_task).numbers
    for prefix, measured in (("", small_task.unseen), ("own_", small_task.own)):
        errors = spectrum_errors(
            grey(small_task.sensor.rgb(measured), small_task.sensor.wavelengths), measured, CHART_LIGHTS
        )
        for column, light in enumerate(CHART_LIGHTS):
            assert numbers[f"{prefix}{light}_mean"] == pytest.approx(errors.delta_e[:, column].mean())
            assert numbers[f"{prefix}{light}_max"] == pytest.approx(errors.delta_e[:, column].max())
        assert numbers[f"{prefix}rms_p99"] == pytest.approx(np.quantile(errors.rms, 0.99))
        assert numbers[f"{prefix}lights_mean"] == pytest.approx(errors.delta_e.mean())


def test_many_at_once_and_one_a_call_are_timed_apart(small_task, greys, method_of):
    asked = []

    def uplift(rgb, wavelengths):
        asked.append(len(rgb))
        return grey(rgb, wavelengths)

    numbers = measure_one(greys, method_of(uplift), small_task).numbers
    assert {1, small_task.effort.batch} <= set(asked)
    assert numbers["time_ns"] == numbers["batch_ns"]
    assert numbers["batch_ns_least"] <= numbers["batch_ns"] <= numbers["batch_ns_most"]
    assert numbers["batch_colours"] == small_task.effort.batch


def test_a_method_of_one_colour_a_call_is_timed_so_and_asked_for_less(small_task, greys, method_of):
    def slow(rgb, wavelengths):
        for _ in range(len(rgb) * 200_000):
            pass
        return grey(rgb, wavelengths)

    numbers = measure_one(greys, method_of(slow, batch=False), small_task).numbers
    assert "batch_ns" not in numbers
    assert numbers["time_ns"] == numbers["single_ns"]
    assert 3 <= numbers["round_trip_colours"] < len(small_task.rgb)


def test_what_is_not_installed_says_so(small_task, greys):
    def prepare(task):
        raise NotInstalledError("it is not installed: pip install it")

    row = measure_one(greys, Method("absent", "Absent", prepare), small_task)
    assert (row.state, row.why, row.numbers) == (State.MISSING, "it is not installed: pip install it", {})


def test_the_chart_says_what_was_asked_where_and_how(small_task, greys, method_of):
    heard = []
    chart = measure(
        [(greys, method_of(grey))] * 2, small_task, lambda done, total: heard.append((done, total))
    )
    assert heard == [(1, 2), (2, 2)]
    assert "16 random" in chart.facts["colours"]
    assert "12 of 24 entries of macbeth" in chart.facts["spectra"]
    assert "numpy" in chart.facts["versions"]
    assert "64 colours at once" in chart.facts["effort"]
