"""Examples of docs/palette.md have the properties that the page states."""

import re
from dataclasses import replace

import numpy as np
import pytest

from tests.conftest import ROOT
from uplift.extras.papers.palette.design import design
from uplift.extras.papers.palette.spec import read_palette
from uplift.extras.papers.palette.unmet import unmet_goals
from uplift.samples import sample_path

EXAMPLES = ("metamers", "vanish", "light", "constant", "engine")


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
