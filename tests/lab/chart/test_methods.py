"""Published methods agree with reference implementations; cubes cover all options."""

from __future__ import annotations

import sys

import numpy as np
import pytest
from colour.recovery import RGB_to_sd_Mallett2019, RGB_to_sd_Smits1999, XYZ_to_sd_Otsu2018

from tests.helpers import raises
from uplift.colorimetry import observer
from uplift.common.errors import OptionError
from uplift.lab.chart import methods
from uplift.lab.chart.measure import measure_method
from uplift.lab.chart.method import Family
from uplift.lab.chart.methods import FAMILIES, select_methods
from uplift.lab.chart.methods.macadam1935 import boxes
from uplift.lab.chart.table import State
from uplift.lab.chart.task import edges
from uplift.lookup import MODES


def prepared(name, task):
    ((_, method),) = select_methods((name,))
    return method.prepare(task)


@pytest.fixture(scope="module")
def colours():
    return np.concatenate([np.random.default_rng(4).random((20, 3)), np.eye(3), [[0, 0, 0], [1, 1, 1]]])


def test_names_are_unique_and_selections_are_small():
    names = [method.name for _, method in select_methods(("*",))]
    assert len(set(names)) == len(names) > 400
    usual, quick = select_methods(), select_methods(quick=True)
    assert 80 < len(usual) < 150
    assert 8 <= len(quick) <= 12
    published = {family.name for family, method in usual if not method.build}
    assert published == {
        "Jakob 2019", "MacAdam 1935", "Mallett 2019", "Meng 2015", "Mitsuba 3", "Otsu 2018", "Smits 1999",
    }  # fmt: skip
    assert len({family.colour for family in FAMILIES}) == len(FAMILIES)


def test_cubes_cover_every_model_size_mode_and_type():
    names = {method.name for _, method in select_methods(("moments*", "sigmoid*"))}
    models = ("sigmoid", *(f"moments{count}" for count in (3, 5, 9, 13, 17)))
    for model in models:
        for dim in (8, 16, 32, 64):
            for atlas in ("", "-atlas"):
                for mode in MODES:
                    assert {f"{model}-{dim}{atlas}-{mode}", f"{model}-{dim}{atlas}-{mode}-float32"} <= names


def test_methods_are_selected_by_pattern():
    assert [method.name for _, method in select_methods(("mallett2019", "sm*"))] == [
        "mallett2019",
        "smits1999",
    ]
    with raises(OptionError, "unknown-method") as caught:
        select_methods(("mallett2019", "malet"))
    assert "'malet'" in caught.value.problem
    assert "'mallett2019'" in caught.value.hint


def test_new_module_adds_a_method(tmp_path, monkeypatch):
    (tmp_path / "test2026.py").write_text(
        "from uplift.lab.chart.method import Family\nFAMILIES = (Family('Test 2026', 'a test', '#000000', ()),)\n"
    )
    monkeypatch.setattr(methods, "__path__", [*methods.__path__, str(tmp_path)])
    names = [family.name for family in methods.load_families()]
    monkeypatch.delitem(sys.modules, f"{methods.__name__}.test2026")
    assert set(names) - {family.name for family in FAMILIES} == {"Test 2026"}


def test_smits_and_mallett_match_colour_science(small_task, colours):
    at = small_task.sensor.wavelengths
    for name, theirs in (("smits1999", RGB_to_sd_Smits1999), ("mallett2019", RGB_to_sd_Mallett2019)):
        expected = [np.interp(at, sd.wavelengths, sd.values) for sd in map(theirs, colours)]
        np.testing.assert_allclose(prepared(name, small_task).uplift(colours, at), expected, atol=1e-12)


@pytest.mark.filterwarnings("ignore::colour.utilities.ColourRuntimeWarning")
def test_otsu_matches_colour_science(small_task, colours):
    cmfs, light = observer.aligned(small_task.sensor, 380, 730, 10)
    sd = XYZ_to_sd_Otsu2018(small_task.sensor.xyz(colours[0]), cmfs, light)
    found = prepared("otsu2018", small_task).uplift(colours[:1], sd.wavelengths)
    np.testing.assert_allclose(found[0], sd.values, atol=1e-12)


def test_box_spectra_have_one_height_two_edges_and_the_colour(small_task):
    sensor, rgb = small_task.sensor, np.concatenate([np.random.default_rng(5).random((300, 3)), edges()])
    found = boxes(sensor)(rgb, sensor.wavelengths)
    missed = np.abs(sensor.rgb(found) - rgb).max(axis=1)
    assert (missed < 1e-6).mean() > 0.99
    assert missed.max() < 0.05
    height = found.max(axis=1, keepdims=True)
    between = (found > 1e-9) & (found < height - 1e-9)
    assert between.sum(axis=1).max() <= 2
    assert (found[(rgb == 0).all(axis=1)] == 0).all()
    np.testing.assert_allclose(found[(rgb == 1).all(axis=1)], 1, atol=1e-6)


def test_jakob_fit_has_the_colour(small_task):
    rgb = np.array([[0.5, 0.4, 0.3]])
    found = prepared("jakob2019-direct", small_task).uplift(rgb, small_task.sensor.wavelengths)
    np.testing.assert_allclose(small_task.sensor.rgb(found), rgb, atol=2e-3)


def test_mitsuba_is_measured_or_reported_as_missing(small_task, monkeypatch):
    (found,) = select_methods(("mitsuba3-table",))
    row = measure_method(*found, small_task)
    assert row.state in (State.MEASURED, State.MISSING)
    if row.state == State.MEASURED:
        assert row.numbers["bytes"] > 9e6
    monkeypatch.setitem(sys.modules, "mitsuba", None)
    row = measure_method(*found, small_task)
    assert (row.state, row.why) == (
        State.MISSING,
        "Mitsuba is not installed: pip install 'spectral-uplift[peers]'",
    )


def test_families_have_a_source():
    assert all(isinstance(family, Family) and family.source for family in FAMILIES)
