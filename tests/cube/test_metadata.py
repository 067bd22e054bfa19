"""The schema of metadata: every value of another type or range is refused when a cube is read."""

from __future__ import annotations

import os

import numpy as np
import pytest
from safetensors.numpy import save_file

from tests.cube.cube_files import forge
from tests.helpers import raises
from uplift.common.errors import CubeFileError
from uplift.cube import read
from uplift.cube.checks import POINT_TYPES
from uplift.cube.container import KEY
from uplift.cube.metadata import MAX_LIGHTS


def nested(depth):
    return '{"a":' * depth + "1" + "}" * depth


@pytest.fixture
def refused(small_cube, tmp_path):
    """Read the cube after a change of its metadata, and return the error."""

    def refused(change, code="invalid-metadata"):
        path = forge(small_cube.data, tmp_path / "cube", lambda tensors, metadata: change(metadata))
        with raises(CubeFileError, code) as caught:
            read(path)
        assert str(caught.value).isprintable()
        return caught.value

    return refused


@pytest.mark.parametrize(
    "provenance",
    [
        {"options": "dim 8"},
        {"options": None},
        {"options": {"lights": ["D65"] * (MAX_LIGHTS + 1)}},
        {"options": {"lights": [3]}},
        {"options": {"threshold": {"a": 1}}},
        {"options": {"x" * 2000: 1}},
        {"atlases": None},
        {"atlases": [{}]},
        {"atlases": ["macbeth.txt"]},
        {"atlases": [{"name": 3, "digest": "0"}]},
        {"left_out": "grey"},
        {"improvements": [{"step": "a", "tried": 1.0, "mended": 1}]},
        {"improvements": [{"step": "a", "tried": -1, "mended": 1}]},
        {"scene": "photo.png"},
        {"filled": 1},
    ],
)
def test_provenance_of_another_type_is_refused(refused, provenance):
    key = next(iter(provenance))
    assert key in refused(lambda metadata: metadata["provenance"].update(provenance)).problem


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("dim", 8.0),
        ("dim", True),
        ("dim", 7),
        ("version", 3.0),
        ("entries", ["grey"] * 23),
        ("entries", ["x" * 2000] * 23),
        ("features", ["debug", 3]),
        ("space", 3),
        ("model", {"name": "moments", "count": 9.0, "phase": {"start": 380.0, "end": 780.0, "warp": "none"}}),
        ("\x1b]0;title\x07", 1),
    ],
)
def test_metadata_of_another_type_or_range_are_refused(refused, key, value):
    refused(lambda metadata: metadata.update({key: value}))


@pytest.mark.parametrize(
    "value",
    [nested(40), nested(983), nested(100_000), r'"\ud800"', r'{"\ud800": 1}', "NaN", "1e999", "9" * 5000],
)
def test_other_values_are_refused_before_the_digest(tmp_path, value):
    path = tmp_path / "cube"
    text = f'{{"format":"uplift cube","version":3,"a":{value}}}'
    save_file({"nodes": np.zeros(2)}, path, metadata={KEY: text})
    with raises(CubeFileError, "not-a-cube"):
        read(path)


def test_unknown_provenance_of_later_versions_is_kept(small_cube, tmp_path):
    def change(tensors, metadata):
        metadata["provenance"]["later"] = {"a": [1, None, True]}

    assert read(forge(small_cube.data, tmp_path / "cube", change)).provenance["later"] == {"a": [1, None, True]}


@pytest.mark.parametrize(
    ("name", "low"), [("standard_error", 0), ("distance", 0), ("atlas.error", 0), ("sensor.power", 0)]
)
def test_negative_numbers_are_refused(small_cube, tmp_path, name, low):
    def change(tensors, metadata):
        tensors[name] = tensors[name].copy()
        tensors[name][0] = np.nextafter(tensors[name].dtype.type(low), tensors[name].dtype.type(-1))

    with raises(CubeFileError, "array-not-finite"):
        read(forge(small_cube.data, tmp_path / "cube", change))


@pytest.mark.parametrize(
    ("name", "change", "code"),
    [
        ("atlas.measured", lambda array: array[:-1], "invalid-array"),
        ("atlas.measured", lambda array: array + 1, "invalid-reflectance"),
        ("atlas.left_out", lambda array: array * np.float32(np.nan), "array-not-finite"),
        ("atlas.left_out", lambda array: array.astype(float), "invalid-array"),
        ("atlas.left_out", None, "cube-invalid"),
    ],
)
def test_left_out_entries_are_checked(small_cube, tmp_path, name, change, code):
    def forged(tensors, metadata):
        if change is None:
            del tensors[name]
        else:
            tensors[name] = change(tensors[name])

    with raises(CubeFileError, code):
        read(forge(small_cube.data, tmp_path / "cube", forged))


@pytest.mark.parametrize(
    ("name", "change", "code"),
    [
        ("rgb", lambda array: array[:-1], "invalid-array"),
        ("status", lambda array: array + 9, "unknown-status"),
        ("entry", lambda array: array + 99, "unknown-entry"),
        ("distance", lambda array: -1 - array, "array-not-finite"),
        ("points", lambda array: array[::-1], "invalid-points"),
    ],
)
def test_sparse_cubes_are_checked_before_they_are_expanded(small_cube, tmp_path, monkeypatch, name, change, code):
    def forged(tensors, metadata):
        metadata["features"].append("sparse")
        tensors["points"] = np.arange(511, dtype=np.uint32)
        tensors |= {each: tensors[each][:511] for each in POINT_TYPES if each in tensors}
        tensors[name] = change(tensors[name])

    monkeypatch.setattr("uplift.cube.sparse._expand", lambda *_: pytest.fail("expanded"))
    with raises(CubeFileError, code):
        read(forge(small_cube.data, tmp_path / "cube", forged))


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
def test_pipes_devices_and_folders_are_refused(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "pipe", tmp_path, "/dev/zero"):
        with raises(CubeFileError, "not-a-regular-file"):
            read(path)
