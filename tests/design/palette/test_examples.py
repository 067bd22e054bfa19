"""Examples of docs/palette.md have the properties that the page states."""

from __future__ import annotations

import re

import numpy as np
import pytest

from tests.conftest import ROOT
from uplift.design.palette import design, matrix, read_palette, unmet_goals
from uplift.design.palette.matrix import difference
from uplift.design.palette.palette import MinDifference
from uplift.samples import sample_path

EXAMPLES = ("metamers", "vanish", "light", "constant")


@pytest.fixture(scope="module")
def examples(model):
    return {name: design(read_palette(sample_path(f"{name}.toml")), model) for name in EXAMPLES}


def delta_e(found, first, second, light):
    return difference(found, matrix(found), MinDifference((first, second), light, 0))


@pytest.mark.parametrize("name", EXAMPLES)
def test_all_goals_are_met(examples, name):
    assert unmet_goals(examples[name]) == ()


@pytest.mark.parametrize("name", EXAMPLES)
def test_the_page_shows_every_example(name):
    page = (ROOT / "docs" / "palette.md").read_text(encoding="utf-8")
    assert f"uplift palette {name}.toml" in page
    assert f"](palette/{name}-matrix.png)" in page


def test_the_python_code_of_the_page_runs():
    page = (ROOT / "docs" / "palette.md").read_text(encoding="utf-8")
    (code,) = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    exec(compile(code, "palette.md", "exec"), {})


def test_the_infeasible_example_is_missed_because_of_its_bounds(model, tmp_path):
    page = (ROOT / "docs" / "palette.md").read_text(encoding="utf-8")
    text = next(text for text in re.findall(r"```toml\n(.*?)```", page, re.DOTALL) if "soot" in text)
    (tmp_path / "soot.toml").write_text(text, encoding="utf-8")
    unmet = unmet_goals(design(read_palette(tmp_path / "soot.toml"), model))
    assert [(each.goal.material, each.goal.light) for each in unmet] == [("soot", "day"), ("soot", "lamp")]
    assert [each.delta_e for each in unmet] == pytest.approx([2.10, 22.65], abs=0.01)
    assert unmet[1].relaxations[0].criterion == "the bounds of soot"


def test_metamers_differ_under_the_second_light(examples):
    found = examples["metamers"]
    assert delta_e(found, "fox", "moss", "day") <= 0.1
    assert delta_e(found, "fox", "moss", "lamp") >= found.palette.min_differences[0].delta_e


def test_the_smoke_vanishes(examples):
    colours = matrix(examples["vanish"])
    np.testing.assert_allclose(colours.obtained[1, 1], 0, atol=1e-3)
    assert colours.obtained[1, 0].min() > 0.1
    assert colours.obtained[0, 1].max() > 0.1


def test_the_figure_vanishes_on_its_ground(examples):
    found = examples["light"]
    assert delta_e(found, "figure", "ground", "day") > 20
    assert delta_e(found, "figure", "ground", "veil") < 0.5
    assert found.powers.min() >= 0


def test_one_colour_stays_and_the_other_does_not(examples):
    found = examples["constant"]
    firm, fickle = matrix(found).obtained
    assert np.abs(firm[0] - firm[1]).max() < 0.003
    assert np.abs(fickle[0] - fickle[1]).max() > 0.09
    assert delta_e(found, "firm", "fickle", "day") < 0.5
