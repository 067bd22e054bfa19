"""Tasks of measured materials, and the rows of methods at them."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from benchmarks.materials import materials
from uplift.atlas import read_atlas
from uplift.colorimetry import in_unit_cube, observer
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.fit import families_with
from uplift.lab.look_alikes import families_like
from uplift.lab.method import PreparedMethod
from uplift.lab.runner import (
    Errors,
    divided,
    folds,
    join,
    measure,
    named_lights,
    whole,
    within,
)

LIGHTS = named_lights(("A", "FL11"))


@pytest.fixture(scope="module")
def entries(sensor):
    return within(read_atlas("tcs"), sensor)


def grey(rgb, wavelengths):
    return np.repeat(rgb.mean(axis=1, keepdims=True), len(wavelengths), axis=1)


def prepare(task):
    """Prepare greys that state an error of 5 and a bound of 10."""
    return PreparedMethod(
        grey, stated=lambda rgb, light: np.full((len(rgb), 2), [5.0, 10.0])
    )


@pytest.mark.parametrize("parts", [2, 4])
def test_every_entry_is_queried_once_a_seed(parts):
    pairs = list(folds(7, parts, seeds=3))
    assert len(pairs) == 3 * parts
    for known, queried in pairs:
        assert sorted([*known, *queried]) == list(range(7))
    for first in range(0, len(pairs), parts):
        queried = [rows for _, rows in pairs[first : first + parts]]
        assert sorted(np.concatenate(queried)) == list(range(7))


def test_tasks_divide_the_entries_within_the_space(entries, sensor):
    assert len(entries) < len(read_atlas("tcs"))
    all_entries = whole(entries, ("tcs",), sensor)
    assert len(all_entries.known_spectra) == 0
    assert in_unit_cube(all_entries.rgb).all()
    for task in divided(entries, ("tcs",), sensor, seeds=1):
        both = np.concatenate([task.known_spectra, task.queried])
        assert_allclose(np.sort(both, axis=0), np.sort(all_entries.queried, axis=0))


def test_rows_pool_the_errors_of_all_tasks(entries, sensor):
    tasks = list(divided(entries, (), sensor, seeds=2))
    rows = list(measure({"grey": prepare}, tasks, LIGHTS, set="tcs"))
    assert [row["light"] for row in rows] == ["A", "FL11", "all", "all"]
    assert [row["measure"] for row in rows] == 3 * ["ΔE00"] + ["rms"]
    task = whole(entries, (), sensor)
    actual = delta_e_spectra(
        LIGHTS["A"], grey(task.rgb, sensor.wavelengths), task.queried
    )
    first = rows[0]
    assert (first["set"], first["method"]) == ("tcs", "grey")
    assert first["n"] == 2 * len(entries)
    assert first["mean"] == pytest.approx(actual.mean())
    assert first["max"] == pytest.approx(actual.max())
    assert first["within_error"] == pytest.approx((actual <= 5).mean())
    assert first["within_bound"] == pytest.approx((actual <= 10).mean())
    assert rows[2]["mean"] == pytest.approx((rows[0]["mean"] + rows[1]["mean"]) / 2)


def test_what_one_part_lacks_is_left_out():
    full = Errors(np.ones((2, 1)), np.ones(2), np.ones((2, 1, 2)))
    joined = join([full, Errors(np.zeros((3, 1)), np.zeros(3))])
    assert joined.delta_e.shape == (5, 1)
    assert joined.rms.mean() == pytest.approx(0.4)
    assert joined.stated is None


def test_families_with_many_look_alikes_are_not_known():
    for name in ("macbeth", "babelcolor"):
        assert families_like(materials(name).measured) == ("checker", "rawtoaces")
    for name in ("pmc", "tcs", "vs", "cie2017", "rawtoaces"):
        spectra = materials(name).measured
        assert families_like(spectra) == families_with(spectra) == (name,)
    assert families_like(np.zeros((0, len(observer.grid())))) == ()
