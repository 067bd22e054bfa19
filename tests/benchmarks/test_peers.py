"""Answers of other tools: a table of rgb2spec gives back its colours, and wrong or
missing ones are found.
"""

from itertools import product

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import root

from benchmarks import peers
from uplift.models import Sigmoid, evaluate
from uplift.models.sigmoid import unscaled

LEVELS = (0.25, 0.5)
MODEL = Sigmoid(360, 830)


def fit(rgb, sensor):
    """Coefficients of the spectrum of a colour, by a general solver."""
    found = root(
        lambda x: sensor.rgb(evaluate(MODEL, x[None], sensor.wavelengths))[0] - rgb,
        np.zeros(3),
        tol=1e-10,
    )
    assert found.success
    return unscaled(MODEL, found.x[None])[0]


@pytest.fixture(scope="module")
def table(tmp_path_factory):
    """A table of two levels; component l + 1 varies fastest."""
    sensor = peers.table_sensor()
    path = tmp_path_factory.mktemp("table") / "small.coeff"
    colours = [
        np.roll([level, middle * level, last * level], largest)
        for largest, level, last, middle in product(range(3), LEVELS, (0, 1), (0, 1))
    ]
    coefficients = np.array([fit(rgb, sensor) for rgb in colours])
    write(path, coefficients)
    return path, coefficients


def write(path, coefficients):
    head = (
        b"SPEC" + np.uint32(len(LEVELS)).tobytes() + np.array(LEVELS, "<f4").tobytes()
    )
    path.write_bytes(head + coefficients.astype("<f4").tobytes())


def test_colours_of_a_table_come_back(table):
    found, target = peers.table_colours(table[0])
    assert peers.check_share(found, target, least=1.0)["worst"] < 1e-5
    assert sorted(set(target.ravel())) == [0, *LEVELS]
    assert (target.reshape(3, -1, 3).max(axis=1) == max(LEVELS)).all()


def test_axes_that_are_swapped_are_wrong_answers(table, tmp_path):
    swapped = table[1].reshape(3, 2, 2, 2, 3).swapaxes(2, 3)
    write(tmp_path / "swapped.coeff", swapped)
    with pytest.raises(
        RuntimeError, match=r"wrong answer, not timed: 50\.0% of the nodes"
    ):
        peers.check_share(*peers.table_colours(tmp_path / "swapped.coeff"), least=0.9)


def test_a_point_without_a_number_is_not_within_the_threshold():
    found = np.array([[0.5, 0.5, np.nan], [0.5, 0.5, 0.5]])
    assert peers.check_share(found, np.full((2, 3), 0.5), least=0.5) == {
        "points": 2,
        "share": 0.5,
        "worst": np.inf,
    }


def test_the_sensor_of_a_table_keeps_white():
    sensor = peers.table_sensor()
    assert_allclose(sensor.rgb(np.ones(len(sensor.wavelengths))), 1, atol=2e-4)


def test_without_its_source_the_tool_says_what_it_needs(monkeypatch, tmp_path):
    monkeypatch.setattr(peers, "RGB2SPEC", tmp_path)
    with pytest.raises(RuntimeError, match="make peers"):
        next(peers.rgb2spec())
