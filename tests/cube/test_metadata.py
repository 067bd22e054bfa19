"""The schema of metadata: every value of another type or range is refused when a cube is read."""

from __future__ import annotations

import numpy as np
import pytest
from safetensors.numpy import save_file

from tests.cube.cube_files import forge
from tests.helpers import raises
from uplift.common.errors import CubeFileError
from uplift.cube import read
from uplift.cube.container import KEY
from uplift.cube.metadata import MAX_LIGHTS, METADATA


def nested(depth):
    return '{"a":' * depth + "1" + "}" * depth


@pytest.fixture
def refused(small_cube, tmp_path):
    """Read the cube after a change of its metadata, and return the error."""

    def refused(change):
        path = forge(small_cube.data, tmp_path / "cube", lambda tensors, metadata: change(metadata))
        with raises(CubeFileError, "cube-invalid") as caught:
            read(path)
        assert str(caught.value).isprintable()
        return caught.value

    return refused


@pytest.mark.parametrize("key", [key for key in METADATA if key not in ("format", "version")])
def test_values_that_are_missing_or_of_another_type_are_named(refused, key):
    assert repr(key) in refused(lambda metadata: metadata.pop(key)).problem
    for value in (None, 10**400, [{}], {"options": 1}, "x" * 2000, True):
        assert key in refused(lambda metadata, value=value: metadata.update({key: value})).problem


@pytest.mark.parametrize(
    "provenance",
    [
        {"options": "dim 8"},
        {"options": {"lights": ["D65"] * (MAX_LIGHTS + 1)}},
        {"options": {"lights": [3]}},
        {"options": {"threshold": {"a": 1}}},
        {"options": {"x" * 2000: 1}},
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
        *(("threshold", value) for value in (0, 5e-324, 1e-13, 0.2, -1e-4)),
        ("dim", 8.0),
        ("dim", 7),
        ("entries", ["grey"] * 23),
        ("features", ["debug", 3]),
        ("features", ["camera"]),
        ("model", {"name": "moments", "count": 9.0, "phase": {"start": 380.0, "end": 780.0, "warp": "none"}}),
        ("\x1b]0;title\x07", 1),
    ],
)
def test_metadata_out_of_range_are_refused(refused, key, value):
    refused(lambda metadata: metadata.update({key: value}))


@pytest.mark.parametrize(
    "value", [nested(40), nested(983), nested(100_000), r'"\ud800"', r'{"\ud800": 1}', "NaN", "1e999", "9" * 5000]
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
