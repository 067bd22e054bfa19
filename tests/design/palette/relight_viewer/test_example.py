"""The sample engine.toml has the properties that docs/palette-dial.md states, in the picture too."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.design.palette import design, matrix, read_palette
from uplift.samples import sample_path

HAZE, BLOCK, VALVE, PISTON = range(4)
DAY, LAMP, NIGHT = range(3)


@pytest.fixture(scope="module")
def colours(model):
    """By full spectra, and as drawn in the picture: linear RGB (4, 3, 3) each."""
    palette = read_palette(sample_path("engine.toml"))
    found = matrix(design(palette, model))
    return {"full": found.obtained, "drawn": found.factor}


@pytest.mark.parametrize(("kind", "alike"), [("full", 0.2), ("drawn", 4)])
def test_engine_parts_match_by_day_and_differ_under_the_lamp(colours, sensor, kind, alike):
    found = colours[kind]
    assert (delta_e_rgb(sensor, found[BLOCK:, DAY], found[BLOCK, DAY]) < alike).all()
    assert delta_e_rgb(sensor, found[BLOCK, DAY], found[BLOCK, LAMP]) < alike
    for pair in ((BLOCK, VALVE), (BLOCK, PISTON), (VALVE, PISTON)):
        assert delta_e_rgb(sensor, *found[list(pair), LAMP]) > 4.5


@pytest.mark.parametrize("kind", ["full", "drawn"])
def test_the_haze_is_invisible_by_night(colours, sensor, kind):
    assert delta_e_rgb(sensor, colours[kind][HAZE, NIGHT], np.zeros(3)) < 1
    assert delta_e_rgb(sensor, colours[kind][HAZE, DAY], np.zeros(3)) > 30
