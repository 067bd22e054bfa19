"""Plots of bounds."""

import numpy as np
import pytest

from uplift.colorimetry import observer
from uplift.extras.looks.metamer_bounds import bounds
from uplift.extras.pages.plots import plot_bounds


@pytest.fixture(scope="module")
def blocks(small_cube):
    rgb = np.array([[0.2, 0.5, 0.1], [0.5, 0.1, 0.1]])
    return [
        [
            bounds(small_cube, rgb, observer.light(name), divisions=1)
            for name in ("A", "FL11", "D65")
        ]
    ]


def test_a_row_per_colour_and_a_column_per_light(small_cube, blocks, tmp_path):
    plot_bounds(small_cube, blocks, tmp_path / "plot.svg")
    text = (tmp_path / "plot.svg").read_text()
    for found in blocks[0]:
        for largest in found.largest.delta_e_2000:
            assert f"{found.light.name}: ΔE00 up to {largest:.1f}" in text
    assert {"all reflectances", "likely 95%", "answer"} <= set(
        text.replace("<", ">").split(">")
    )
