"""Builds with a prior, libraries and families left out: recorded and repeatable."""

import shutil

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import uplift
from tests.conftest import ATLASES
from tests.helpers import quiet_build, raises, warns
from uplift.atlas.atlas import Atlas, Entry
from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import read_atlas
from uplift.colorimetry.delta_e import delta_e_spectra, rgb_to_lab
from uplift.colorimetry.observer import light
from uplift.common.errors import CubeFileError
from uplift.cube.file import digest
from uplift.extras.report.rebuild import rebuild
from uplift.lookup.cube import load

SMALL = {"dim": 8, "coefficients": 9}
TCS = ATLASES / "tcs.txt"


@pytest.fixture(scope="module")
def cubes():
    options = {**SMALL, "leave_out": ["tcs"]}
    with warns("entry-out-of-gamut"):
        library = uplift.build(**options, library=TCS)
    return {
        "smooth": uplift.build(**SMALL, prior="smooth"),
        "learnt": uplift.build(**options),
        "library": library,
    }


def test_a_library_moves_answers_towards_its_spectra(cubes):
    sensor = cubes["smooth"].data.sensor
    measured = on_grid(read_atlas(TCS), sensor.wavelengths)
    rgb = np.clip(sensor.rgb(measured), 0, 1)
    smooth, learnt, library = (
        delta_e_spectra(light("A"), cube.reflectance(rgb), measured).mean()
        for cube in cubes.values()
    )
    assert library < 0.95 * learnt < 0.95 * smooth
    assert not cubes["library"].data.atlas.names


def test_a_build_with_a_library_is_repeated(cubes, tmp_path):
    path = tmp_path / "cube.uplift"
    shutil.copy(TCS, tmp_path)
    cubes["library"].save(path)
    assert digest(rebuild(load(path), path).data) == digest(cubes["library"].data)


def test_a_library_without_a_file_cannot_be_repeated(tmp_path):
    path = tmp_path / "cube.uplift"
    unnamed = Atlas(tuple(read_atlas(TCS))[:3])
    cube = uplift.build(**SMALL, library=unnamed)
    cube.save(path)
    with raises(CubeFileError, "atlas-not-found"):
        rebuild(load(path), path)


def test_neutral_flat_flattens_greys_but_neither_colours_nor_entries():
    plain, flat = (
        quiet_build(TCS, dim=16, neutral=name) for name in ("expected", "flat")
    )
    levels = np.array([[0.01], [0.05], [0.45], [0.7], [0.92], [0.99]])
    greys = np.repeat(levels, 3, axis=1)
    assert np.abs(flat.reflectance(greys) - levels).max() < 0.02
    assert np.abs(plain.reflectance(greys) - levels).max() > 0.1
    colours = np.random.default_rng(1).random((200, 3))
    chroma = np.hypot(*rgb_to_lab(plain.data.sensor, colours)[:, 1:].T)
    far = np.concatenate([colours[chroma > 40], flat.data.atlas.rgb])
    assert_allclose(flat.reflectance(far), plain.reflectance(far), atol=1e-4)


def test_neutral_flat_in_a_wide_gamut_and_of_a_model_without_a_choice():
    grey = [0.6] * 3
    wide = uplift.build(dim=9, space="ACEScg", neutral="flat")
    assert np.ptp(wide.reflectance(grey)) < 0.03
    flat = uplift.build(dim=8, model="sigmoid", neutral="flat")
    expected = uplift.build(dim=8, model="sigmoid")
    assert_array_equal(flat.reflectance(grey), expected.reflectance(grey))


def test_spectra_that_are_not_used_as_measured_are_reported():
    wavelengths = np.linspace(380, 780, 81)
    green = Entry("green", wavelengths, np.exp(-(((wavelengths - 520) / 15) ** 2)))
    noisy = Entry("noisy", wavelengths, np.linspace(0.2, 1.05, 81))
    with warns("entry-clipped", "entry-out-of-gamut"):
        uplift.build(dim=2, library=Atlas((green, noisy)))
