"""Cubes as npz, and cubes that were built for a scene."""

import json

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tests.helpers import near_black, raises, with_absent_points
from uplift.common.errors import ColourError, OptionError
from uplift.cube.file import contents
from uplift.extras.export.arrays import write_npz
from uplift.extras.export.coeff import write_coeff
from uplift.extras.export.program import write_program
from uplift.lab.study.sensitivity import perturb
from uplift.lookup.cube import Cube
from uplift.models.model import evaluate, reflectance

AT = [450, 650]


@pytest.fixture
def sparse(small_cube):
    """Data of a cube without most nodes."""
    return with_absent_points(small_cube.data, near_black(small_cube.data))


def test_npz_has_all_arrays_and_multipliers_of_the_spectra(cyan_cube, tmp_path):
    """Of nodes, entries and entries outside the space."""
    data = cyan_cube.data
    count = write_npz(data, tmp_path / "cube.npz")
    with np.load(tmp_path / "cube.npz", allow_pickle=False) as arrays:
        assert len(arrays.files) == count
        for name, array in contents(data)[0].items():
            assert_array_equal(arrays[name], array)
        assert tuple(arrays["atlas.names"]) == data.atlas.names
        assert arrays["outside.names"].tolist() == ["cyan"]
        assert json.loads(str(arrays["metadata"]))["model"] == data.model.describe()
        model = data.atlas.spectra.model
        found = [
            evaluate(data.model, arrays["multipliers"], AT),
            evaluate(model, arrays["atlas.multipliers"], AT),
            evaluate(model, arrays["outside.multipliers"], AT),
        ]
    expected = [
        reflectance(data.model, data.points.coefficients, AT),
        cyan_cube.reflectance(data.atlas.rgb, AT),
        data.atlas.outside.spectra.reflectance(np.array([0]), AT),
    ]
    assert_allclose(np.concatenate(found), np.concatenate(expected), atol=1e-9)


def test_present_nodes_of_a_sparse_cube(sparse, tmp_path):
    present = np.flatnonzero(sparse.points.present)
    write_npz(sparse, tmp_path / "cube.npz")
    arrays = np.load(tmp_path / "cube.npz")
    assert_array_equal(arrays["points"], present)
    assert len(arrays["multipliers"]) == len(arrays["coefficients"]) == len(present)


def test_formats_of_all_colours_reject_a_sparse_cube(sparse, tmp_path):
    with raises(OptionError, "sparse-cube"):
        write_program(sparse, tmp_path / "cube.h")
    with raises(ColourError, "colour-not-in-scene"):
        write_coeff(sparse, tmp_path / "cube.coeff", res=2)
    with raises(OptionError, "sparse-cube"):
        perturb(Cube(sparse))
    assert not list(tmp_path.iterdir())
