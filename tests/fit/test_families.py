"""Families of materials: the shipped library, kriging against the explicit covariance,
and relevances.
"""

from importlib.resources import files

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tools import ship_library
from uplift.colorimetry import observer
from uplift.fit.families import (
    FILE,
    LENGTH,
    NUGGET,
    Family,
    krige_families,
    learn_relevance,
)
from uplift.fit.kriging import Points

RNG = np.random.default_rng(5)
LIGHTS = [observer.light(name) for name in ("A", "FL11")]
ENTRIES = 40
PLACES = RNG.uniform((0, -50, -50), (100, 50, 50), (ENTRIES, 3))
PLAIN = np.full((ENTRIES, 81), 0.4)
WAVES = np.cos(np.arange(2, 8)[:, None] * np.linspace(0, np.pi, 81))
PARTS = 0.02 * RNG.normal(size=(2, ENTRIES, 6)) @ WAVES
OTHERS = RNG.normal(size=(20, ENTRIES, 6)) @ WAVES
"""Deviations of entries that no family explains."""


def test_the_shipped_file_is_the_output_of_the_tool(tmp_path):
    written = tmp_path / "library.npz"
    ship_library.main(written)
    with (
        np.load(written) as new,
        (files("uplift.fit") / FILE).open("rb") as file,
        np.load(file) as shipped,
    ):
        assert set(new.files) == set(shipped.files)
        for name in new.files:
            if name.startswith(
                ("matrices", "smooth")
            ):  # instruction sets round them differently
                assert_allclose(
                    new[name], shipped[name], rtol=0, atol=1e-7, err_msg=name
                )
            else:
                assert_array_equal(new[name], shipped[name], err_msg=name)
    assert written.stat().st_size < 1_200_000


def samples(count):
    locations = RNG.uniform([20, -30, -30], [90, 30, 30], (count, 3))
    counts = RNG.integers(1, 4, count)
    return Points(locations, RNG.normal(size=(count, 4)), counts, np.arange(count))


def matern(first, second):
    apart = np.linalg.norm(first[:, None] - second[None], axis=-1)
    scaled = np.sqrt(3) * apart / LENGTH
    return (1 + scaled) * np.exp(-scaled)


def test_it_is_the_conditional_mean():
    """Of the shared deviation plus the related share of each family's own, given all
    samples.
    """
    spreads, related, sizes = (5, 1, 2), (0, 0.5, 1), (12, 30, 0)
    families = [Family("", None, *pair) for pair in zip(spreads, related, strict=True)]
    points = [samples(size) for size in sizes]
    where, what, counts, _ = map(np.concatenate, zip(*points, strict=True))
    family = np.repeat(range(3), sizes)
    own = np.where(family[:, None] == family, np.take(spreads, family), 0)
    covariance = (1 + own) * matern(where, where) + np.diag(NUGGET / counts)
    lab = RNG.uniform([0, -60, -60], [100, 60, 60], (50, 3))
    cross = matern(lab, where) * (1 + np.multiply(spreads, related))[family]
    expected = cross @ np.linalg.solve(covariance, what)
    kriging = krige_families(families, points)
    assert_allclose(kriging(lab, np.ones(3)), expected, atol=1e-9)
    relevance = RNG.uniform(0, 2, 3)
    expected = np.tensordot(relevance, kriging.contributions(lab), 1)
    assert_allclose(kriging(lab, relevance), expected, atol=1e-12)


def learn(measured, rows=slice(None)):
    return learn_relevance(
        LIGHTS, PLACES[rows], PLAIN[rows], PARTS[:, rows], measured[rows]
    )


@pytest.mark.parametrize("truth", [(2.0, 0.5), (0.0, 1.0), (1.3, 1.6)])
def test_relevances_of_an_explained_atlas_are_found(truth):
    measured = PLAIN + np.tensordot(truth, PARTS, 1)
    assert_allclose(learn(measured + 1e-4 * OTHERS[0]), truth, atol=0.1)


def test_what_no_family_explains_keeps_relevances_near_1():
    """They are truly 2 and 0."""
    measured = PLAIN + 2 * PARTS[0]

    def distance(amplitude, rows=slice(None)):
        found = [learn(measured + amplitude * other, rows) for other in OTHERS]
        return np.abs(np.array(found) - 1).mean()

    assert distance(0.001) > 0.9
    assert distance(0.5) < 0.5
    assert distance(0.05, slice(0, 3)) < distance(0.05) - 0.1
