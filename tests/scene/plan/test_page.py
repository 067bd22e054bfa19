"""The page, the summary and the commands of a plan."""

from __future__ import annotations

import dataclasses
import re
import shlex

import click
from uplift_cli.main import main

from tests.browsing import check_page
from uplift.scene.plan.page import page, verdict
from uplift.scene.plan.plan_file import commands, cube_name


def test_the_page_is_self_contained_and_lists_every_candidate(planned, tmp_path):
    plan, _ = planned
    text = page(plan, tmp_path / "kitchen.plan.json")
    assert not re.search(r'(src|href)="(?!#)', text)
    for decision in plan.decisions:
        assert decision.title in text
        assert all(trial.name in text for trial in decision.trials)
    assert f"{verdict(plan)}." in text
    assert text == page(plan, tmp_path / "kitchen.plan.json")


def test_the_page_fits_and_is_accessible(planned, tmp_path):
    check_page(page(planned[0], tmp_path / "kitchen.plan.json"), tmp_path)


def test_names_cannot_break_the_page(planned, tmp_path):
    path = tmp_path / "</style><script>.toml"
    plan = dataclasses.replace(planned[0], scene=dataclasses.replace(planned[0].scene, path=path))
    assert "<script" not in page(plan, tmp_path / "<b>.plan.json")


def test_commands_are_accepted_by_the_command_line(planned, tmp_path):
    plan, _ = planned
    path = tmp_path / "my plan.plan.json"
    assert cube_name(path) == "my plan.uplift"
    for line in commands(plan, path):
        parse(line)
    words = shlex.split(commands(plan, path)[1])
    assert words[words.index("--dim") + 1] == str(plan.options["dim"])
    assert words[words.index("--coefficients") + 1] == str(plan.options["coefficients"])


def test_options_of_candidates_are_accepted_by_the_command_line(planned):
    start = {
        "coefficients": "uplift build",
        "lattice": "uplift build",
        "wavelengths": "uplift texture a.png -o b.exr",
        "storage": "uplift texture a.png -o b.exr",
        "representation": "",
    }
    for decision in planned[0].decisions:
        for trial in decision.trials:
            parse(f"{start[decision.key]} {trial.cli_args}")


def parse(line):
    program, name, *arguments = shlex.split(line)
    assert program == "uplift"
    with click.Context(main, **main.context_settings) as context:
        main.get_command(context, name).make_context(name, arguments, parent=context)
