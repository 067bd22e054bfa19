"""The shipped library: what tools/ship_library.py writes, small, and without the families to leave out."""

from __future__ import annotations

from importlib.resources import files

import numpy as np
import pytest

from tests.conftest import ATLASES
from tests.helpers import raises
from tools import ship_library
from uplift.atlas import read_atlas, resample
from uplift.colorimetry import observer
from uplift.common.errors import UnknownNameError
from uplift.fit.library import FILE, STEPS, families_with, shipped_library


@pytest.fixture(scope="module")
def written(tmp_path_factory):
    path = tmp_path_factory.mktemp("library") / "library.npz"
    ship_library.main(path)
    return path


def test_the_shipped_file_is_the_output_of_the_tool(written):
    with np.load(written) as new, (files("uplift.fit") / FILE).open("rb") as file, np.load(file) as shipped:
        assert set(new.files) == set(shipped.files)
        for name in new.files:
            np.testing.assert_array_equal(new[name], shipped[name], err_msg=name)
    assert written.stat().st_size < 100_000


def test_measured_families_are_the_shipped_atlases():
    families = {family.name: family.measured for family in shipped_library()}
    for name, atlases in ship_library.FAMILIES.items():
        np.testing.assert_allclose(families[name], ship_library.measurements(atlases), atol=0.51 / STEPS)
    for measured in families.values():
        assert measured.min() >= 0
        assert measured.max() <= 1


def test_otsu_spectra_have_their_colours_and_no_seams():
    light = observer.light("D65").xyz
    ramp = np.linspace([0.30, 0.38, 0.30], [0.40, 0.38, 0.30], 400)
    spectra = ship_library.blurred_otsu(ramp, light)
    np.testing.assert_allclose(spectra @ light.T, ramp, atol=1e-12)
    steps = np.abs(np.diff(spectra, axis=0)).max(axis=1)
    assert steps.max() < 0.02
    assert steps.max() < 10 * np.median(steps)


def test_families_can_be_left_out():
    names = [family.name for family in shipped_library()]
    assert [family.name for family in shipped_library(["vs", "tcs"])] == [
        name for name in names if name not in ("vs", "tcs")
    ]
    with raises(UnknownNameError, "unknown-library-family"):
        shipped_library(["absent"])


@pytest.mark.parametrize(("atlas", "families"), [("macbeth", ("checker",)), ("cie2017", ("cie2017",))])
def test_families_are_found_by_their_spectra(sensor, atlas, families):
    measured = resample(read_atlas(ATLASES / f"{atlas}.txt"), sensor.wavelengths).values
    assert families_with(measured) == families
    assert families_with(np.clip(measured + 0.01, 0, 1)) == ()
    assert families_with(measured[:0]) == ()
