"""Examples of docs/palette.md have the properties that the page states."""

import re
from dataclasses import replace

import numpy as np
import pytest

from tests.conftest import ROOT
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.extras.papers.palette.design import design, matrix
from uplift.extras.papers.palette.spec import read_palette
from uplift.extras.papers.palette.unmet import unmet_goals
from uplift.samples import sample_path

EXAMPLES = ("metamers", "vanish", "light", "constant")


@pytest.mark.parametrize("name", EXAMPLES)
def test_all_goals_are_met(model, name):
    assert unmet_goals(design(read_palette(sample_path(f"{name}.toml")), model)) == ()


def test_the_python_code_of_the_page_runs():
    page = (ROOT / "docs" / "palette.md").read_text("utf-8")
    (code,) = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    exec(compile(code, "palette.md", "exec"), {})


def test_the_infeasible_example_is_missed_because_of_its_bounds(model, tmp_path):
    page = (ROOT / "docs" / "palette.md").read_text("utf-8")
    [text] = re.findall(r"```toml\n([^`]*soot[^`]*)```", page)
    path = tmp_path / "soot.toml"
    path.write_text(text, encoding="utf-8")
    unmet = unmet_goals(design(read_palette(path), model))
    found = [(each.goal.material, each.goal.light) for each in unmet]
    assert found == [("soot", "day"), ("soot", "lamp")]
    assert [each.delta_e for each in unmet] == pytest.approx([2.10, 22.65], abs=0.01)
    assert unmet[1].relaxations[0][0] == "the bounds of soot"
    palette = read_palette(path)
    [soot] = (part for part in palette.materials if part.designed)
    wide = replace(soot, low=-np.inf, high=np.inf)
    assert not unmet_goals(design(replace(palette, materials=(wide,)), model))


HAZE, BLOCK, VALVE, PISTON = range(4)
DAY, LAMP, NIGHT = range(3)


def test_engine_parts_match_by_day_and_differ_under_the_lamp(model, sensor):
    """By full spectra, and as drawn in the picture. The haze is invisible by night."""
    found = matrix(design(read_palette(sample_path("engine.toml")), model))
    for rgb, alike in ((found.obtained, 0.2), (found.factor, 4)):

        def apart(one, other, rgb=rgb):
            return delta_e_rgb(sensor, rgb[one], rgb[other])

        for part in (VALVE, PISTON):
            assert apart((part, DAY), (BLOCK, DAY)) < alike
            assert apart((part, LAMP), (BLOCK, LAMP)) > 4.5
        assert apart((BLOCK, DAY), (BLOCK, LAMP)) < alike
        assert apart((VALVE, LAMP), (PISTON, LAMP)) > 4.5
        assert delta_e_rgb(sensor, rgb[HAZE, NIGHT], np.zeros(3)) < 1
        assert delta_e_rgb(sensor, rgb[HAZE, DAY], np.zeros(3)) > 30
