"""Sample files: copies, and what pictures and measurements hold."""

import numpy as np
import OpenImageIO
import pytest
from numpy.testing import assert_allclose

from tests.helpers import raises
from uplift.atlas.resampling import on_grid
from uplift.atlas.sources import read_atlas
from uplift.common.errors import OutputError
from uplift.extras.colour.srgb import encode
from uplift.samples import copy_samples, sample_names, sample_path


def test_samples_are_copied_once(tmp_path):
    folder = tmp_path / "new"
    copies = copy_samples(folder)
    assert tuple(path.name for path in copies) == sample_names()
    times = {path: path.stat().st_mtime_ns for path in copies}
    assert copy_samples(folder) == copies
    assert {path: path.stat().st_mtime_ns for path in copies} == times
    assert all(
        path.read_bytes() == sample_path(path.name).read_bytes() for path in copies
    )


def test_folders_that_cannot_be_made_are_refused(tmp_path):
    (tmp_path / "file").write_text("")
    with raises(OutputError, "output"):
        copy_samples(tmp_path / "file" / "such")


def test_the_still_life_holds_the_colorchecker(sensor):
    """The patches of the chart in the picture have the colours of the atlas, to half a
    code.
    """
    picture = OpenImageIO.ImageBuf(str(sample_path("still-life.png"))).get_pixels(
        OpenImageIO.FLOAT
    )
    atlas = read_atlas("macbeth")
    for number, colour in enumerate(
        np.clip(sensor.rgb(on_grid(atlas, sensor.wavelengths)), 0, 1)
    ):
        row, column = divmod(number, 6)
        assert_allclose(
            picture[188 + 22 * row, 352 + 22 * column], encode(colour), atol=0.51 / 255
        )


@pytest.mark.filterwarnings(
    "ignore::uplift.UpliftWarning"
)  # a scale of percent is recognised
def test_measurements_in_several_formats_are_the_same():
    """`chart.ti3`, `paints.cxf` and `paints.xlsx` hold patches of `paints.csv`."""
    paints = read_atlas(sample_path("paints.csv"))
    assert len(paints) == 24
    for name, count in (("paints.cxf", 12), ("paints.xlsx", 12), ("chart.ti3", 6)):
        atlas = read_atlas(sample_path(name))
        grid = atlas[0].wavelengths
        assert_allclose(on_grid(atlas, grid), on_grid(paints[:count], grid), atol=1e-6)
