"""Cube files: everything written is read back, and all other files are refused."""

import dataclasses

import numpy as np
import pytest
from safetensors.numpy import save_file

from tests.cube.cube_files import forge, header_length
from tests.helpers import raises, with_points
from uplift.common.errors import CubeFileError, OutputError
from uplift.cube.container import KEY
from uplift.cube.file import VERSION, read, write
from uplift.cube.schema import ARRAYS, MAX_LIGHTS, METADATA
from uplift.lattice.point_table import Status

FLIPS = 60
STORED = [name for name in ARRAYS if name not in ("points", "sensor.sensitivities")]
"""Arrays of the cube of these tests."""


@pytest.fixture
def data(small_cube, cyan_cube, plain_cube):
    data = dataclasses.replace(cyan_cube.data, families=plain_cube.data.families)
    return with_points(data, round=small_cube.data.points.round)


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
    [b"", b"\0" * 8, b"\xff" * 64, b"{}", b"Text, long enough for a header\n"],
)
def test_files_of_other_formats_are_refused(tmp_path, content):
    path = tmp_path / "other"
    path.write_bytes(content)
    refused(path, "not-a-cube")


def nested(depth):
    return '{"a":' * depth + "1" + "}" * depth


def cube_with(value):
    return f'{{"format":"uplift cube","version":{VERSION},"a":{value}}}'


JSON = ["{}", "[]", "null", "{", *map(cube_with, (nested(40), nested(100_000)))]
JSON += map(cube_with, (r'{"\ud800": 1}', "NaN", "1e999", "9" * 5000))


@pytest.mark.parametrize(
    "metadata", [None, {"other": "1"}, *({KEY: text} for text in JSON)]
)
def test_other_safetensors_files_are_refused(tmp_path, metadata):
    """JSON beyond the limits is refused before the digest."""
    path = tmp_path / "other.safetensors"
    save_file({"weights": np.zeros((2, 2))}, path, metadata=metadata)
    refused(path, "not-a-cube")


def test_truncated_longer_and_damaged_files_are_refused(path, content):
    """Of every part, any flipped bit."""
    rng = np.random.default_rng(2)
    start = 8 + header_length(content)
    broken = [content[:length] for length in (*range(16), start, len(content) - 1)]
    broken += [content + more for more in (b"\0", content)]
    for first, last in ((0, 8), (8, start), (start, len(content))):
        for place in rng.integers(first, last, FLIPS):
            flipped = bytearray(content)
            flipped[place] ^= 1 << rng.integers(8)
            broken.append(flipped)
    for other in broken:
        path.write_bytes(other)
        refused(path)


@pytest.fixture
def refused_metadata(data, tmp_path):
    """Read the cube after a change of its metadata, and return the error."""

    def refused_metadata(change, code="cube-file"):
        path = forge(data, tmp_path / "cube", lambda _, metadata: change(metadata))
        return refused(path, code)

    return refused_metadata


@pytest.mark.parametrize("version", [0, 2, 99, "3", None])
def test_the_error_names_both_format_versions(refused_metadata, version):
    error = refused_metadata(
        lambda metadata: metadata.update(version=version), "cube-version"
    )
    assert str(version) in error.problem
    assert str(VERSION) in error.problem


@pytest.mark.parametrize("provenance", [{"uplift": "9.8.7"}, {}, {"uplift": 3}, None])
def test_an_unknown_feature_is_refused_with_the_version_that_wrote_it(
    refused_metadata, provenance
):
    change = {"features": ["polarised"], "provenance": provenance}
    error = refused_metadata(lambda metadata: metadata.update(change), "cube-feature")
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
    if kind.kind == "f":
        values = {-1e31, 1e31, np.nan, -1e-30 if stored.low == 0 else np.nan}
    else:
        limits = {np.iinfo(kind).min, np.iinfo(kind).max}
        values = {limit for limit in limits if not stored.low <= limit <= stored.high}
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
        ("sensor.wavelengths", lambda array: 1e-6 * array),
        ("sensor.wavelengths", lambda array: array + 1),
        ("sensor.wavelengths", with_value(421, 8)),
    ],
)
def test_arrays_that_break_lookups_are_refused(data, forged, name, change):
    assert len(data.atlas.names) == 23
    forged(name, change)


PHASE = {"start": 380.0, "end": 780.0, "warp": "none"}
VISION = {**PHASE, "warp": "vision"}
MODELS = [
    {"name": "spline"},
    {"name": "moments", "count": 8, "phase": PHASE},
    {"name": "moments", "count": 9, "phase": {**PHASE, "start": 800.0}},
    {"name": "moments", "count": 9, "phase": {**PHASE, "warp": "bent"}},
    {"name": "sigmoid", "start": 380.0, "end": 780.0},
]


@pytest.mark.parametrize(
    "key", [key for key in METADATA if key not in ("format", "version")]
)
def test_metadata_that_are_missing_or_of_another_type_are_named(refused_metadata, key):
    assert key in refused_metadata(lambda metadata: metadata.pop(key)).problem
    for value in (None, 10**400, [{}], {"options": 1}, "x" * 2000, True):
        error = refused_metadata(
            lambda metadata, value=value: metadata.update({key: value})
        )
        assert f"metadata.{key}" in error.problem


LIGHTS = [{}] * (MAX_LIGHTS + 1)
PROVENANCE = [
    {"options": "dim 8"},
    {"options": {"shortest": None}},
    {"options": {"lights": [{}]}},
    {"improvements": [{"step": "a", "tried": 1.0, "mended": 1}]},
    {"looks": [{"name": "a", "rgb": [0, 0, 0], "weight": 1, "lights": LIGHTS}]},
    {"scene": "photo.png"},
]


@pytest.mark.parametrize(
    "values",
    [
        *({"threshold": value} for value in (0, 5e-324, 1e-13, 0.2, -1e-4)),
        *({"model": model, "entry_model": model} for model in MODELS),
        *({"provenance": value} for value in PROVENANCE),
        {"entry_model": {"name": "moments", "count": 7, "phase": PHASE}},
        {"entry_model": {"name": "moments", "count": 9, "phase": VISION}},
        {"dim": 7},
        {"entries": ["grey"] * 23},
        {"features": ["camera"]},
        {"model": {"name": "moments", "count": 9.0, "phase": PHASE}},
        {"\x1b]0;title\x07": 1},
    ],
    ids=str,
)
def test_metadata_out_of_range_are_refused(refused_metadata, values):
    refused_metadata(lambda metadata: metadata.update(values))


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
