"""Test sets, and methods against reference implementations."""

from importlib import import_module

import numpy as np
import pytest
from colour.recovery import RGB_to_sd_Mallett2019, RGB_to_sd_Smits1999
from numpy.testing import assert_allclose

from tests.helpers import raises
from tests.parts import LLVM, need
from uplift.atlas import Atlas, Entry, merge, on_grid, read_atlas
from uplift.colorimetry.sensor import in_unit_cube
from uplift.common.errors import AtlasError, OptionError
from uplift.extras.images.processes import call_in_child
from uplift.lab.chart import mitsuba3
from uplift.lab.chart.cubes import CubeOptions, built_cube
from uplift.lab.chart.method import NotInstalledError, edges, make_task
from uplift.lab.chart.selection import METHODS, select_methods
from uplift.lab.study.look_alikes import families_like


def shipped(repository, *names):
    return {name: read_atlas(repository / "atlases" / f"{name}.txt") for name in names}


def test_every_second_entry_builds_and_the_others_test(repository):
    # The first atlas has an odd number of entries; counting starts again with each
    # atlas.
    atlases = shipped(repository, "vs", "macbeth")
    task = make_task(atlases, 16)
    vs, macbeth = atlases.values()
    assert task.kept.names == vs.names[::2] + macbeth.names[::2]
    rows = set(map(tuple, task.own.round(12)))
    assert not rows & set(map(tuple, task.unseen.round(12)))
    spectra = on_grid(merge(atlases.values()), task.sensor.wavelengths)
    inside = in_unit_cube(task.sensor.rgb(spectra))
    assert len(task.own) + len(task.unseen) == inside.sum()


def test_edges_contain_every_corner_and_grey_once():
    rgb = edges()
    assert len(np.unique(rgb, axis=0)) == len(rgb)
    is_extreme = np.isin(rgb, (0, 1))
    is_grey = np.ptp(rgb, axis=1) == 0
    assert (is_extreme.any(axis=1) | is_grey).all()
    assert is_extreme.all(axis=1).sum() == 8
    assert is_grey.sum() == 9


def test_too_few_colours_or_entries_are_an_error(repository):
    with raises(OptionError, "option"):
        make_task(shipped(repository, "macbeth"), 15)
    at = np.arange(380.0, 781.0, 10.0)
    two = Atlas(
        tuple(Entry(name, at, np.full(len(at), 0.5)) for name in ("one", "other"))
    )
    with raises(AtlasError, "too-few-entries"):
        make_task({"two": two}, 16)


def prepared(name, task):
    (method,) = select_methods((name,))
    return method.prepare(task)


@pytest.fixture(scope="module")
def colours():
    return np.concatenate(
        [np.random.default_rng(4).random((20, 3)), np.eye(3), [[0, 0, 0], [1, 1, 1]]]
    )


def test_methods_are_selected_by_pattern():
    assert select_methods() == list(METHODS)
    assert [method.method for method in select_methods(("mallett2019", "sm*9"))] == [
        "mallett2019",
        "smits1999",
    ]
    with raises(OptionError, "option") as caught:
        select_methods(("mallett2019", "malet"))
    assert "'malet'" in caught.value.problem


def test_smits_and_mallett_match_colour_science(small_task, colours):
    at = small_task.sensor.wavelengths
    for name, theirs in (
        ("smits1999", RGB_to_sd_Smits1999),
        ("mallett2019", RGB_to_sd_Mallett2019),
    ):
        expected = [
            np.interp(at, sd.wavelengths, sd.values) for sd in map(theirs, colours)
        ]
        assert_allclose(
            prepared(name, small_task).uplift(colours, at), expected, atol=1e-12
        )


def test_jakob_fit_has_the_colour(small_task):
    rgb = np.array([[0.5, 0.4, 0.3]])
    found = prepared("jakob2019-direct", small_task).uplift(
        rgb, small_task.sensor.wavelengths
    )
    assert_allclose(small_task.sensor.rgb(found), rgb, atol=2e-3)


@pytest.mark.parametrize("name", ["local-linear", "metamer-mean", "burns2019"])
def test_methods_without_a_table_have_the_colour(small_task, name):
    sensor = small_task.sensor
    rgb = np.array([[0.5, 0.4, 0.3], [0.2, 0.3, 0.35]])
    found = prepared(name, small_task).uplift(rgb, sensor.wavelengths)
    assert_allclose(sensor.rgb(found), rgb, atol=1e-6)


def test_missing_mitsuba_is_not_installed(small_task, monkeypatch):
    monkeypatch.setattr(mitsuba3, "find_spec", lambda name: None)
    for name in ("mitsuba3-table", "mitsuba3-llvm", "jakob2019-table64"):
        with pytest.raises(NotInstalledError, match="Mitsuba 3: pip install"):
            prepared(name, small_task)


@pytest.mark.parametrize(
    "name", ["mallett2019", "smits1999", "moments9-32-spectra", "sigmoid-32-moments"]
)
def test_both_types_give_the_same_spectra(small_task, colours, name):
    at = small_task.sensor.wavelengths
    double = prepared(name, small_task)
    single = prepared(f"{name}-float32", small_task)
    found = single.uplift(colours.astype(np.float32), at)
    assert found.dtype == np.float32
    assert_allclose(found, double.uplift(colours, at), atol=2e-6)


def vectorised_and_table(task, colours):
    """Reflectances by Mitsuba's vectorised variant and by its table, for one colour and
    for many.
    """
    compiled, table = (
        prepared(name, task).uplift for name in ("mitsuba3-llvm", "mitsuba3-table")
    )
    at = task.sensor.wavelengths
    some = (colours[:1], colours)
    drjit = import_module("drjit")
    threads = drjit.thread_count()
    found = [compiled(each, at) for each in some]
    assert drjit.thread_count() == threads
    return found, [table(each, at) for each in some]


def test_vectorised_mitsuba_gives_the_reflectances_of_its_table(small_task, colours):
    need(LLVM)
    found, expected = call_in_child(
        vectorised_and_table, small_task, colours, seconds=120
    )
    for compiled, table in zip(found, expected, strict=True):
        assert_allclose(compiled, table, atol=1e-4)


def test_prior_of_cubes_does_not_know_the_unseen_materials(small_task):
    cube, _, _ = built_cube(small_task, CubeOptions("moments", 3, 8, atlas=False))
    unknown = families_like(small_task.unseen)
    assert unknown
    assert tuple(cube.data.provenance["options"]["leave_out"]) == unknown
