"""Tasks of measured materials, and the rows of methods at them."""

import numpy as np
import pytest

from tests.lab.conftest import grey
from uplift.atlas import read_atlas
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
    spectra_of,
    within,
)

LIGHTS = named_lights(("A", "FL11"))


def prepare(task):
    """Prepare greys that state an error of 5 and a bound of 10."""
    return PreparedMethod(
        grey, stated=lambda rgb, light: np.full((len(rgb), 2), [5.0, 10.0])
    )


@pytest.mark.parametrize("parts", [2, 4])
def test_every_entry_is_queried_once_a_seed_and_not_known_then(parts):
    pairs = list(folds(7, parts, seeds=3))
    for known, queried in pairs:
        assert sorted([*known, *queried]) == list(range(7))
    queried = np.concatenate([rows for _, rows in pairs])
    assert sorted(queried) == sorted(3 * list(range(7)))


def test_rows_pool_the_errors_of_all_tasks(sensor):
    """Greys do not depend on the known half, so that the means are those of the set."""
    entries = within(read_atlas("tcs"), sensor)
    assert len(entries) < len(read_atlas("tcs"))
    tasks = list(divided(entries, ("tcs",), sensor, seeds=2))
    assert len(tasks[0].known_spectra) + len(tasks[0].queried) == len(entries)
    rows = list(measure({"grey": prepare}, tasks, LIGHTS, set="tcs"))
    assert [row["light"] for row in rows] == ["A", "FL11", "all", "all"]
    assert [row["measure"] for row in rows] == 3 * ["ΔE00"] + ["rms"]
    spectra = spectra_of(entries, sensor)
    answers = grey(np.clip(sensor.rgb(spectra), 0, 1), sensor.wavelengths)
    actual = delta_e_spectra(LIGHTS["A"], answers, spectra)
    row = rows[0]
    assert (row["set"], row["method"], row["n"]) == ("tcs", "grey", 2 * len(entries))
    assert row["mean"] == pytest.approx(actual.mean())
    assert row["max"] == pytest.approx(actual.max())
    assert row["within_error"] == pytest.approx((actual <= 5).mean())
    assert row["within_bound"] == pytest.approx((actual <= 10).mean())
    assert rows[2]["mean"] == pytest.approx((row["mean"] + rows[1]["mean"]) / 2)


def test_what_one_part_lacks_is_left_out():
    full = Errors(np.ones((2, 1)), np.ones(2), np.ones((2, 1, 2)))
    joined = join([full, Errors(np.zeros((3, 1)), np.zeros(3))])
    assert joined.delta_e.shape == (5, 1)
    assert joined.rms.mean() == pytest.approx(0.4)
    assert joined.stated is None


@pytest.mark.parametrize(
    ("name", "families"),
    [("macbeth", ("checker", "rawtoaces")), ("tcs", ("tcs",)), ("vs", ("vs",))],
)
def test_families_with_many_look_alikes_are_not_known(sensor, name, families):
    spectra = spectra_of(within(read_atlas(name), sensor), sensor)
    assert families_like(spectra) == families
    assert set(families_with(spectra)) <= set(families)
    assert families_like(spectra[:0]) == ()
