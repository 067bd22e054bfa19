# ruff: noqa: F811
"""``uplift plan``, ``uplift build --plan``, and the command lines of a plan."""

import dataclasses
import json
import shlex
import shutil

import click
import pytest
from uplift_cli.main import main

from tests.cli.conftest import home, refuse, run, shown  # noqa: F401
from uplift.extras.scene.plan.candidates import PIXELS
from uplift.extras.scene.plan.files import cube_name
from uplift.extras.scene.plan.summary import commands


@pytest.fixture
def here(home, kitchen, planned, monkeypatch):
    """A working folder with the scene, where plans are as they were measured once."""
    shutil.copytree(kitchen.parent, home, dirs_exist_ok=True)

    def plan(scene, grid, progress):
        return dataclasses.replace(planned[0], scene=scene)

    monkeypatch.setattr("uplift.extras.scene.plan.planning.plan", plan)
    return home


def test_a_plan_is_printed_and_written_and_options_do_not_change_it(run, here):
    result = run("plan", "kitchen.toml")
    assert result.stdout.startswith("  uplift build --plan kitchen.plan.json\n")
    assert "kitchen.plan.json" in result.stderr
    values = json.loads((here / "kitchen.plan.json").read_text("utf-8"))
    again = run("plan", "kitchen.toml", "--format", "json", "--force").stdout
    assert json.loads(again) == values
    words = "build --plan kitchen.plan.json --dim 4 --light A"
    assert "leave out --dim, --light." in run(*words.split(), code=2).stderr


def test_a_plan_outside_the_folder_of_its_scene_is_refused_before_the_search(
    run, here, monkeypatch
):
    monkeypatch.setattr("uplift.extras.scene.plan.planning.plan", None)
    (here / "empty").mkdir()
    error = run("plan", "kitchen.toml", "-o", "empty/a.plan.json", code=2).stderr
    assert "write for example kitchen.plan.json" in error


@pytest.mark.parametrize("pixel", PIXELS)
def test_command_lines_are_accepted(planned, tmp_path, pixel):
    found = planned[0]
    path = tmp_path / "my plan.plan.json"
    assert cube_name(path) == "my plan.uplift"
    chosen = dataclasses.replace(found.chosen, pixel=pixel)
    for line in commands(dataclasses.replace(found, chosen=chosen), path):
        program, name, *arguments = shlex.split(line)
        assert program == "uplift"
        with click.Context(main, **main.context_settings) as context:
            main.get_command(context, name).make_context(
                name, arguments, parent=context
            )
