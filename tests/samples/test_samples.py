"""Sample files: copies, and agreement with the program that makes them."""

from __future__ import annotations

import zipfile

import numpy as np
import OpenImageIO
import pytest

from tests.helpers import raises
from tools import ship_samples
from uplift.atlas import read_atlas
from uplift.common.errors import OutputError
from uplift.samples import copy_samples, sample_names, sample_path


def test_samples_are_copied_once(tmp_path):
    folder = tmp_path / "new"
    copies = copy_samples(folder)
    assert tuple(path.name for path in copies) == sample_names()
    times = {path: path.stat().st_mtime_ns for path in copies}
    assert copy_samples(folder) == copies
    assert {path: path.stat().st_mtime_ns for path in copies} == times
    assert all(path.read_bytes() == sample_path(path.name).read_bytes() for path in copies)


def test_other_files_of_the_same_name_stay_without_force(tmp_path):
    (tmp_path / "wood.png").write_text("mine")
    with raises(OutputError, "file-exists"):
        copy_samples(tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["wood.png"]
    copy_samples(tmp_path, force=True)
    assert (tmp_path / "wood.png").read_bytes() == sample_path("wood.png").read_bytes()


def test_folders_that_cannot_be_made_are_refused(tmp_path):
    with raises(OutputError, "output"):
        copy_samples(tmp_path / "no" / "such")


def pixels(path):
    return OpenImageIO.ImageBuf(str(path)).get_pixels(OpenImageIO.FLOAT)


def members(path):
    """The files in an archive."""
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    folder = tmp_path_factory.mktemp("made")
    ship_samples.main(folder)
    return folder


def test_the_program_makes_what_is_shipped(made):
    for path in made.iterdir():
        if path.suffix == ".xlsx":  # holds the time at which it was written
            assert members(path) == members(sample_path(path.name))
        elif path.suffix not in (".exr", ".png"):
            assert path.read_bytes() == sample_path(path.name).read_bytes()
        else:
            np.testing.assert_allclose(pixels(path), pixels(sample_path(path.name)), atol=1.5 / 255)
    assert {path.name for path in made.iterdir()} <= set(sample_names())


def test_the_still_life_holds_the_colorchecker(made, sensor):
    """The patches of the chart in the picture have the colours of the atlas, to half a code."""
    left, top, size, gap = ship_samples.CARD
    picture = pixels(sample_path("still-life.png"))
    for number, colour in enumerate(ship_samples.palette().values()):
        row, column = divmod(number, 6)
        y, x = (start + place * (size + gap) + size // 2 for start, place in ((top, row), (left, column)))
        np.testing.assert_allclose(picture[y, x], ship_samples.encode(colour), atol=0.51 / 255)
    assert len(read_atlas(sample_path("paints.csv"))) == 24
