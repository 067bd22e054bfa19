"""Tasks of measured materials, and the rows of methods at them."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tests.lab.conftest import grey
from uplift.atlas.sources import read_atlas
from uplift.colorimetry.delta_e import delta_e_spectra
from uplift.lab.look_alikes import families_like
from uplift.lab.method import PreparedMethod
from uplift.lab.runner import (
    divided,
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


def test_rows_pool_the_errors_of_all_tasks(sensor):
    """Greys do not depend on the known part, so that the means are those of the set:
    every entry is queried once a seed, and not known then.
    """
    entries = within(read_atlas("tcs"), sensor)
    spectra = spectra_of(entries, sensor)
    tasks = list(divided(entries, ("tcs",), sensor, 4, seeds=2))
    for task in tasks:
        both = np.concatenate([task.known_spectra, task.queried])
        assert_array_equal(np.sort(both, axis=0), np.sort(spectra, axis=0))
    rows = list(measure({"grey": prepare}, tasks, LIGHTS, set="tcs"))
    assert [row["light"] for row in rows] == ["A", "FL11", "all", "all"]
    answers = grey(np.clip(sensor.rgb(spectra), 0, 1), sensor.wavelengths)
    actual = delta_e_spectra(LIGHTS["A"], answers, spectra)
    row, other, both, rms = rows
    assert (row["set"], row["method"], row["n"]) == ("tcs", "grey", 2 * len(entries))
    found = [row[name] for name in ("mean", "max", "within_error", "within_bound")]
    shares = [(actual <= limit).mean() for limit in (5, 10)]
    assert_allclose(found, [actual.mean(), actual.max(), *shares])
    assert both["mean"] == pytest.approx((row["mean"] + other["mean"]) / 2)
    assert rms["measure"] == "rms"


@pytest.mark.parametrize(
    ("name", "families"),
    [("macbeth", ("checker", "rawtoaces")), ("tcs", ("tcs",)), ("vs", ("vs",))],
)
def test_families_with_many_look_alikes_are_not_known(sensor, name, families):
    spectra = spectra_of(within(read_atlas(name), sensor), sensor)
    assert families_like(spectra) == families
    assert families_like(spectra[:0]) == ()
