"""Designed materials as atlases, and plots of designs."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from matplotlib.image import imread

import uplift
from tests.helpers import raises, warns
from uplift.colorimetry.srgb import hex_codes
from uplift.common.errors import OutputError, PaletteError
from uplift.design.palette import design, matrix, write_designed
from uplift.design.palette.palette import SpectrumSpec
from uplift.design.palette.plots import plot_matrix, plot_spectra


@pytest.fixture(scope="module")
def found(metamers, model):
    given = SpectrumSpec("given", np.full(81, 0.5))
    return design(dataclasses.replace(metamers, materials=(*metamers.materials, given)), model)


def test_an_exported_atlas_has_the_designed_spectra(found, tmp_path):
    for name in ("out.txt", "out.csv"):
        assert write_designed(found, tmp_path / name) == 2
        back = uplift.read_atlas(tmp_path / name)
        assert back.names == ("fox", "moss")
        for entry, row in zip(back.entries, found.reflectances, strict=False):
            np.testing.assert_array_equal(entry.values, row)


def test_an_atlas_of_designs_constrains_a_cube(found, tmp_path):
    """The cube reproduces the colour of a designed material."""
    write_designed(found, tmp_path / "out.txt")
    with warns("entry-crowded"):
        cube = uplift.build(tmp_path / "out.txt", dim=3, coefficients=5)
    assert cube.data.atlas.names == ("fox", "moss")
    colour = found.palette.sensor.rgb(found.reflectances[0])
    back = cube.data.sensor.rgb(cube.reflectance(colour))
    np.testing.assert_allclose(back, colour, atol=1e-3)


def test_materials_outside_the_range_of_atlases_are_left_out(found, tmp_path):
    wild = dataclasses.replace(found, reflectances=found.reflectances - [[0.2], [0], [0]])
    with warns("entry-left-out"):
        assert write_designed(wild, tmp_path / "out.txt") == 1
    assert uplift.read_atlas(tmp_path / "out.txt").names == ("moss",)


def test_an_empty_atlas_is_refused_and_a_file_is_kept_without_force(found, tmp_path):
    (tmp_path / "out.txt").write_text("mine", encoding="utf-8")
    with raises(OutputError, "file-exists"):
        write_designed(found, tmp_path / "out.txt")
    given = tuple(dataclasses.replace(part, samples=np.ones(81)) for part in found.palette.materials)
    nothing = dataclasses.replace(found, palette=dataclasses.replace(found.palette, materials=given))
    with raises(PaletteError):
        write_designed(nothing, tmp_path / "new.txt")


def test_the_matrix_shows_every_colour(found, tmp_path):
    """Target, obtained and modelled colours are pixels of the PNG."""
    colours = matrix(found)
    split = dataclasses.replace(colours, target=colours.target * 0.5, factor=colours.factor * 0.8)
    plot_matrix(found, split, tmp_path / "m.png")
    pixels = np.rint(255 * imread(tmp_path / "m.png")[..., :3]).astype(np.uint8)
    drawn = {bytes(pixel) for pixel in np.unique(pixels.reshape(-1, 3), axis=0)}
    for kind in (split.target[:2], split.obtained, split.factor):
        for code in hex_codes(kind.reshape(-1, 3)):
            assert bytes.fromhex(code[1:]) in drawn


def test_spectra_are_drawn(found, tmp_path):
    plot_spectra(found, tmp_path / "s.png")
    assert imread(tmp_path / "s.png").shape[1] == 1000
