"""Cubes as npz and CSV, and cubes that were built for a scene."""

import csv
import json
import operator

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from tests.cube.hand_made import hand_made
from tests.helpers import near_black, raises, with_absent_points
from uplift.common.errors import ColourError, OptionError
from uplift.cube import contents
from uplift.extras.export import (
    arrays,
    write_coeff,
    write_csv,
    write_npz,
    write_program,
)
from uplift.lab.study.sensitivity import study_sensitivity
from uplift.lattice import Status
from uplift.lookup import Cube
from uplift.models import evaluate, reflectance


@pytest.fixture
def sparse(small_cube):
    """Data of a cube without most nodes."""
    return with_absent_points(small_cube.data, near_black(small_cube.data))


def test_npz_has_all_arrays_and_multipliers_of_the_spectra(small_cube, tmp_path):
    data = small_cube.data
    count = write_npz(data, tmp_path / "cube.npz")
    with np.load(tmp_path / "cube.npz", allow_pickle=False) as arrays:
        assert len(arrays.files) == count
        for name, array in contents(data)[0].items():
            assert_array_equal(arrays[name], array)
        assert tuple(arrays["atlas.names"]) == data.atlas.names
        assert json.loads(str(arrays["metadata"]))["model"] == data.model.describe()
        lattice = evaluate(data.model, arrays["multipliers"], [450, 650])
        atlas = evaluate(
            data.atlas.spectra.model, arrays["atlas.multipliers"], [450, 650]
        )
    assert_allclose(
        lattice,
        reflectance(data.model, data.points.coefficients, [450, 650]),
        atol=1e-9,
    )
    assert_allclose(
        atlas, small_cube.reflectance(data.atlas.rgb, [450, 650]), atol=1e-9
    )


def test_npz_has_the_entries_outside_the_space(cyan_cube, tmp_path):
    write_npz(cyan_cube.data, tmp_path / "cube.npz")
    with np.load(tmp_path / "cube.npz", allow_pickle=False) as arrays:
        assert arrays["outside.names"].tolist() == ["cyan"]
        assert_array_equal(arrays["outside.rgb"], cyan_cube.data.atlas.outside.rgb)
        found = evaluate(
            cyan_cube.data.atlas.spectra.model,
            arrays["outside.multipliers"],
            [450, 650],
        )
    assert_allclose(
        found,
        cyan_cube.data.atlas.outside.spectra.reflectance(np.array([0]), [450, 650]),
        atol=1e-9,
    )


def read(path):
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def column(rows, *names):
    cells = [operator.itemgetter(*names)(row) for row in rows]
    return np.array(cells, dtype=float)


def test_csv_has_a_line_per_node_in_full_precision(tmp_path, monkeypatch):
    monkeypatch.setattr(arrays, "BLOCK", 5)
    data = hand_made()
    assert write_csv(data, tmp_path / "points.csv") == data.lattice.size
    rows = read(tmp_path / "points.csv")
    for names, expected in {
        ("r", "g", "b"): data.lattice.points,
        ("lattice_r", "lattice_g", "lattice_b"): data.points.rgb,
        ("distance",): data.points.distance,
        ("round",): data.points.round,
        ("standard_error",): data.points.standard_error,
        ("c0", "c1", "c2"): data.points.coefficients,
    }.items():
        assert_array_equal(column(rows, *names), expected)
    assert [row["status"] for row in rows] == [
        Status(status).label for status in data.points.status
    ]
    names = [*data.atlas.names, ""]
    assert [row["entry"] for row in rows] == [
        names[entry] for entry in data.points.entry
    ]
    write_csv(hand_made(round=None, standard_error=None), tmp_path / "fewer.csv")
    assert not {"round", "standard_error"} & set(read(tmp_path / "fewer.csv")[0])


def test_present_nodes_of_a_sparse_cube(sparse, tmp_path):
    present = np.flatnonzero(sparse.points.present)
    assert write_csv(sparse, tmp_path / "cube.csv") == len(present)
    expected = np.column_stack(
        [sparse.lattice.points, sparse.points.coefficients[:, 0]]
    )[present]
    assert_allclose(
        column(read(tmp_path / "cube.csv"), "r", "g", "b", "c0"), expected, rtol=1e-6
    )
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
        study_sensitivity(Cube(sparse), None, 0)
    assert not list(tmp_path.iterdir())
