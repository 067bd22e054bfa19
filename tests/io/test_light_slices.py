"""An emission table as OpenEXR over the chromaticity diagram, against queries of single pixels."""

from __future__ import annotations

import numpy as np
import OpenEXR
import pytest

import uplift
from tests.helpers import raises
from uplift.common.errors import ColourError, OutputError
from uplift.io.slices import write_light_slices
from uplift.lights.chromaticity_map import Window, map_chromaticities
from uplift.lights.lattice import chromaticity, unit_xyz
from uplift.lights.table import emission_digest


@pytest.fixture(scope="module")
def table():
    return uplift.load_emission()


@pytest.fixture(scope="module")
def image(table, tmp_path_factory):
    """Header and channels (height, width) of the file."""
    path = tmp_path_factory.mktemp("slices") / "lights.exr"
    write_light_slices(table, path)
    (part,) = OpenEXR.File(str(path), separate_channels=True).parts
    return part.header, {name: channel.pixels for name, channel in part.channels.items()}


def place(header, shape, row, column):
    """u′v′ of a pixel, by the attributes of the file."""
    step = header["uplift.step"]
    return np.array([header["uplift.u"] + step * (column + 0.5), header["uplift.v"] + step * (shape[0] - row - 0.5)])


def test_pixels_are_the_answers_at_their_chromaticities(table, image):
    header, channels = image
    rows, columns = np.nonzero(channels["A"])
    for pick in np.linspace(0, len(rows) - 1, 25).astype(int):
        row, column = rows[pick], columns[pick]
        xyz = unit_xyz(place(header, channels["A"].shape, row, column))
        xyz /= xyz[1]
        rgb = [channels[letter][row, column] for letter in "RGB"]
        np.testing.assert_allclose(rgb, table.rgb_of_xyz(xyz), rtol=1e-4, atol=1e-4)
        power = [channels[f"power.{at}nm"][row, column] for at in (400, 560, 700)]
        np.testing.assert_allclose(power, table.spectrum_of_xyz(xyz, [400, 560, 700]), rtol=1e-3, atol=1e-4)
        expected = table.expected_error(table.rgb_of_xyz(xyz))
        assert channels["expectedError"][row, column] == pytest.approx(float(expected), rel=1e-4)


def test_pixels_outside_the_locus_are_empty(table, image):
    header, channels = image
    outside = channels["A"] == 0
    assert 0.3 < outside.mean() < 0.9
    assert (channels["lamp"][outside] == -1).all()
    assert not any(plane[outside].any() for name, plane in channels.items() if name != "lamp")
    rows, columns = np.nonzero(outside)
    for pick in np.linspace(0, len(rows) - 1, 9).astype(int):
        xyz = unit_xyz(place(header, outside.shape, rows[pick], columns[pick]))
        with raises(ColourError, "colour-not-a-light"):
            table.spectrum_of_xyz(xyz)


def test_lamps_have_their_numbers(table, image):
    header, channels = image
    names = header["uplift.lamps"].split("; ")
    assert tuple(names) == table.lamp_names
    row = names.index("H38HT-100 (Mercury)")
    found = np.argwhere(channels["lamp"] == row)
    radius = table.data.entries.radius[row] / header["uplift.step"]
    assert len(found) == pytest.approx(np.pi * radius**2, rel=0.1)
    middle = place(header, channels["A"].shape, *found.mean(axis=0))
    assert middle == pytest.approx(table.data.entries.uv[row], abs=1e-3)


def test_the_header_identifies_the_table(table, image):
    assert image[0]["uplift.cube"] == emission_digest(table.data)
    assert image[0]["uplift.space"] == "sRGB"


def test_maps_have_luminance_one(table):
    found = map_chromaticities(table, Window((0.1, 0.3), (0.4, 0.5)), 0.01)
    assert found.inside.shape == (10, 20)
    assert found.inside.all()
    np.testing.assert_allclose(found.xyz[..., 1], 1)
    np.testing.assert_allclose(chromaticity(found.xyz)[-1, 0], [0.105, 0.405])
    np.testing.assert_allclose(found.rgb @ table.rgb_to_xyz.T, found.xyz, atol=1e-9)


def test_bad_files_are_refused(table, tmp_path):
    with raises(OutputError, "unknown-suffix"):
        write_light_slices(table, tmp_path / "lights.png")
    (tmp_path / "lights.exr").write_text("mine")
    with raises(OutputError, "file-exists"):
        write_light_slices(table, tmp_path / "lights.exr")
    assert (tmp_path / "lights.exr").read_text() == "mine"
