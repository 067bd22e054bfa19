"""Chromaticity diagrams of an emission table."""

import numpy as np
import pytest
from numpy.testing import assert_array_equal

import uplift
from uplift.extras.pages.chromaticity import ALL, PIXELS, errors_panel
from uplift.extras.pages.panels import draw


def test_the_map_has_the_expected_errors():
    table = uplift.load_emission()
    axes, _ = draw([errors_panel(table)]).axes
    (image,) = axes.images
    assert_array_equal(image.get_extent(), ALL.ravel())
    shares = (table.data.lattice.white - ALL[:, 0]) / np.ptp(ALL, axis=1)
    column, row = (PIXELS * shares).astype(int)
    expected = float(table.expected_error([1.0, 1.0, 1.0]))
    assert image.get_array()[row, column] == pytest.approx(expected, rel=0.1)
