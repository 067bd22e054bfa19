"""Palettes with few entries or goals still have finite results."""

from __future__ import annotations

import numpy as np
import pytest

from uplift.design.palette import design, matrix, read_palette, unmet_goals

DAY, GIVEN, NEW = (
    'lights.day.illuminant = "D65"\n',
    'materials.grey.rgb = "#808080"\n',
    "materials.new.design = true\n",
)


@pytest.mark.parametrize(
    "text",
    [
        DAY + GIVEN,
        DAY + GIVEN + 'colours.grey.day = "#808080"',
        "smoothness = 0\nmodel-error = 0\n" + DAY + NEW,
        "smoothness = 0\nmodel-error = 0\n" + DAY + "materials.new = { design = true, bounds = false }",
        "lights.odd.design = true\n" + NEW,
        DAY + NEW + 'colours.new.day = { free = "alone" }',
        DAY + NEW + 'colours.new.day = { rgb = "#ff0000", weight = 1000000 }',
        'lights.off = { illuminant = "D65", luminance = 0 }\n' + NEW + 'colours.new.off = "#000000"',
    ],
)
def test_all_results_are_finite(model, tmp_path, text):
    (tmp_path / "spec.toml").write_text(text, encoding="utf-8")
    found = design(read_palette(tmp_path / "spec.toml"), model)
    colours = matrix(found)
    for numbers in (found.powers, found.reflectances, colours.obtained, colours.factor, colours.model_error):
        assert np.isfinite(numbers).all()
    assert unmet_goals(found) == ()
