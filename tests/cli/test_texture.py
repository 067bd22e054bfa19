"""``uplift texture``."""

import os
import re

import numpy as np
import OpenEXR
import pytest

from tests.extras.texture.conftest import planes, write_exr
from uplift.extras.texture.sequence import converter_for

from .conftest import warning_lines


@pytest.fixture
def frames(home):
    """Three frames of 6 × 5 pixels, the second out of gamut."""
    rng = np.random.default_rng(0)
    for frame in range(3):
        write_exr(
            home / f"shot.{frame}.exr",
            planes(rng.random((6, 5, 3)).astype(np.float32) + (frame == 1)),
        )
    return home


def test_one_image(run, refuse, frames, cubes):
    options = ("--cube", cubes / "moments-8.uplift", "--representation", "moments")
    result = run("texture shot.0.exr -o out.exr", *options)
    assert result.output.startswith("out.exr: 1 texture, 30 pixels, 0.0 MB, ")
    assert "moment.08" in OpenEXR.File("out.exr", separate_channels=True).channels()
    assert refuse("texture shot.0.exr -o out.exr", *options).code == "file-exists"
    result = run("texture shot.0.exr -o out.exr", *options, "--resume")
    assert result.output.startswith("out.exr: 0 textures, 1 skipped, ")
    assert run("texture shot.0.exr -o out.exr", *options, "--force", "-q").output == ""


def test_sequences_continue_after_an_invalid_image(run, shown, frames, cubes):
    (frames / "shot.2.exr").write_text("not an image")
    result = run(
        "texture shot.*.exr -o out --representation moments --processes 1 --cube",
        cubes / "moments-8.uplift",
        code=2,
    )
    assert result.stdout.startswith("out: 2 textures, 60 pixels, ")
    (warning,) = warning_lines(result)
    assert re.search(r"shot\.1\.exr: \d+ of 30 pixels .* by up to 0\.9", warning)
    error = shown.pop().error
    assert (error.code, error.path.name) == ("texture", "shot.2.exr")
    assert sorted(os.listdir(frames / "out")) == [
        "shot.0.exr",
        "shot.1.exr",
    ]


def test_masks_choose_among_cubes(run, refuse, misuse, frames, cubes):
    two = (
        "--cube",
        cubes / "moments-8.uplift",
        "--cube",
        cubes / "moments-8-macbeth.uplift",
    )
    options = ("--mask", "mask.exr", *two, "--representation", "moments")
    for weight in (0.25, 0.5):  # a changed mask makes the texture out of date
        write_exr(frames / "mask.exr", {"Y": np.full((6, 5), weight, dtype=np.float32)})
        converter_for.cache_clear()  # as of another process
        result = run("texture shot.0.exr -o mixed.exr", *options, "--resume", "--force")
        assert result.output.startswith("mixed.exr: 1 texture, ")
    assert (
        "0 textures, 1 skipped"
        in run("texture shot.0.exr -o mixed.exr", *options, "--resume").output
    )
    assert (
        refuse("texture shot.0.exr -o mask.exr", *options, "--force").code
        == "output-is-input"
    )
    assert (
        "at least two cubes"
        in refuse("texture shot.0.exr -o one.exr", *options[:4]).problem
    )
    assert "--mask" in misuse("texture shot.0.exr -o one.exr", *two)


def test_folders_end_with_any_separator_of_the_system(run, frames, cubes, monkeypatch):
    monkeypatch.setattr(os, "altsep", "\\")
    options = ("--representation", "moments", "--cube", cubes / "moments-8.uplift")
    for separator in "/\\":
        run("texture shot.0.exr -o", f"made.v2{separator}", *options)
    folders = [path for path in frames.iterdir() if path.is_dir()]
    assert len(folders) == 2
    assert [os.listdir(folder) for folder in folders] == [["shot.0.exr"]] * 2


def test_tiles_are_found_with_other_separators_than_those_of_the_pattern(
    run, frames, cubes
):
    (frames / "shot.1001.exr").write_bytes((frames / "shot.0.exr").read_bytes())
    options = ("--representation", "moments", "--cube", cubes / "moments-8.uplift")
    run("texture", f"{frames}//shot.<UDIM>.exr", "-o", "tile.<UDIM>.exr", *options)
    assert (frames / "tile.1001.exr").is_file()
