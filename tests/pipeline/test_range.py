"""Cubes of other ranges and steps of wavelengths: entries measured farther, and entries
cut short.
"""

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

import uplift
from tests.helpers import quiet_build
from uplift.atlas.atlas import Atlas, Entry
from uplift.atlas.sources import read_atlas
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.colorimetry.observer import on_range
from uplift.extras.relight.relight import relight
from uplift.extras.report.assessment import assess
from uplift.extras.report.live_page import page
from uplift.extras.report.regression import compare_rebuilt

MEASURED = np.arange(360, 1001, 10.0)
WIDE = {"shortest": 360, "longest": 830}


def leaf(wavelengths):
    """Return reflectances that rise steeply in the near infrared, as those
    of leaves.
    """
    visible = 0.08 + 0.1 * np.exp(-(((wavelengths - 550) / 40) ** 2))
    return visible + 0.5 / (1 + np.exp(-(wavelengths - 850) / 20))


@pytest.fixture(scope="module")
def infrared():
    """Cube to 1000 nm of a leaf, and of the same colours cut short at 700 nm, but
    brighter.
    """
    short = np.arange(400, 701, 10.0)
    entries = (
        Entry("leaf", MEASURED, leaf(MEASURED)),
        Entry("short", short, 2 * leaf(short)),
    )
    return quiet_build(Atlas(entries), dim=4, longest=1000)


def test_entries_have_their_own_values_where_measured(infrared):
    data = infrared.data
    rgb = infrared.data.atlas.rgb
    assert infrared.wavelengths[[0, -1]].tolist() == [380, 1000]
    assert data.atlas.names == ("leaf", "short")
    beyond = infrared.wavelengths > 780
    answer = infrared.reflectance(rgb[0])
    assert np.abs(answer - leaf(infrared.wavelengths))[beyond].max() < 0.04
    assert np.ptp(answer[beyond]) > 0.4


def test_entries_cut_short_continue_as_constants(infrared):
    answer = infrared.reflectance(infrared.data.atlas.rgb[1])
    last = 2 * leaf(np.array([700.0]))
    assert np.abs(answer[infrared.wavelengths > 700] - last).max() < 0.02


@pytest.mark.parametrize(("step", "model"), [(1, "sigmoid"), (10, "moments")])
def test_steps_change_spectra_little_and_all_meet_the_colour(step, model):
    usual, other = (
        quiet_build("macbeth", dim=3, model=model, prior="smooth", **WIDE, step=each)
        for each in (5, step)
    )
    assert len(other.wavelengths) == 470 / step + 1
    assert other.data.points.distance.max() <= 1e-4
    at = np.arange(400, 701, 10)
    colours = np.random.default_rng(0).random((100, 3))
    difference = usual.reflectance(colours, at) - other.reflectance(colours, at)
    assert np.sqrt((difference**2).mean()) < 0.01
    judge = on_range(other.data.sensor, 360, 830, 1)
    back = judge.rgb(other.reflectance(colours, judge.wavelengths))
    assert delta_e_rgb(judge, colours, back).max() < 0.2


def test_the_range_survives_the_file_and_spectra_are_constant_outside(
    infrared, tmp_path
):
    infrared.save(tmp_path / "a.uplift")
    found = uplift.load(tmp_path / "a.uplift")
    assert found.data.sensor.range == (380, 1000, 5)
    assert found.data.provenance["options"]["longest"] == 1000
    answer = found.reflectance([0.2, 0.3, 0.1], [300, 379, 380, 1000, 1100])
    assert_allclose(answer, answer[[2, 2, 2, 3, 3]], rtol=1e-14)


def test_everything_that_compares_under_lights_takes_the_range():
    cube = quiet_build("macbeth", dim=4, prior="smooth", **WIDE, step=10)
    assert np.isfinite(cube.standard_error([0.5, 0.2, 0.1], "A"))
    assessed = assess(cube, name="a", size=1, atlas=read_atlas("macbeth"))
    assert all(light.range == (360, 830, 10) for light in assessed.lights)
    relit = relight("a", np.full((2, 2, 3), 0.5, np.float32), {"cube": cube}, ("A",))
    assert_allclose(relit.renderings[0].colours["cube"], 0.5, atol=0.1)
    assert {*compare_rebuilt(Path("a"), cube.data, cube.data).measures.values()} == {0}
    assert "<html" in page(cube.data)
