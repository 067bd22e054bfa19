"""Export of cubes that were built for a scene."""

from __future__ import annotations

import csv

import numpy as np
import pytest

from tests.helpers import raises
from tests.sparse_cubes import near_black, with_absent_points
from uplift.common.errors import ColourError, OptionError
from uplift.io.export import write_coeff, write_csv, write_npz, write_program
from uplift.lab.study.sensitivity import study_sensitivity


@pytest.fixture
def data(small_cube):
    return with_absent_points(small_cube.data, near_black(small_cube.data))


def test_csv_has_the_present_nodes(data, tmp_path):
    count = int(data.points.present.sum())
    assert write_csv(data, tmp_path / "cube.csv") == count
    lines = csv.DictReader((tmp_path / "cube.csv").read_text(encoding="utf-8").splitlines())
    found = [[float(line[name]) for name in ("r", "g", "b", "c0")] for line in lines]
    expected = np.column_stack([data.lattice.points, data.points.coefficients[:, 0]])[data.points.present]
    np.testing.assert_allclose(found, expected, rtol=1e-6)


def test_npz_has_the_present_nodes(data, tmp_path):
    write_npz(data, tmp_path / "cube.npz")
    arrays = np.load(tmp_path / "cube.npz")
    np.testing.assert_array_equal(arrays["points"], np.flatnonzero(data.points.present))
    assert len(arrays["multipliers"]) == len(arrays["coefficients"]) == len(arrays["points"])
    assert np.isfinite(arrays["multipliers"]).all()


def test_formats_of_all_colours_raise(data, tmp_path, small_cube):
    with raises(OptionError, "sparse-cube"):
        write_program(data, tmp_path / "cube.h")
    with raises(ColourError, "colour-not-in-scene"):
        write_coeff(data, tmp_path / "cube.coeff", res=2)
    assert not list(tmp_path.iterdir())


def test_the_sensitivity_study_raises(data, small_cube):
    with raises(OptionError, "sparse-cube"):
        study_sensitivity(type(small_cube)(data), None, 0)
