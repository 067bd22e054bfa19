"""Chromaticity diagrams of an emission table, and its contact sheet."""

from __future__ import annotations

from dataclasses import replace
from importlib import import_module

import numpy as np
import OpenEXR
import pytest
from matplotlib.image import imread

import uplift
from tests.helpers import raises
from uplift.colorimetry.srgb import decode
from uplift.common.errors import OutputError
from uplift.lights.chromaticity_map import ALL
from uplift.lights.discs import LampEntries
from uplift.lights.lookup import EmissionTable
from uplift.viz.chromaticity import MARGIN, draw_errors, lamp_window
from uplift.viz.figure import new_figure
from uplift.viz.scatter import new_panels
from uplift.viz.sheet import write_light_sheet


@pytest.fixture(scope="module")
def table():
    return uplift.load_emission()


@pytest.fixture(scope="module")
def sheet(table, tmp_path_factory):
    path = tmp_path_factory.mktemp("sheet") / "lights.png"
    write_light_sheet(table, path)
    return path


def test_the_sheet_has_colours_errors_and_lamps(sheet):
    image = imread(sheet)[..., :3]
    width = image.shape[1]
    saturation = image.max(axis=2) - image.min(axis=2)
    colours, errors, lamps = (saturation[:, i * width // 3 : (i + 1) * width // 3] for i in range(3))
    assert (colours > 0.95).mean() > 0.1
    assert (errors > 0.2).mean() > 0.2
    assert (errors > 0.8).mean() < (lamps > 0.8).mean() + 0.01 < 0.05


def test_the_sheet_as_exr_is_linear(table, tmp_path, monkeypatch):
    picture = new_figure(1, 0.5, layout=None)
    picture.subplots().imshow(np.linspace(0, 1, 12).reshape(3, 4))
    module = import_module("uplift.viz.sheet.write_sheet")  # the package has a function of this name
    monkeypatch.setattr(module, "light_figure", lambda table: picture)
    for name in ("lights.png", "lights.exr"):
        write_light_sheet(table, tmp_path / name)
    (part,) = OpenEXR.File(str(tmp_path / "lights.exr"), separate_channels=True).parts
    found = np.stack([part.channels[letter].pixels for letter in "RGB"], axis=-1)
    np.testing.assert_allclose(found, decode(imread(tmp_path / "lights.png")[..., :3].astype(float)), atol=1e-5)


def test_the_map_has_the_expected_errors(table):
    _, ((axes,),) = new_panels(1, 1, (2, 2), {})
    draw_errors(axes, table)
    (image,) = axes.images
    errors = image.get_array()
    assert image.get_extent() == [*ALL.u, *ALL.v]
    white = table.data.lattice.white
    step = (ALL.u[1] - ALL.u[0]) / errors.shape[1]
    row, column = errors.shape[0] - int((white[1] - ALL.v[0]) / step) - 1, int((white[0] - ALL.u[0]) / step)
    assert errors[row, column] == pytest.approx(float(table.expected_error([1.0, 1.0, 1.0])), rel=0.1)
    assert image.get_clim() == (0, float(table.data.error.max()))


@pytest.mark.parametrize("count", [0, 1, 92])
def test_the_window_of_lamps_has_all_of_them(table, count):
    entries = table.data.entries
    some = LampEntries(entries.names[:count], *(each[:count] for each in (entries.uv, entries.spectra, entries.radius)))
    window = lamp_window(EmissionTable(replace(table.data, entries=some)))
    low, high = np.array([window.u, window.v]).T
    assert (some.uv >= low + 0.999 * MARGIN).all()
    assert (some.uv <= high - 0.999 * MARGIN).all()
    shape = [(high - low)[i] / (full[1] - full[0]) for i, full in enumerate((ALL.u, ALL.v))]
    assert shape[0] == pytest.approx(shape[1])
    assert shape[0] < 0.5


def test_bad_files_are_refused(table, tmp_path):
    with raises(OutputError, "unknown-suffix"):
        write_light_sheet(table, tmp_path / "lights.pdf")
    (tmp_path / "lights.png").write_text("mine")
    with raises(OutputError, "file-exists"):
        write_light_sheet(table, tmp_path / "lights.png")
