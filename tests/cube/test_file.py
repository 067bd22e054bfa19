"""Cube files: everything written is read back, and all other files are refused."""

import dataclasses

import numpy as np
import pytest
from safetensors.numpy import save_file

from tests.cube.cube_files import forge, header_length, with_header
from tests.cube.hand_made import with_outside
from tests.helpers import raises
from uplift.common.errors import CubeFileError, OutputError
from uplift.cube.container import KEY
from uplift.cube.file import VERSION, read, write
from uplift.cube.schema import ARRAYS, MAX_LIGHTS, METADATA
from uplift.lattice.point_table import Status

FLIPS = 500
CUTS = 60
STORED = [name for name in ARRAYS if name not in ("points", "sensor.sensitivities")]
"""Arrays of the cube of these tests."""


@pytest.fixture
def data(small_cube, plain_cube):
    outside = with_outside(small_cube.data)
    return dataclasses.replace(outside, families=plain_cube.data.families)


@pytest.fixture
def path(data, tmp_path):
    path = tmp_path / "cube.uplift"
    write(data, path)
    return path


@pytest.fixture
def content(path):
    return path.read_bytes()


def refused(path, *codes):
    """The error of reading a file: one line, located at the file, with a hint and one
    of ``codes``, if given.
    """
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
    """Change one array of the cube, with a valid digest, and return the error of
    reading it.
    """

    def forged(name, change):
        def apply(tensors, metadata):
            tensors[name] = change(tensors[name].copy())

        return refused(forge(data, tmp_path / "cube", apply), "cube-file")

    return forged


def with_value(value, place=7):
    def change(array):
        array.flat[place] = value
        return array

    return change


def test_missing_files_folders_and_devices_are_refused(tmp_path):
    refused(tmp_path / "none.uplift", "file-not-found")
    for path in (tmp_path, "/dev/zero"):
        refused(path, "file-unreadable")


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"\0" * 8,
        b"\xff" * 64,
        b"{}",
        b"Some text, and long enough to be a header length\n",
    ],
)
def test_files_of_other_formats_are_refused(tmp_path, content):
    path = tmp_path / "other"
    path.write_bytes(content)
    refused(path, "not-a-cube")


@pytest.mark.parametrize(
    "metadata",
    [None, {}, {"other": "1"}, {KEY: "{}"}, {KEY: "[]"}, {KEY: "null"}, {KEY: "{"}],
)
def test_other_safetensors_files_are_refused(tmp_path, metadata):
    path = tmp_path / "other.safetensors"
    save_file({"weights": np.zeros((2, 2))}, path, metadata=metadata)
    refused(path, "not-a-cube")


def test_truncated_and_longer_files_are_refused(path, content):
    rng = np.random.default_rng(1)
    lengths = {
        *range(0, 16),
        *rng.integers(0, len(content), CUTS).tolist(),
        len(content) - 1,
    }
    for broken in [content[:length] for length in lengths] + [
        content + more for more in (b"\0", b" ", content)
    ]:
        path.write_bytes(broken)
        refused(path)


def test_every_flipped_bit_is_refused(path, content):
    rng = np.random.default_rng(2)
    start = 8 + header_length(content)
    in_header = rng.integers(0, start, FLIPS // 2)
    in_arrays = rng.integers(start, len(content), FLIPS // 2)
    for place, bit in zip(
        [*in_header, *in_arrays], rng.integers(0, 8, FLIPS).tolist(), strict=True
    ):
        broken = bytearray(content)
        broken[place] ^= 1 << bit
        path.write_bytes(broken)
        refused(path)


HEADERS = [
    (b'"F64"', kind) for kind in (b'"BF16"', b'"F8_E4M3"', b'"I64"', b'"C64"', b'"???"')
]
HEADERS += [
    (b"[512,9]", shape)
    for shape in (b"[9,512]", b"[-512,-9]", b"[4294967296,4294967296]")
]
HEADERS += [(b'"F64"', b'{"a":' * 100_000)]


@pytest.mark.parametrize(("old", "new"), HEADERS, ids=lambda text: text[:20].decode())
def test_forged_headers_are_refused(path, content, old, new):
    text = content[8 : 8 + header_length(content)]
    assert old in text
    path.write_bytes(with_header(content, text.replace(old, new)))
    refused(path)


@pytest.mark.parametrize("version", [0, 2, 99, "3", None])
def test_the_error_names_both_format_versions(data, tmp_path, version):
    path = forge(
        data,
        tmp_path / "cube",
        lambda tensors, metadata: metadata.update(version=version),
    )
    error = refused(path, "cube-version")
    assert str(version) in error.problem
    assert str(VERSION) in error.problem


@pytest.mark.parametrize("provenance", [{"uplift": "9.8.7"}, {}, {"uplift": 3}, None])
def test_an_unknown_feature_is_refused_with_the_version_that_wrote_it(
    data, tmp_path, provenance
):
    def change(tensors, metadata):
        metadata["features"] += ["polarised"]
        metadata["provenance"] = provenance

    path = forge(data, tmp_path / "cube", change)
    error = refused(path, "cube-feature")
    assert "polarised" in error.problem
    assert ("9.8.7" in error.hint) == (provenance == {"uplift": "9.8.7"})


@pytest.mark.parametrize("name", STORED)
def test_arrays_that_are_missing_or_of_another_form_are_refused(data, tmp_path, name):
    def remove(tensors, metadata):
        del tensors[name]

    def cut(tensors, metadata):
        tensors[name] = tensors[name][:-1]

    def convert(tensors, metadata):
        tensors[name] = tensors[name].astype(np.uint8 if name == "round" else np.int16)

    for change in (remove, cut, convert):
        refused(forge(data, tmp_path / "cube", change), "cube-file")


@pytest.mark.parametrize("name", STORED)
def test_numbers_out_of_range_are_refused(forged, name):
    stored = ARRAYS[name]
    kind = np.dtype(stored.types[0])
    limits = (
        (np.iinfo(kind).min, np.iinfo(kind).max) if kind.kind in "iu" else (-1e31, 1e31)
    )
    values = [limits[0]] if stored.low > limits[0] else []
    values += [limits[1]] if stored.high < limits[1] else []
    values += [-1e-30] if kind.kind == "f" and stored.low == 0 else []
    values += [np.nan] if kind.kind == "f" else []
    assert values or name in ("round", "families.family")
    for value in values:
        forged(name, with_value(value, -1))


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("nodes", lambda array: array / 2),
        ("nodes", lambda array: array[::-1]),
        ("status", with_value(Status.ABSENT)),
        ("entry", with_value(23)),
        ("sensor.power", lambda array: 0 * array),
        ("sensor.cmfs", lambda array: 2 * array[::-1]),
        ("sensor.xyz_to_rgb", lambda array: array[[0, 0, 0]]),
        ("sensor.decoding", lambda array: array[::-1]),
        ("sensor.wavelengths", lambda array: 1e3 * array),
        ("sensor.wavelengths", lambda array: 1e-6 * array),
        ("sensor.wavelengths", lambda array: 1.5 * array),
        ("sensor.wavelengths", lambda array: array + 1),
        ("sensor.wavelengths", with_value(421, 8)),
    ],
)
def test_arrays_that_break_lookups_are_refused(data, forged, name, change):
    assert len(data.atlas.names) == 23
    forged(name, change)


PHASE = {"start": 380.0, "end": 780.0, "warp": "none"}
MODELS = [
    {"name": "spline"},
    {"name": "moments", "count": 8, "phase": PHASE},
    {"name": "moments", "count": 9, "phase": {**PHASE, "start": 800.0}},
    {"name": "moments", "count": 9, "phase": {**PHASE, "warp": "bent"}},
    {"name": "sigmoid", "start": 380.0, "end": 780.0},
]


@pytest.mark.parametrize("model", MODELS)
def test_unknown_models_are_refused(data, tmp_path, model):
    path = forge(
        data,
        tmp_path / "cube",
        lambda tensors, metadata: metadata.update(model=model, entry_model=model),
    )
    refused(path, "cube-file")


@pytest.fixture
def refused_metadata(data, tmp_path):
    """Read the cube after a change of its metadata, and return the problem."""
    return lambda change: (
        refused(
            forge(data, tmp_path / "cube", lambda tensors, metadata: change(metadata)),
            "cube-file",
        ).problem
    )


@pytest.mark.parametrize(
    "key", [key for key in METADATA if key not in ("format", "version")]
)
def test_metadata_that_are_missing_or_of_another_type_are_named(refused_metadata, key):
    assert key in refused_metadata(lambda metadata: metadata.pop(key))
    for value in (None, 10**400, [{}], {"options": 1}, "x" * 2000, True):
        assert f"metadata.{key}" in refused_metadata(
            lambda metadata, value=value: metadata.update({key: value})
        )


@pytest.mark.parametrize(
    "provenance",
    [
        {"options": "dim 8"},
        {"improvements": [{"step": "a", "tried": 1.0, "mended": 1}]},
        {
            "looks": [
                {
                    "name": "a",
                    "rgb": [0, 0, 0],
                    "weight": 1,
                    "lights": [{}] * (MAX_LIGHTS + 1),
                }
            ]
        },
        {"scene": "photo.png"},
        *({"options": {"shortest": value}} for value in ("380", None, [380], {})),
        *({"options": {"lights": value}} for value in ({}, [{}], [None])),
    ],
)
def test_provenance_of_another_type_is_refused(refused_metadata, provenance):
    key = f"metadata.provenance.{next(iter(provenance))}"
    assert key in refused_metadata(
        lambda metadata: metadata["provenance"].update(provenance)
    )


@pytest.mark.parametrize(
    ("key", "value"),
    [
        *(("threshold", value) for value in (0, 5e-324, 1e-13, 0.2, -1e-4)),
        ("dim", 7),
        ("entries", ["grey"] * 23),
        ("features", ["camera"]),
        ("model", {"name": "moments", "count": 9.0, "phase": PHASE}),
        ("\x1b]0;title\x07", 1),
    ],
)
def test_metadata_out_of_range_are_refused(refused_metadata, key, value):
    refused_metadata(lambda metadata: metadata.update({key: value}))


def nested(depth):
    return '{"a":' * depth + "1" + "}" * depth


@pytest.mark.parametrize(
    "value", [nested(40), nested(100_000), r'{"\ud800": 1}', "NaN", "1e999", "9" * 5000]
)
def test_json_beyond_the_limits_is_refused_before_the_digest(tmp_path, value):
    text = f'{{"format":"uplift cube","version":3,"a":{value}}}'
    save_file({"nodes": np.zeros(2)}, tmp_path / "cube", metadata={KEY: text})
    refused(tmp_path / "cube", "not-a-cube")


def test_unknown_provenance_of_later_versions_is_kept(data, tmp_path):
    later = {"a": [1, None, True]}
    path = forge(
        data,
        tmp_path / "cube",
        lambda tensors, metadata: metadata["provenance"].update(later=later),
    )
    assert read(path).provenance["later"] == later


@pytest.mark.parametrize(
    "provenance",
    [
        {"options": {"within": float("nan")}},
        {"options": {"within": 1e999}},
        {"a": {1, 2}},
    ],
)
def test_a_cube_that_cannot_be_read_back_leaves_the_old_file(
    data, path, content, provenance
):
    with raises(OutputError, "output"):
        write(dataclasses.replace(data, provenance=provenance), path, force=True)
    assert path.read_bytes() == content
    assert list(path.parent.iterdir()) == [path]
