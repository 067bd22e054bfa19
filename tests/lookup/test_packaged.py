"""Names of the cubes of the package: files take precedence."""

from __future__ import annotations

import os

import pytest

from uplift.lookup.cube import DEFAULT, PACKAGED, find_file


@pytest.mark.parametrize("name", PACKAGED)
def test_names_stand_for_files_in_any_case(name):
    assert find_file(name) == find_file(name.upper()) == PACKAGED[name]
    assert os.path.isfile(PACKAGED[name])


@pytest.mark.parametrize("name", ["missing", "srgb.uplift", b"other"])
def test_other_paths_stay_what_they_are(name):
    assert find_file(name) is name


def test_files_take_precedence(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "srgb").write_bytes(PACKAGED["acescg"].read_bytes())
    assert find_file("srgb") == "srgb"
    assert find_file("sRGB") == DEFAULT
