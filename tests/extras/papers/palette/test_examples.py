"""Examples of docs/palette.md have the properties that the page states."""

import re

import numpy as np
import pytest

from tests.conftest import ROOT
from uplift.colorimetry.delta_e import delta_e_rgb
from uplift.extras.papers.palette.design import design, matrix
from uplift.extras.papers.palette.spec import read_palette
from uplift.extras.papers.palette.unmet import unmet_goals
from uplift.samples import sample_path

EXAMPLES = ("metamers", "vanish", "light", "constant")


@pytest.fixture(scope="module")
def examples(model):
    return {
        name: design(read_palette(sample_path(f"{name}.toml")), model)
        for name in EXAMPLES
    }


def delta_e(found, first, second, light):
    obtained = matrix(found).obtained
    palette = found.palette
    pair = (obtained[palette.cell(material, light)] for material in (first, second))
    return float(delta_e_rgb(palette.sensor, *pair))


@pytest.mark.parametrize("name", EXAMPLES)
def test_all_goals_are_met(examples, name):
    assert unmet_goals(examples[name]) == ()


def test_the_python_code_of_the_page_runs():
    page = (ROOT / "docs" / "palette.md").read_text("utf-8")
    (code,) = re.findall(r"```python\n(.*?)```", page, re.DOTALL)
    exec(compile(code, "palette.md", "exec"), {})


def test_the_infeasible_example_is_missed_because_of_its_bounds(model, tmp_path):
    page = (ROOT / "docs" / "palette.md").read_text("utf-8")
    text = next(
        text
        for text in re.findall(r"```toml\n(.*?)```", page, re.DOTALL)
        if "soot" in text
    )
    (tmp_path / "soot.toml").write_text(text, encoding="utf-8")
    unmet = unmet_goals(design(read_palette(tmp_path / "soot.toml"), model))
    assert [(each.goal.material, each.goal.light) for each in unmet] == [
        ("soot", "day"),
        ("soot", "lamp"),
    ]
    assert [each.delta_e for each in unmet] == pytest.approx([2.10, 22.65], abs=0.01)
    assert unmet[1].relaxations[0][0] == "the bounds of soot"


HAZE, BLOCK, VALVE, PISTON = range(4)
DAY, LAMP, NIGHT = range(3)


@pytest.fixture(scope="module")
def engine(model):
    """By full spectra, and as drawn in the picture: linear RGB (4, 3, 3) each."""
    palette = read_palette(sample_path("engine.toml"))
    found = matrix(design(palette, model))
    return {"full": found.obtained, "drawn": found.factor}


@pytest.mark.parametrize(("kind", "alike"), [("full", 0.2), ("drawn", 4)])
def test_engine_parts_match_by_day_and_differ_under_the_lamp(
    engine, sensor, kind, alike
):
    found = engine[kind]
    assert (delta_e_rgb(sensor, found[BLOCK:, DAY], found[BLOCK, DAY]) < alike).all()
    assert delta_e_rgb(sensor, found[BLOCK, DAY], found[BLOCK, LAMP]) < alike
    for pair in ((BLOCK, VALVE), (BLOCK, PISTON), (VALVE, PISTON)):
        assert delta_e_rgb(sensor, *found[list(pair), LAMP]) > 4.5


@pytest.mark.parametrize("kind", ["full", "drawn"])
def test_the_haze_is_invisible_by_night(engine, sensor, kind):
    assert delta_e_rgb(sensor, engine[kind][HAZE, NIGHT], np.zeros(3)) < 1
    assert delta_e_rgb(sensor, engine[kind][HAZE, DAY], np.zeros(3)) > 30
