"""``uplift texture``."""

import os
import re

import numpy as np
import OpenEXR
import pytest

from tests.extras.texture.conftest import planes, write_exr
from uplift.extras.texture.sequence import converter_for

from .conftest import warning_lines

MOMENTS = "--representation moments --cube"


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


def test_one_image(run, frames, cubes):
    words = (f"texture shot.0.exr -o out.exr {MOMENTS}", cubes / "moments-8.uplift")
    assert run(*words).output.startswith("out.exr: 1 texture, 30 pixels, 0.0 MB, ")
    assert "moment.08" in OpenEXR.File("out.exr", separate_channels=True).channels()
    resumed = run(*words, "--resume").output
    assert resumed.startswith("out.exr: 0 textures, 1 skipped, ")
    assert run(*words, "--force", "-q").output == ""


def test_sequences_continue_after_an_invalid_image(run, shown, frames, cubes):
    (frames / "shot.2.exr").write_text("not an image")
    result = run(
        f"texture shot.*.exr -o out --processes 1 {MOMENTS}",
        cubes / "moments-8.uplift",
        code=2,
    )
    assert result.stdout.startswith("out: 2 textures, 60 pixels, ")
    (warning,) = warning_lines(result)
    assert re.search(r"shot\.1\.exr: \d+ of 30 pixels .* by up to 0\.9", warning)
    error = shown.pop().error
    assert (error.code, error.path.name) == ("texture", "shot.2.exr")
    assert set(os.listdir(frames / "out")) == {"shot.0.exr", "shot.1.exr"}


def test_masks_choose_among_cubes(run, frames, cubes):
    files = (cubes / "moments-8.uplift", "--cube", cubes / "moments-8-macbeth.uplift")
    words = (f"texture shot.0.exr -o mixed.exr --mask mask.exr {MOMENTS}", *files)
    for weight in (0.25, 0.5):  # a changed mask makes the texture out of date
        write_exr(frames / "mask.exr", {"Y": np.full((6, 5), weight, dtype=np.float32)})
        converter_for.cache_clear()  # as of another process
        result = run(*words, "--resume", "--force")
        assert result.output.startswith("mixed.exr: 1 texture, ")
    assert "0 textures, 1 skipped" in run(*words, "--resume").output


def test_tiles_are_found_with_other_separators_than_those_of_the_pattern(
    run, frames, cubes
):
    (frames / "shot.0.exr").rename(frames / "shot.1001.exr")
    pattern = f"{frames}//shot.<UDIM>.exr"
    run(f"texture -o tile.<UDIM>.exr {MOMENTS}", cubes / "moments-8.uplift", pattern)
    assert (frames / "tile.1001.exr").is_file()
