"""Patterns of images: wildcards and UDIM tiles."""

from __future__ import annotations

from pathlib import Path

import pytest
from uplift_cli.params.image_paths import expand_patterns, texture_paths

from tests.helpers import raises
from uplift.common.errors import OutputError, TextureError


@pytest.fixture
def tiles(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("wood.1001.png", "wood.1012.png", "wood.0999.png", "wood.10011.png", "wood.txt"):
        (tmp_path / name).touch()
    return tmp_path


@pytest.mark.usefixtures("tiles")
def test_tiles_are_found_and_numbered():
    assert expand_patterns(["wood.<UDIM>.png"]) == ["wood.1001.png", "wood.1012.png"]
    pairs = texture_paths(["wood.<UDIM>.png"], "out.<UDIM>.exr")
    assert pairs == [
        (Path("wood.1001.png"), Path("out.1001.exr")),
        (Path("wood.1012.png"), Path("out.1012.exr")),
    ]
    assert texture_paths(["wood.<UDIM>.png"], "folder")[0][1] == Path("folder/wood.1001.exr")


@pytest.mark.usefixtures("tiles")
def test_patterns_of_tiles_that_do_not_fit_raise():
    with raises(TextureError, "no-match"):
        expand_patterns(["stone.<UDIM>.png"])
    for sources, target in (
        (["wood.1001.png"], "out.<UDIM>.exr"),
        (["wood.<UDIM>.png"] * 2, "out.<UDIM>.exr"),
        (["wood.<UDIM>.png"], "<UDIM>.<UDIM>.exr"),
        (["w*.<UDIM>.png"], "out.<UDIM>.exr"),
    ):
        with raises(OutputError, "udim-mismatch"):
            texture_paths(sources, target)
