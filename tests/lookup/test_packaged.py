"""Names of the files of the package: files take precedence, and the kind of a file is recognised."""

from __future__ import annotations

import os

import pytest

import uplift
from tests.helpers import raises
from uplift.common.errors import CubeFileError
from uplift.lookup.packaged import DEFAULT, EMISSION, PACKAGED, find_file, names_emission_table


@pytest.mark.parametrize("name", PACKAGED)
def test_names_stand_for_files_in_any_case(name):
    assert find_file(name) == find_file(name.upper()) == PACKAGED[name]
    assert os.path.isfile(PACKAGED[name])


@pytest.mark.parametrize("name", ["missing", "srgb.uplift", b"other"])
def test_other_paths_stay_what_they_are(name):
    assert find_file(name) is name


def test_files_take_precedence(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "srgb").write_bytes(EMISSION.read_bytes())
    assert find_file("srgb") == "srgb"
    assert names_emission_table("srgb")
    assert find_file("sRGB") == DEFAULT


def test_kinds_of_files_are_distinguished():
    assert [names_emission_table(name) for name in ("emission", "srgb", "missing")] == [True, False, False]
    with raises(CubeFileError, "not-an-emission-table"):
        uplift.load_emission("srgb")
    with raises(CubeFileError, "not-a-cube"):
        uplift.load("emission")
