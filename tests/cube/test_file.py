"""Cube files: everything written is read back, and all other files are refused."""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path

import numpy as np
import pytest
from safetensors.numpy import load_file, save_file

from tests.cube.cube_files import forge, header_length, with_header, with_header_length
from tests.helpers import raises, with_points
from uplift.common.errors import CubeFileError, OutputError
from uplift.cube import container, digest, read, write
from uplift.cube.container import KEY
from uplift.cube.file import POINT_TYPES, SENSOR_ARRAYS, VERSION
from uplift.lattice import Status
from uplift.models import Moments, Phase

FLIPS, CUTS = 1500, 200


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
    assert "\n" not in str(error)
    assert error.hint
    assert not codes or error.code in codes, f"{error.code}: {error}"
    return error


def assert_same(one, other):
    for name in POINT_TYPES:
        assert_same_array(getattr(one.points, name), getattr(other.points, name))
    for name in SENSOR_ARRAYS:
        assert_same_array(getattr(one.sensor, name), getattr(other.sensor, name))
    for name in ("space", "illuminant", "observer"):
        assert getattr(one.sensor, name) == getattr(other.sensor, name)
    assert_same_array(one.lattice.nodes, other.lattice.nodes)
    assert_same_array(one.atlas.rgb, other.atlas.rgb)
    assert_same_array(one.atlas.coefficients, other.atlas.coefficients)
    assert_same_array(one.entry_spectra.coefficients, other.entry_spectra.coefficients)
    assert one.entry_spectra.model == other.entry_spectra.model
    assert one.atlas.names == other.atlas.names
    assert one.model == other.model
    assert one.threshold == other.threshold
    assert one.provenance == other.provenance


def assert_same_array(one, other):
    if one is None or other is None:
        assert one is other
        return
    assert one.dtype == other.dtype
    np.testing.assert_array_equal(one, other)


def test_every_field_is_read_back(data, path):
    assert_same(read(path), data)


def test_without_debug_information_there_is_no_round(data, tmp_path):
    plain = with_points(data, round=None)
    write(plain, tmp_path / "plain.uplift")
    assert_same(read(tmp_path / "plain.uplift"), plain)


def test_sigmoid_without_an_atlas_is_read_back(small_sigmoid_cube, tmp_path):
    write(small_sigmoid_cube.data, tmp_path / "sigmoid.uplift")
    found = read(tmp_path / "sigmoid.uplift")
    assert_same(found, small_sigmoid_cube.data)
    assert found.atlas.names == ()


def test_names_in_any_script_are_read_back(data, tmp_path):
    names = ("grün 'ü' \"q\" \\ \n \u2028 👍", *data.atlas.names[1:])
    renamed = dataclasses.replace(data, atlas=dataclasses.replace(data.atlas, names=names))
    write(renamed, tmp_path / "cube.uplift")
    assert read(tmp_path / "cube.uplift").atlas.names == names


def test_the_same_cube_gives_the_same_bytes(data, content, tmp_path):
    write(data, tmp_path / "again.uplift")
    write(read(tmp_path / "again.uplift"), tmp_path / "thrice.uplift")
    assert (tmp_path / "again.uplift").read_bytes() == content
    assert (tmp_path / "thrice.uplift").read_bytes() == content


def test_an_existing_file_is_replaced_with_force_only(data, path, content):
    with raises(OutputError, "file-exists"):
        write(data, path)
    write(data, path, force=True)
    assert path.read_bytes() == content


@pytest.mark.parametrize("name", [*POINT_TYPES, "nodes", "atlas", "spectra", "sensor", "threshold", "provenance"])
def test_the_digest_changes_with_any_content(data, name):
    assert digest(changed(data, name)) != digest(data)


def changed(data, name):
    """The cube with one number of the field ``name`` changed by the smallest amount."""
    if name == "nodes":
        return dataclasses.replace(data, lattice=dataclasses.replace(data.lattice, nodes=nudged(data.lattice.nodes)))
    if name == "atlas":
        return dataclasses.replace(data, atlas=dataclasses.replace(data.atlas, rgb=nudged(data.atlas.rgb)))
    if name == "spectra":
        spectra = dataclasses.replace(data.atlas.spectra, coefficients=nudged(data.atlas.spectra.coefficients))
        return dataclasses.replace(data, atlas=dataclasses.replace(data.atlas, spectra=spectra))
    if name == "sensor":
        return dataclasses.replace(data, sensor=dataclasses.replace(data.sensor, cmfs=nudged(data.sensor.cmfs)))
    if name == "threshold":
        return dataclasses.replace(data, threshold=float(np.nextafter(data.threshold, 1)))
    if name == "provenance":
        return dataclasses.replace(data, provenance={**data.provenance, "uplift": "0.0.0"})
    return with_points(data, **{name: nudged(getattr(data.points, name))})


def nudged(array):
    array = array.copy()
    place = tuple(np.array(array.shape) // 2)
    array[place] = array[place] + 1 if array.dtype.kind in "iu" else np.nextafter(array[place], array.dtype.type(9))
    return array


def test_the_digest_is_that_of_the_file(data, path):
    assert digest(read(path)) == digest(data)
    assert json.loads(header(path.read_bytes())["__metadata__"][KEY])["digest"] == digest(data)


def header(content):
    return json.loads(content[8 : 8 + header_length(content)])


def test_a_missing_file_is_reported(tmp_path):
    refused(tmp_path / "none.uplift", "cube-not-found")


@pytest.mark.parametrize("name", ["a\0b", "x" * 300, "file/cube"])
def test_impossible_file_names_are_missing_files(tmp_path, name):
    (tmp_path / "file").write_text("")
    refused(tmp_path / name, "cube-not-found")


@pytest.mark.parametrize(
    "content", [b"", b"\0" * 8, b"\xff" * 64, b"{}", b"Some text, and long enough to be a header length\n"]
)
def test_files_of_other_formats_are_refused(tmp_path, content):
    path = tmp_path / "other"
    path.write_bytes(content)
    refused(path, "not-a-cube")


def test_truncated_files_are_refused(path, content):
    rng = np.random.default_rng(1)
    lengths = {*range(0, 16), *rng.integers(0, len(content), CUTS).tolist(), len(content) - 1}
    for length in lengths:
        path.write_bytes(content[:length])
        refused(path)


def test_appended_bytes_are_refused(path, content):
    for more in (b"\0", b" ", content):
        path.write_bytes(content + more)
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
    for place in (8 + header_length(content), len(content) - 1):
        broken = bytearray(content)
        broken[place] ^= 1
        path.write_bytes(broken)
        assert load_file(path).keys() == load_file_keys(content)
        refused(path, "cube-damaged")


def load_file_keys(content):
    return header(content).keys() - {"__metadata__"}


def test_the_digest_detects_changed_metadata(path, content):
    path.write_bytes(content.replace(b"sRGB", b"aRGB"))
    refused(path, "cube-damaged")


@pytest.mark.parametrize("length", [0, 1, 2, 7, 1 << 20, 1 << 31, (1 << 63) - 1, (1 << 64) - 1])
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


def test_a_deeply_nested_header_is_refused(path, content):
    path.write_bytes(with_header(content, b'{"a":' * 100_000))
    refused(path)


@pytest.mark.parametrize("metadata", [None, {}, {"other": "1"}, {KEY: "{}"}, {KEY: "[]"}, {KEY: "3"}, {KEY: "null"}])
def test_other_safetensors_files_are_refused(tmp_path, metadata):
    path = tmp_path / "other.safetensors"
    save_file({"weights": np.zeros((2, 2))}, path, metadata=metadata)
    refused(path, "not-a-cube")


@pytest.mark.parametrize("text", ["", "{", "[" * 100_000, '"\ud800"'.encode("utf-8", "replace").decode()])
def test_metadata_that_is_not_a_json_table_is_refused(tmp_path, text):
    save_file({"weights": np.zeros(2)}, tmp_path / "other.safetensors", metadata={KEY: text})
    refused(tmp_path / "other.safetensors")


@pytest.mark.parametrize("version", [0, 2, 99, "3", None])
def test_the_error_names_both_format_versions(data, tmp_path, version):
    path = forge(data, tmp_path / "cube", lambda tensors, metadata: metadata.update(version=version))
    error = refused(path, "cube-version")
    assert str(version) in error.problem
    assert str(VERSION) in error.problem


def test_an_unchanged_forgery_is_read(data, tmp_path):
    assert_same(read(forge(data, tmp_path / "cube", lambda tensors, metadata: None)), data)


@pytest.mark.parametrize("name", ["nodes", "atlas.rgb", "atlas.entry_coefficients", "sensor.power", *POINT_TYPES])
def test_a_missing_array_is_named(data, tmp_path, name):
    path = forge(data, tmp_path / "cube", lambda tensors, metadata: tensors.pop(name))
    error = refused(path, "cube-invalid")
    assert repr(name) in error.problem


@pytest.mark.parametrize("key", ["features", "model", "entry_model", "space", "threshold", "entries", "provenance"])
def test_missing_metadata_is_named(data, tmp_path, key):
    path = forge(data, tmp_path / "cube", lambda tensors, metadata: metadata.pop(key))
    error = refused(path, "invalid-metadata")
    assert repr(key) in error.problem


@pytest.mark.parametrize(
    ("key", "values"),
    [
        ("features", [None, 3]),
        ("model", [None, 3, "text", [], [1], {"a": 1}]),
        ("entry_model", [None, 3, "text", [], [1], {"a": 1}]),
        ("threshold", [None, "text", [], {"a": 1}]),
        ("entries", [None, 3, "text", [], [1], {"a": 1}]),
        ("provenance", [None, 3, "text", [], [1]]),
    ],
)
def test_metadata_of_wrong_types_is_refused(data, tmp_path, key, values):
    for number, value in enumerate(values):

        def change(tensors, metadata, value=value):
            metadata[key] = value

        path = forge(data, tmp_path / f"cube-{number}", change)
        refused(path)


@pytest.mark.parametrize("name", [*POINT_TYPES, "atlas.rgb", "atlas.coefficients", "atlas.entry_coefficients", "nodes"])
def test_wrong_shapes_are_refused(data, tmp_path, name):
    def change(tensors, metadata):
        tensors[name] = tensors[name][:-1]

    refused(forge(data, tmp_path / "cube", change))


@pytest.mark.parametrize("name", [*SENSOR_ARRAYS])
def test_wrong_shapes_of_the_sensor_are_refused(data, tmp_path, name):
    def change(tensors, metadata):
        tensors[f"sensor.{name}"] = tensors[f"sensor.{name}"][:-1]

    refused(forge(data, tmp_path / "cube", change), "invalid-array")


@pytest.mark.parametrize("name", POINT_TYPES)
def test_wrong_types_are_refused(data, tmp_path, name):
    def change(tensors, metadata):
        tensors[name] = tensors[name].astype(np.float16)

    assert name in refused(forge(data, tmp_path / "cube", change), "invalid-array").problem


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize(
    "name",
    [
        "coefficients",
        "rgb",
        "distance",
        "atlas.rgb",
        "atlas.coefficients",
        "atlas.entry_coefficients",
        "atlas.reach",
        "sensor.power",
        "nodes",
    ],
)
def test_numbers_that_are_not_finite_are_refused(data, tmp_path, name, bad):
    def change(tensors, metadata):
        tensors[name] = tensors[name].copy()
        tensors[name].flat[-1] = bad

    refused(forge(data, tmp_path / "cube", change))


@pytest.mark.parametrize("threshold", [np.nan, np.inf, 0, 5e-324, 1e-13, 0.2, True, -1e-4, "a"])
def test_thresholds_out_of_range_are_refused(data, tmp_path, threshold):
    path = forge(data, tmp_path / "cube", lambda tensors, metadata: metadata.update(threshold=threshold))
    refused(path, "invalid-metadata", "not-a-cube")


@pytest.mark.parametrize("nodes", [[0.1, 1.0], [0.0, 0.9], [1.0, 0.0], [0.0, 0.0, 1.0], [1.0], [], 0.5])
def test_nodes_that_do_not_increase_from_0_to_1_are_refused(data, tmp_path, nodes):
    def change(tensors, metadata):
        tensors["nodes"] = np.array(nodes)

    refused(forge(data, tmp_path / "cube", change))


@pytest.mark.parametrize(
    "model",
    [
        {"name": "spline"},
        {"count": 9},
        {"name": "moments", "count": 9},
        {"name": "moments", "count": 8, "phase": {"start": 380.0, "end": 780.0, "warp": "none"}},
        {"name": "moments", "count": 99, "phase": {"start": 380.0, "end": 780.0, "warp": "none"}},
        {"name": "moments", "count": "9", "phase": {"start": 380.0, "end": 780.0, "warp": "none"}},
        {"name": "moments", "count": 9, "phase": {"start": 780.0, "end": 380.0, "warp": "none"}},
        {"name": "moments", "count": 9, "phase": {"start": 380.0, "end": 780.0, "warp": "bent"}},
        {"name": "moments", "count": 9, "phase": {"start": "a", "end": 780.0, "warp": "none"}},
        {"name": "moments", "count": 9, "phase": [380.0, 780.0]},
        {"name": "sigmoid", "start": 380.0, "end": 780.0},
    ],
)
def test_unknown_models_are_refused(data, tmp_path, model):
    path = forge(data, tmp_path / "cube", lambda tensors, metadata: metadata.update(model=model))
    refused(path)


@pytest.mark.parametrize(
    "change",
    [
        {"name": "sigmoid", "start": 380.0, "end": 780.0},
        {"name": "moments", "count": 8, "phase": {"start": 380.0, "end": 780.0, "warp": "none"}},
        {"name": "moments", "count": 17, "phase": {"start": 400.0, "end": 780.0, "warp": "none"}},
        {"name": "moments", "count": 17, "phase": {"start": 380.0, "end": 780.0, "warp": "vision"}},
    ],
)
def test_models_of_entries_that_do_not_extend_that_of_nodes_are_refused(data, tmp_path, change):
    def forged(tensors, metadata):
        metadata["entry_model"] = change
        tensors["atlas.entry_coefficients"] = np.full((23, change.get("count", 3)), 0.1)

    refused(forge(data, tmp_path / "cube", forged), "invalid-entry-model")


@pytest.mark.parametrize("ends", [(380.0, 380.0), ("a", 780.0), (None, 780.0), (380.0, float("nan"))])
def test_sigmoids_without_a_range_are_refused(small_sigmoid_cube, tmp_path, ends):
    model = {"name": "sigmoid", "start": ends[0], "end": ends[1]}
    path = forge(
        small_sigmoid_cube.data,
        tmp_path / "cube",
        lambda tensors, metadata: metadata.update(model=model, entry_model=model),
    )
    refused(path, "invalid-metadata", "invalid-model-range", "not-a-cube")


def test_an_unknown_status_is_refused(data, tmp_path):
    def change(tensors, metadata):
        tensors["status"] = tensors["status"].copy()
        tensors["status"][7] = len(Status)

    refused(forge(data, tmp_path / "cube", change), "unknown-status")


@pytest.mark.parametrize("row", [-2, 23])
def test_an_unknown_entry_is_refused(data, tmp_path, row):
    assert len(data.atlas.names) == 23

    def change(tensors, metadata):
        tensors["entry"] = tensors["entry"].copy()
        tensors["entry"][7] = row

    refused(forge(data, tmp_path / "cube", change), "unknown-entry")


def test_announced_debug_information_must_be_present(data, tmp_path):
    plain = with_points(data, round=None)
    path = forge(plain, tmp_path / "cube", lambda tensors, metadata: metadata.update(features=["debug"]))
    assert "'round'" in refused(path, "cube-invalid").problem


FORMAT_3 = Path(__file__).parent / "format-3.uplift"


def test_a_cube_of_format_3_is_read_and_written_in_the_present_format(tmp_path):
    """Its entries have as many coefficients as its nodes."""
    data = read(FORMAT_3)
    assert data.entry_spectra.model == data.model == Moments(9, Phase(380.0, 780.0))
    assert data.entry_spectra.coefficients is data.atlas.coefficients
    assert len(data.atlas.names) == 23
    write(data, tmp_path / "cube.uplift")
    assert_same(read(tmp_path / "cube.uplift"), data)
    assert f'\\"version\\":{VERSION}'.encode() in (tmp_path / "cube.uplift").read_bytes()


def test_damage_to_a_cube_of_format_3_is_detected(tmp_path):
    content = bytearray(FORMAT_3.read_bytes())
    content[-1] ^= 1
    (tmp_path / "cube.uplift").write_bytes(content)
    refused(tmp_path / "cube.uplift", "cube-damaged")


def test_the_stored_cubes_are_read(repository):
    cubes = sorted((repository / "cubes").glob("*.uplift"))
    assert len(cubes) == 8
    for path in cubes:
        write_again = digest(read(path))
        assert f'\\"digest\\":\\"{write_again}\\"'.encode() in path.read_bytes()


@pytest.mark.parametrize(
    ("name", "change", "code"),
    [
        ("sensor.power", lambda array: 0 * array, "invalid-white"),
        ("sensor.cmfs", lambda array: 2 * array[::-1], "invalid-white"),
        ("sensor.xyz_to_rgb", lambda array: array[[0, 0, 0]], "invalid-primaries"),
        ("sensor.decoding", lambda array: array[::-1], "invalid-decoding"),
        ("sensor.cmfs", lambda array: array.astype(np.float16), "invalid-array"),
        (
            "atlas.coefficients",
            lambda array: array.astype(np.complex64),
            "invalid-array",
        ),
        ("atlas.rgb", lambda array: array + 1, "entry-out-of-gamut"),
        ("coefficients", lambda array: np.full_like(array, 1e31), "array-not-finite"),
    ],
)
def test_arrays_that_break_lookups_are_refused(data, tmp_path, name, change, code):
    def forged(tensors, metadata):
        tensors[name] = change(tensors[name])

    refused(forge(data, tmp_path / "cube", forged), code)


@pytest.mark.parametrize("value", [float("nan"), float("inf"), [float("-inf")]])
def test_numbers_of_the_provenance_must_be_finite(data, tmp_path, value):
    path = forge(data, tmp_path / "cube", lambda tensors, metadata: metadata["provenance"].update(a=value))
    refused(path, "not-a-cube")


def test_integers_too_large_for_floats_are_refused(data, tmp_path):
    path = forge(data, tmp_path / "cube", lambda tensors, metadata: metadata.update(threshold=10**400))
    refused(path, "invalid-metadata")


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
