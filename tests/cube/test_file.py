"""The cube file: everything comes back, and nothing broken comes through."""

from __future__ import annotations

import dataclasses
import json

import numpy as np
import pytest
from safetensors.numpy import load_file, save_file

from uplift.cube import CubeData, digest, file, read, write
from uplift.errors import CubeFileError, OutputError

POINT_ARRAYS = ("coefficients", "rgb", "distance", "status", "entry", "round")


@pytest.fixture
def path(small_cube, tmp_path):
    write(small_cube.data, tmp_path / "cube.uplift")
    return tmp_path / "cube.uplift"


def equal(one: CubeData, other: CubeData) -> bool:
    arrays = [(getattr(one, name), getattr(other, name)) for name in POINT_ARRAYS]
    arrays += [(getattr(one.sensor, name), getattr(other.sensor, name)) for name in file.SENSOR_ARRAYS]
    arrays += [(one.lattice.nodes, other.lattice.nodes), (one.atlas.rgb, other.atlas.rgb)]
    arrays += [(one.atlas.coefficients, other.atlas.coefficients)]
    return (
        all((a is b is None) or (a.dtype == b.dtype and np.array_equal(a, b)) for a, b in arrays)
        and (one.model, one.threshold, one.atlas.names) == (other.model, other.threshold, other.atlas.names)
        and (one.sensor.space, one.sensor.illuminant, one.sensor.observer)
        == (other.sensor.space, other.sensor.illuminant, other.sensor.observer)
        and dict(one.provenance) == dict(other.provenance)
    )


def forge(path, change_tensors=lambda tensors: None, change_metadata=lambda metadata: None):
    """The file at ``path`` with other content and a digest that fits it."""
    tensors = load_file(path)
    metadata = file._load(path)[1]
    metadata.pop("digest")
    change_tensors(tensors)
    change_metadata(metadata)
    metadata["digest"] = file._digest(tensors, metadata)
    save_file(tensors, path, metadata={file.KEY: json.dumps(metadata)})


@pytest.mark.parametrize("debug", [True, False])
def test_everything_comes_back(small_cube, tmp_path, debug):
    data = small_cube.data if debug else dataclasses.replace(small_cube.data, round=None)
    write(data, tmp_path / "cube.uplift")
    assert equal(read(tmp_path / "cube.uplift"), data)


def test_the_same_cube_gives_the_same_bytes_and_digest(small_cube, path, tmp_path):
    write(read(path), tmp_path / "again.uplift")
    assert (tmp_path / "again.uplift").read_bytes() == path.read_bytes()
    assert digest(read(path)) == digest(small_cube.data)


@pytest.mark.parametrize("name", POINT_ARRAYS)
def test_the_digest_knows_every_array(small_cube, name):
    changed = getattr(small_cube.data, name).copy()
    changed.flat[7] += 1
    assert digest(dataclasses.replace(small_cube.data, **{name: changed})) != digest(small_cube.data)


def test_a_forgery_without_changes_reads(path, small_cube):
    """So that the refusals below are refusals of the changes."""
    forge(path)
    assert equal(read(path), small_cube.data)


def test_every_flipped_bit_is_refused(path):
    whole = bytearray(path.read_bytes())
    rng = np.random.default_rng(6)
    places = [*range(0, 64), *rng.integers(64, len(whole), 200)]
    for place in places:
        broken = whole.copy()
        broken[place] ^= 1 << int(rng.integers(8))
        path.write_bytes(broken)
        with pytest.raises(CubeFileError) as caught:
            read(path)
        assert "\n" not in str(caught.value)


def test_every_truncation_is_refused(path):
    whole = path.read_bytes()
    for length in [*range(0, 40), *np.linspace(40, len(whole) - 1, 60).astype(int)]:
        path.write_bytes(whole[:length])
        with pytest.raises(CubeFileError, match=r"cut short.*; rebuild it"):
            read(path)


def test_a_header_that_claims_more_than_there_is_is_refused(path):
    whole = bytearray(path.read_bytes())
    for claim in (2**63, 2**40, len(whole) + 1, 0):
        path.write_bytes(claim.to_bytes(8, "little") + whole[8:])
        with pytest.raises(CubeFileError):
            read(path)


def test_what_is_not_there_or_no_cube_is_said_to_be(path, tmp_path):
    with pytest.raises(CubeFileError, match=r"none\.uplift: no such file; 'uplift build'"):
        read(tmp_path / "none.uplift")
    with pytest.raises(CubeFileError, match="no such file"):
        read(tmp_path)
    (tmp_path / "text").write_text("a text that is long enough to be taken for a header, if one is careless")
    with pytest.raises(CubeFileError, match="is not a cube file"):
        read(tmp_path / "text")
    save_file({"x": np.zeros(3)}, tmp_path / "other.safetensors")
    with pytest.raises(CubeFileError, match="is a safetensors file, but no uplift cube"):
        read(tmp_path / "other.safetensors")


@pytest.mark.parametrize("metadata", ["[]", "3", "not json", '{"format": 3}', "[" * 5000])
def test_metadata_that_is_no_cube_s_is_refused(tmp_path, metadata):
    save_file({"x": np.zeros(3)}, tmp_path / "cube.uplift", metadata={file.KEY: metadata})
    with pytest.raises(CubeFileError):
        read(tmp_path / "cube.uplift")


def test_another_version_is_refused(path):
    forge(path, change_metadata=lambda metadata: metadata.update(version=2))
    with pytest.raises(CubeFileError, match="format version 2, this uplift reads version 1"):
        read(path)


@pytest.mark.parametrize(
    "change",
    [
        lambda metadata: metadata.pop("model"),
        lambda metadata: metadata.update(model={"name": "polynomial"}),
        lambda metadata: metadata["model"].update(count=10),
        lambda metadata: metadata["model"].update(count="many"),
        lambda metadata: metadata["model"]["phase"].update(warp="eye"),
        lambda metadata: metadata.update(entries=["one"]),
        lambda metadata: metadata.update(features=3),
        lambda metadata: metadata.update(threshold="small"),
        lambda metadata: metadata.update(provenance=3),
        lambda metadata: metadata.update(space=3),
    ],
)
def test_metadata_that_does_not_fit_is_refused(path, change):
    forge(path, change_metadata=change)
    with pytest.raises(CubeFileError, match="is not a complete cube"):
        read(path)


@pytest.mark.parametrize(
    "change",
    [
        lambda tensors: tensors.pop("coefficients"),
        lambda tensors: tensors.update(coefficients=tensors["coefficients"][:-1]),
        lambda tensors: tensors.update(coefficients=tensors["coefficients"].astype(np.float32)),
        lambda tensors: tensors["coefficients"].__setitem__(3, np.nan),
        lambda tensors: tensors["rgb"].__setitem__(3, np.inf),
        lambda tensors: tensors["status"].__setitem__(3, 6),
        lambda tensors: tensors["entry"].__setitem__(3, 23),
        lambda tensors: tensors["entry"].__setitem__(3, -2),
        lambda tensors: tensors.update({"sensor.cmfs": tensors["sensor.cmfs"][:, :2].copy()}),
        lambda tensors: tensors["sensor.power"].__setitem__(0, np.nan),
        lambda tensors: tensors.update(nodes=tensors["nodes"][::-1].copy()),
        lambda tensors: tensors.update({"atlas.rgb": tensors["atlas.rgb"][:-1].copy()}),
        lambda tensors: tensors.pop("round"),
    ],
)
def test_arrays_that_do_not_fit_are_refused(path, change):
    forge(path, change_tensors=change)
    with pytest.raises(CubeFileError, match="is not a complete cube"):
        read(path)


def test_an_existing_file_is_kept_without_force(path, small_cube):
    before = path.read_bytes()
    with pytest.raises(OutputError, match="exists already"):
        write(small_cube.data, path)
    assert path.read_bytes() == before
