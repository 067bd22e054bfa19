"""Chromaticity diagrams of an emission table."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import uplift
from uplift.extras.emission.discs import LampEntries
from uplift.extras.emission.lookup import EmissionTable
from uplift.extras.pages.chromaticity import ALL, PIXELS, errors_panel, lamp_window
from uplift.extras.pages.panels import draw


@pytest.fixture(scope="module")
def table():
    return uplift.load_emission()


def test_the_map_has_the_expected_errors(table):
    axes, _ = draw([errors_panel(table)]).axes
    (image,) = axes.images
    errors = image.get_array()
    assert_array_equal(image.get_extent(), ALL.ravel())
    shares = (table.data.lattice.white - ALL[:, 0]) / np.ptp(ALL, axis=1)
    column, row = (PIXELS * shares).astype(int)
    assert errors[row, column] == pytest.approx(
        float(table.expected_error([1.0, 1.0, 1.0])), rel=0.1
    )
    assert image.get_clim() == (0, float(table.data.error.max()))


@pytest.mark.parametrize("count", [0, 1, 92])
def test_the_window_of_lamps_has_all_of_them(table, count):
    entries = table.data.entries
    some = LampEntries(
        entries.names[:count],
        *(each[:count] for each in (entries.uv, entries.spectra, entries.radius)),
    )
    window = lamp_window(EmissionTable(replace(table.data, entries=some)))
    low, high = window.T
    assert (some.uv > low).all()
    assert (some.uv < high).all()
    width, height = high - low
    assert width == pytest.approx(height)
    assert width < 0.3
