"""Cube files: everything written is read back, and all other files are refused."""

from __future__ import annotations

import dataclasses
import json
import os
from pathlib import Path

import numpy as np
import pytest
from safetensors.numpy import load_file, save_file

from tests.cube.cube_files import forge, header_length, with_header, with_header_length
from tests.cube.test_round_trip import assert_same
from tests.helpers import raises, with_points
from uplift.common.errors import CubeFileError, OutputError
from uplift.cube import container, digest, read, write
from uplift.cube.container import KEY
from uplift.cube.file import ARRAYS, POINTS, VERSION
from uplift.lattice import Status
from uplift.models import Moments, Phase

FLIPS, CUTS = 1500, 200
FORMAT_3 = Path(__file__).parent / "format-3.uplift"


@pytest.fixture
def data(small_cube):
    return small_cube.data


@pytest.fixture
def path(data, tmp_path):
    path = tmp_path / "cube.uplift"
    write(data, path)
    return path


@pytest.fixture
def content(path):
    return path.read_bytes()


def refused(path, *codes):
    """The error of reading a file: one line, located at the file, with a hint and one of ``codes``, if given."""
    with pytest.raises(CubeFileError) as caught:
        read(path)
    error = caught.value
    assert error.where == str(path)
    assert str(error).isprintable()
    assert error.hint
    assert not codes or error.code in codes, f"{error.code}: {error}"
    return error


@pytest.fixture
def forged(data, tmp_path):
    """Change one array of the cube, with a valid digest, and return the error of reading it."""

    def forged(name, change):
        def apply(tensors, metadata):
            tensors[name] = change(tensors[name].copy())

        return refused(forge(data, tmp_path / "cube", apply), "cube-invalid")

    return forged


def with_value(value, place=7):
    def change(array):
        array.flat[place] = value
        return array

    return change


def test_an_existing_file_is_replaced_with_force_only(data, path, content):
    with raises(OutputError, "file-exists"):
        write(data, path)
    write(data, path, force=True)
    assert path.read_bytes() == content


@pytest.mark.parametrize("name", ["threshold", "provenance", *POINTS, "nodes", "rgb", "spectra", "cmfs"])
def test_the_digest_changes_with_any_content(data, name):
    """One number changes by the smallest amount."""
    atlas, sensor, lattice = data.atlas, data.sensor, data.lattice
    spectra = dataclasses.replace(atlas.spectra, coefficients=nudged(atlas.spectra.coefficients))
    changes = {
        "threshold": {"threshold": float(np.nextafter(data.threshold, 1))},
        "provenance": {"provenance": {**data.provenance, "uplift": "0.0.0"}},
        "nodes": {"lattice": dataclasses.replace(lattice, nodes=nudged(lattice.nodes))},
        "rgb": {"atlas": dataclasses.replace(atlas, rgb=nudged(atlas.rgb))},
        "spectra": {"atlas": dataclasses.replace(atlas, spectra=spectra)},
        "cmfs": {"sensor": dataclasses.replace(sensor, cmfs=nudged(sensor.cmfs))},
    }
    if name in changes:
        changed = dataclasses.replace(data, **changes[name])
    else:
        changed = with_points(data, **{name: nudged(getattr(data.points, name))})
    assert digest(changed) != digest(data)


def nudged(array):
    array = array.copy()
    place = tuple(np.array(array.shape) // 2)
    array[place] = array[place] + 1 if array.dtype.kind in "iu" else np.nextafter(array[place], array.dtype.type(9))
    return array


def test_the_digest_is_that_of_the_file(data, content):
    header = json.loads(content[8 : 8 + header_length(content)])
    assert json.loads(header["__metadata__"][KEY])["digest"] == digest(data)


@pytest.mark.parametrize("name", ["none.uplift", "file/cube"])
def test_a_missing_file_is_reported(tmp_path, name):
    (tmp_path / "file").write_text("")
    refused(tmp_path / name, "cube-not-found")


@pytest.mark.parametrize("name", ["a\0b", "x" * 300])
def test_impossible_file_names_are_reported(tmp_path, name):
    with raises(CubeFileError, "file-unreadable"):
        read(tmp_path / name)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
def test_pipes_devices_and_folders_are_refused(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path / "pipe", tmp_path, "/dev/zero"):
        refused(path, "not-a-regular-file")


@pytest.mark.parametrize(
    "content", [b"", b"\0" * 8, b"\xff" * 64, b"{}", b"Some text, and long enough to be a header length\n"]
)
def test_files_of_other_formats_are_refused(tmp_path, content):
    path = tmp_path / "other"
    path.write_bytes(content)
    refused(path, "not-a-cube")


@pytest.mark.parametrize("metadata", [None, {}, {"other": "1"}, {KEY: "{}"}, {KEY: "[]"}, {KEY: "null"}, {KEY: "{"}])
def test_other_safetensors_files_are_refused(tmp_path, metadata):
    path = tmp_path / "other.safetensors"
    save_file({"weights": np.zeros((2, 2))}, path, metadata=metadata)
    refused(path, "not-a-cube")


def test_truncated_and_longer_files_are_refused(path, content):
    rng = np.random.default_rng(1)
    lengths = {*range(0, 16), *rng.integers(0, len(content), CUTS).tolist(), len(content) - 1}
    for broken in [content[:length] for length in lengths] + [content + more for more in (b"\0", b" ", content)]:
        path.write_bytes(broken)
        refused(path)


def test_every_flipped_bit_is_refused(path, content):
    rng = np.random.default_rng(2)
    start = 8 + header_length(content)
    in_header, in_arrays = rng.integers(0, start, FLIPS // 2), rng.integers(start, len(content), FLIPS // 2)
    for place, bit in zip([*in_header, *in_arrays], rng.integers(0, 8, FLIPS).tolist(), strict=True):
        broken = bytearray(content)
        broken[place] ^= 1 << bit
        path.write_bytes(broken)
        refused(path)


def test_the_digest_detects_damage_that_safetensors_accepts(path, content):
    broken = bytearray(content)
    broken[-1] ^= 1
    for damaged in (bytes(broken), content.replace(b"sRGB", b"aRGB")):
        path.write_bytes(damaged)
        assert load_file(path)
        refused(path, "cube-damaged")


@pytest.mark.parametrize("length", [0, 1, 7, 1 << 20, 1 << 31, (1 << 63) - 1, (1 << 64) - 1])
def test_forged_header_lengths_are_refused(path, content, length):
    path.write_bytes(with_header_length(content, length))
    refused(path)


@pytest.mark.parametrize("by", [-8, -1, 1, 8])
def test_slightly_wrong_header_lengths_are_refused(path, content, by):
    path.write_bytes(with_header_length(content, header_length(content) + by))
    refused(path)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        (b'"F64"', b'"BF16"'),
        (b'"F64"', b'"F8_E4M3"'),
        (b'"F64"', b'"I64"'),
        (b'"F64"', b'"C64"'),
        (b'"F64"', b'"???"'),
        (b"[512,9]", b"[9,512]"),
        (b"[512,9]", b"[-512,-9]"),
        (b"[512,9]", b"[4294967296,4294967296]"),
    ],
)
def test_forged_headers_are_refused(path, content, old, new):
    text = content[8 : 8 + header_length(content)]
    assert old in text
    path.write_bytes(with_header(content, text.replace(old, new)))
    refused(path)
    path.write_bytes(with_header(content, b'{"a":' * 100_000))
    refused(path)


@pytest.mark.parametrize("version", [0, 2, 99, "3", None])
def test_the_error_names_both_format_versions(data, tmp_path, version):
    path = forge(data, tmp_path / "cube", lambda tensors, metadata: metadata.update(version=version))
    error = refused(path, "cube-version")
    assert str(version) in error.problem
    assert str(VERSION) in error.problem


def test_an_unchanged_forgery_is_read(data, tmp_path):
    assert_same(read(forge(data, tmp_path / "cube", lambda tensors, metadata: None)), data)


@pytest.mark.parametrize("name", [name for name in ARRAYS if name not in ("points", "sensor.sensitivities")])
def test_arrays_that_are_missing_or_of_another_form_are_refused(data, tmp_path, name):
    def remove(tensors, metadata):
        del tensors[name]

    def cut(tensors, metadata):
        tensors[name] = tensors[name][:-1]

    def convert(tensors, metadata):
        tensors[name] = tensors[name].astype(np.float16)

    for change in (remove, cut, convert):
        refused(forge(data, tmp_path / "cube", change), "cube-invalid")


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 1e31])
@pytest.mark.parametrize("name", [name for name in ARRAYS if ARRAYS[name].types[0].startswith("float")])
def test_numbers_that_are_not_finite_are_refused(data, forged, name, value):
    if name != "sensor.sensitivities":
        forged(name, with_value(value, -1))


@pytest.mark.parametrize("name", [name for name in ARRAYS if ARRAYS[name].low == 0 and name != "sensor.sensitivities"])
def test_negative_numbers_are_refused(forged, name):
    forged(name, with_value(-1e-30, 0))


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("nodes", lambda array: array / 2),
        ("nodes", lambda array: array[::-1]),
        ("nodes", lambda array: np.array(0.5)),
        ("status", with_value(len(Status))),
        ("status", with_value(Status.ABSENT)),
        ("entry", with_value(-2)),
        ("entry", with_value(23)),
        ("sensor.power", lambda array: 0 * array),
        ("sensor.cmfs", lambda array: 2 * array[::-1]),
        ("sensor.xyz_to_rgb", lambda array: array[[0, 0, 0]]),
        ("sensor.decoding", lambda array: array[::-1]),
        ("sensor.wavelengths", lambda array: array[::-1]),
        ("atlas.rgb", lambda array: array + 1),
        ("atlas.reach", lambda array: array + 1),
        ("atlas.measured", lambda array: array + 1),
    ],
)
def test_arrays_that_break_lookups_are_refused(data, forged, name, change):
    assert len(data.atlas.names) == 23
    forged(name, change)


MODELS = [
    {"name": "spline"},
    {"count": 9},
    {"name": "moments", "count": 9},
    {"name": "moments", "count": 8, "phase": {"start": 380.0, "end": 780.0, "warp": "none"}},
    {"name": "moments", "count": 99, "phase": {"start": 380.0, "end": 780.0, "warp": "none"}},
    {"name": "moments", "count": 9, "phase": {"start": 780.0, "end": 380.0, "warp": "none"}},
    {"name": "moments", "count": 9, "phase": {"start": 380.0, "end": 780.0, "warp": "bent"}},
    {"name": "sigmoid", "start": 380.0, "end": 780.0},
]


@pytest.mark.parametrize("model", MODELS)
def test_unknown_models_are_refused(data, tmp_path, model):
    path = forge(data, tmp_path / "cube", lambda tensors, metadata: metadata.update(model=model))
    refused(path, "cube-invalid")


@pytest.mark.parametrize(
    "model",
    [
        *MODELS,
        {"name": "moments", "count": 17, "phase": {"start": 400.0, "end": 780.0, "warp": "none"}},
        {"name": "moments", "count": 17, "phase": {"start": 380.0, "end": 780.0, "warp": "vision"}},
    ],
)
def test_models_of_entries_that_do_not_extend_that_of_nodes_are_refused(data, tmp_path, model):
    def change(tensors, metadata):
        metadata["entry_model"] = model
        tensors["atlas.entry_coefficients"] = np.full((23, model.get("count", 3)), 0.1)

    refused(forge(data, tmp_path / "cube", change), "cube-invalid")


@pytest.mark.parametrize("ends", [(380.0, 380.0), (None, 780.0), (380.0, float("nan"))])
def test_sigmoids_without_a_range_are_refused(small_sigmoid_cube, tmp_path, ends):
    model = {"name": "sigmoid", "start": ends[0], "end": ends[1]}

    def change(tensors, metadata):
        metadata.update(model=model, entry_model=model)

    refused(forge(small_sigmoid_cube.data, tmp_path / "cube", change), "cube-invalid", "not-a-cube")


def test_a_cube_of_format_3_is_read_and_written_in_the_present_format(tmp_path):
    """Its entries have as many coefficients as its nodes."""
    data = read(FORMAT_3)
    assert data.entry_spectra.model == data.model == Moments(9, Phase(380.0, 780.0))
    assert data.entry_spectra.coefficients is data.atlas.coefficients
    assert len(data.atlas.names) == 23
    write(data, tmp_path / "cube.uplift")
    assert_same(read(tmp_path / "cube.uplift"), data)
    assert f'\\"version\\":{VERSION}'.encode() in (tmp_path / "cube.uplift").read_bytes()


def test_the_stored_cubes_are_read(repository):
    cubes = sorted((repository / "cubes").glob("*.uplift"))
    assert len(cubes) == 8
    for path in cubes:
        write_again = digest(read(path))
        assert f'\\"digest\\":\\"{write_again}\\"'.encode() in path.read_bytes()


@pytest.mark.parametrize(
    "provenance", [{"options": {"within": float("nan")}}, {"options": {"within": 1e999}}, {"a": {1, 2}}]
)
def test_a_cube_that_cannot_be_read_back_leaves_the_old_file(data, path, content, provenance):
    with raises(OutputError, "cube-unreadable"):
        write(dataclasses.replace(data, provenance=provenance), path, force=True)
    assert path.read_bytes() == content
    assert list(path.parent.iterdir()) == [path]


def test_files_are_read_back_before_they_replace_another(data, path, content, monkeypatch):
    monkeypatch.setattr(container, "save", lambda tensors, metadata, path: path.write_bytes(content[:-1] + b"x"))
    with raises(OutputError, "cube-unreadable"):
        write(data, path, force=True)
    assert path.read_bytes() == content
