"""Arrays of a cube, read by numpy."""

from __future__ import annotations

import json

import numpy as np

from uplift.cube import contents
from uplift.io.export import write_npz
from uplift.models import evaluate, reflectance


def test_all_arrays_are_present(small_cube, tmp_path):
    data = small_cube.data
    count = write_npz(data, tmp_path / "cube.npz")
    with np.load(tmp_path / "cube.npz", allow_pickle=False) as arrays:
        assert len(arrays.files) == count
        for name, array in contents(data)[0].items():
            np.testing.assert_array_equal(arrays[name], array)
        assert tuple(arrays["atlas.names"]) == data.atlas.names
        assert json.loads(str(arrays["metadata"]))["model"] == data.model.describe()


def test_multipliers_evaluate_to_the_spectra(small_cube, tmp_path):
    data = small_cube.data
    write_npz(data, tmp_path / "cube.npz")
    with np.load(tmp_path / "cube.npz", allow_pickle=False) as arrays:
        lattice = evaluate(data.model, arrays["multipliers"], [450, 650])
        atlas = evaluate(data.entry_spectra.model, arrays["atlas.multipliers"], [450, 650])
    np.testing.assert_allclose(lattice, reflectance(data.model, data.points.coefficients, [450, 650]), atol=1e-9)
    np.testing.assert_allclose(atlas, small_cube.reflectance(data.atlas.rgb, [450, 650]), atol=1e-9)


def test_output_is_reproducible(plain_cube, tmp_path):
    for name in ("first", "second"):
        write_npz(plain_cube.data, tmp_path / name)
    assert (tmp_path / "first").read_bytes() == (tmp_path / "second").read_bytes()


def test_a_cube_without_an_atlas(plain_cube, tmp_path):
    write_npz(plain_cube.data, tmp_path / "cube.npz")
    with np.load(tmp_path / "cube.npz", allow_pickle=False) as arrays:
        assert arrays["atlas.names"].shape == (0,)
        assert arrays["atlas.multipliers"].shape == (0, 9)
