"""``uplift texture`` from the outside."""

from __future__ import annotations

import numpy as np
import OpenEXR
import pytest

from tests.io.texture.conftest import planes, write_exr


@pytest.fixture
def frames(home):
    """Three frames of 6 × 5 pixels, one of them too bright."""
    rng = np.random.default_rng(0)
    for frame in range(3):
        write_exr(home / f"shot.{frame}.exr", planes(rng.random((6, 5, 3)).astype(np.float32) + (frame == 1)))
    return home


def test_one_image(run, frames, cubes):
    options = ("--cube", cubes / "moments-8.uplift", "--store", "moments")
    result = run("texture", "shot.0.exr", "out.exr", *options)
    assert result.output.startswith("out.exr: 1 texture, 30 pixels, 0.0 MB, ")
    assert "moment.08" in OpenEXR.File("out.exr", separate_channels=True).channels()
    assert "exists already" in run("texture", "shot.0.exr", "out.exr", *options, code=2).stderr
    result = run("texture", "shot.0.exr", "out.exr", *options, "--resume")
    assert result.output.startswith("out.exr: 0 textures, 1 there already, ")
    assert run("texture", "shot.0.exr", "out.exr", *options, "--force", "-q").output == ""


def test_a_sequence_goes_on_where_one_image_is_bad(run, frames, cubes):
    (frames / "shot.2.exr").write_text("no image")
    result = run(
        "texture", "shot.*.exr", "out", "--cube", cubes / "moments-8.uplift", "--store", "moments",
        "--processes", 1, code=2,
    )  # fmt: skip
    assert result.stdout.startswith("out: 2 textures, 60 pixels, ")
    warning, error = result.stderr.splitlines()
    assert warning.startswith("warning: ")
    assert "shot.1.exr: " in warning
    assert " of 30 pixels lie outside [0, 1]: clamped, a component by up to 0.9" in warning
    assert error.startswith("error: ")
    assert "shot.2.exr: " in error
    assert sorted(path.name for path in (frames / "out").iterdir()) == ["shot.0.exr", "shot.1.exr"]


@pytest.mark.parametrize(
    ("words", "problem"),
    [
        (("none.exr", "out.exr"), "none.exr: no such file; use an EXR, PNG, JPEG or TIFF image"),
        (("none*.exr", "out"), "no file is named like 'none*.exr'; check the pattern"),
        (("shot.0.exr", "out.png"), "out.png: textures are OpenEXR; name the file .exr, or a folder"),
        (("shot.0.exr", "shot.1.exr", "out.exr"), "out.exr: is one file, for 2 images; name a folder"),
        (
            ("shot.0.exr", "shot.1.exr", "shot.2.exr/out"),
            "is no folder, and 2 images need one; name a folder",
        ),
        (
            ("shot.0.exr", "a.exr", "--store", "moments", "--wavelengths", "500"),
            "moments have no wavelengths",
        ),
        (("shot.0.exr", "a.exr", "--wavelengths", "500:400:5"), "wavelengths '500:400:5' are not clear"),
        (("shot.0.exr", "a.exr", "--cube", "none.uplift"), "none.uplift"),
        (
            ("shot.0.exr", "a.exr", "--store", "multipliers", "--depth", "half"),
            "depth of multipliers must be float, got 'half'",
        ),
    ],
)
def test_bad_input(refuse, frames, words, problem):
    assert problem in refuse("texture", *words)


def test_out_of_gamut(run, refuse, frames, cubes):
    words = ("texture", "shot.1.exr", "out.exr", "--cube", cubes / "moments-8.uplift", "--store", "moments")
    told = run(*words, "--out-of-gamut", "scale").stderr
    assert " of 30 pixels lie outside [0, 1]: scaled, a component by up to " in told
    scaled = OpenEXR.File("out.exr", separate_channels=True).channels()
    assert max(scaled[letter].pixels.max() for letter in "RGB") == 1
    run(*words, "--force")
    clipped = OpenEXR.File("out.exr", separate_channels=True).channels()
    assert (scaled["G"].pixels < clipped["G"].pixels).any()
    refusal = refuse(*words, "--force", "--out-of-gamut", "error")
    assert "lies outside [0, 1]; " in refusal
    assert "--out-of-gamut" in refusal


def test_a_folder_is_not_the_images_own(refuse, frames):
    assert "exists already" in refuse("texture", "shot.*.exr", ".")
