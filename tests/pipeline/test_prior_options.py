"""Builds with a prior, libraries and families left out: recorded and repeatable."""

import shutil

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import uplift
from tests.conftest import ATLASES
from tests.helpers import raises, warns
from uplift.atlas.atlas import Atlas, Entry
from uplift.atlas.sources import read_atlas
from uplift.colorimetry.delta_e import delta_e_spectra, rgb_to_lab
from uplift.colorimetry.observer import light
from uplift.common.errors import CubeFileError
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
    measured = np.array([entry.values for entry in read_atlas(TCS)])
    wavelengths = next(iter(read_atlas(TCS))).wavelengths
    grid = cubes["smooth"].data.sensor.wavelengths
    measured = np.stack([np.interp(grid, wavelengths, row) for row in measured])
    rgb = np.clip(cubes["smooth"].data.sensor.rgb(measured), 0, 1)
    errors = {
        name: delta_e_spectra(light("A"), cube.reflectance(rgb), measured).mean()
        for name, cube in cubes.items()
    }
    assert errors["library"] < 0.95 * errors["learnt"] < 0.95 * errors["smooth"]
    assert not cubes["library"].data.atlas.names


def test_a_build_with_a_library_is_repeated(cubes, tmp_path):
    path = tmp_path / "cube.uplift"
    shutil.copy(TCS, tmp_path / "tcs.txt")
    cubes["library"].save(path)
    stored = load(path)
    again = rebuild(stored, path)
    assert_array_equal(again.data.points.coefficients, stored.data.points.coefficients)
    assert again.data.provenance == stored.data.provenance


def test_a_library_without_a_file_cannot_be_repeated(tmp_path):
    path = tmp_path / "cube.uplift"
    unnamed = Atlas(tuple(read_atlas(TCS))[:3])
    cube = uplift.build(**SMALL, library=unnamed)
    cube.save(path)
    with raises(CubeFileError, "atlas-not-found"):
        rebuild(load(path), path)


@pytest.mark.filterwarnings("ignore::uplift.UpliftWarning")
def test_neutral_flat_flattens_greys_but_neither_colours_nor_entries(tmp_path):
    path = tmp_path / "flat.uplift"
    plain, flat = (
        uplift.build(TCS, dim=16, neutral=name) for name in ("expected", "flat")
    )
    flat.save(path)
    assert_array_equal(
        rebuild(load(path), path).reflectance([0.99] * 3), flat.reflectance([0.99] * 3)
    )

    def deviation(cube, levels):
        return np.abs(cube.reflectance(np.repeat(levels, 3, axis=1)) - levels).max()

    levels = np.array([[0.01], [0.05], [0.45], [0.7], [0.92], [0.99]])
    assert deviation(flat, levels) < 0.02 < 0.1 < deviation(plain, levels)
    lab = rgb_to_lab(
        plain.data.sensor, colours := np.random.default_rng(1).random((200, 3))
    )
    far = colours[np.hypot(lab[:, 1], lab[:, 2]) > 40]
    assert_allclose(flat.reflectance(far), plain.reflectance(far), atol=1e-4)
    assert_array_equal(
        *(cube.reflectance(cube.data.atlas.rgb) for cube in (flat, plain))
    )


def test_neutral_flat_in_a_wide_gamut_and_of_a_model_without_a_choice():
    grey = [0.6] * 3
    assert (
        np.ptp(uplift.build(dim=9, space="ACEScg", neutral="flat").reflectance(grey))
        < 0.03
    )
    spectra = (
        uplift.build(dim=5, model="sigmoid", neutral=name).reflectance(grey)
        for name in ("flat", "expected")
    )
    assert_array_equal(*spectra)


def test_spectra_that_are_not_used_as_measured_are_reported():
    wavelengths = np.linspace(380, 780, 81)
    green = Entry("green", wavelengths, np.exp(-(((wavelengths - 520) / 15) ** 2)))
    noisy = Entry("noisy", wavelengths, np.linspace(0.2, 1.05, 81))
    with warns("entry-clipped", "entry-out-of-gamut"):
        uplift.build(dim=2, library=Atlas((green, noisy)))
