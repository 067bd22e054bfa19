"""Families of materials: the shipped library, kriging against the explicit covariance,
and relevances.
"""

from importlib.resources import files

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tests.conftest import ATLASES
from tools import ship_library
from uplift.atlas.resampling import resample
from uplift.atlas.sources import read_atlas
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
from uplift.lab.look_alikes import families_like

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


@pytest.mark.parametrize(
    ("atlas", "families"), [("macbeth", ("checker",)), ("cie2017", ("cie2017",))]
)
def test_families_are_found_by_their_spectra(sensor, atlas, families):
    measured = resample(read_atlas(ATLASES / f"{atlas}.txt"), sensor.wavelengths).values
    assert set(families) <= set(families_like(measured))


def samples(count):
    locations = RNG.uniform([20, -30, -30], [90, 30, 30], (count, 3))
    return Points(
        locations,
        RNG.normal(size=(count, 4)),
        RNG.integers(1, 4, count),
        np.arange(count),
    )


def matern(first, second):
    scaled = (
        np.sqrt(3) * np.linalg.norm(first[:, None] - second[None], axis=-1) / LENGTH
    )
    return (1 + scaled) * np.exp(-scaled)


def conditional_mean(families, points, lab):
    """Mean of shared deviation plus the related share of each family's own, given all
    samples.
    """
    where = np.concatenate([each.locations for each in points])
    what = np.concatenate([each.deviations for each in points])
    covariance = matern(where, where)
    cross = matern(lab, where)
    first = 0
    for family, each in zip(families, points, strict=True):
        own = slice(first, first + len(each.locations))
        covariance[own, own] += family.spread * matern(each.locations, each.locations)
        covariance[own, own] += np.diag(NUGGET / each.counts)
        cross[:, own] *= 1 + family.related * family.spread
        first = own.stop
    return cross @ np.linalg.solve(covariance, what)


@pytest.mark.parametrize("sizes", [(12, 30), (1, 7, 0), (25,)])
def test_it_is_the_conditional_mean(sizes):
    points = [samples(size) for size in sizes]
    families = [Family("", None, *pair) for pair in ((5, 0), (1, 0.5), (2, 1))][
        : len(sizes)
    ]
    lab = RNG.uniform([0, -60, -60], [100, 60, 60], (50, 3))
    kriging = krige_families(families, points)
    assert_allclose(
        kriging(lab, np.ones(len(sizes))),
        conditional_mean(families, points, lab),
        atol=1e-9,
    )
    relevance = RNG.uniform(0, 2, len(sizes))
    expected = np.einsum("f,fnk->nk", relevance, kriging.contributions(lab))
    assert_allclose(kriging(lab, relevance), expected, atol=1e-12)


def learn(measured, rows=slice(None)):
    return learn_relevance(
        LIGHTS, PLACES[rows], PLAIN[rows], PARTS[:, rows], measured[rows]
    )


@pytest.mark.parametrize("truth", [(2.0, 0.5), (0.0, 1.0), (1.3, 1.6)])
def test_relevances_of_an_explained_atlas_are_found(truth):
    measured = PLAIN + np.tensordot(truth, PARTS, 1)
    assert_allclose(learn(measured + 1e-4 * OTHERS[0]), truth, atol=0.1)


def distances(amplitude, rows=slice(None)):
    """Distance from 1 of relevances that are truly 2 and 0, over atlases."""
    measured = PLAIN + 2 * PARTS[0]
    return np.mean(
        [
            np.abs(learn(measured + amplitude * other, rows) - 1).mean()
            for other in OTHERS
        ]
    )


def test_what_no_family_explains_keeps_relevances_near_1():
    assert distances(0.001) > 0.9
    assert distances(0.5) < 0.5
    assert distances(0.05, slice(0, 3)) < distances(0.05) - 0.1
