"""The documentation is true: commands exist, their options too, and the Python runs."""

from __future__ import annotations

import re
import shlex

import click
import pytest
from uplift_cli.main import COMMANDS, main

from tests.conftest import ROOT

PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
README = PAGES[0].read_text(encoding="utf-8")


def command_lines():
    """Every ``uplift …`` line of the pages' code blocks."""
    for page in PAGES:
        for block in re.findall(r"```\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL):
            for line in block.splitlines():
                words = re.sub(r"^\$ ", "", line).split(" > ")[0]
                if words.startswith("uplift "):
                    yield words


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_is_in_the_readme_and_its_help_has_examples(name):
    assert f"**`uplift {name}`**" in README
    with click.Context(main, **main.context_settings) as context:
        command = main.get_command(context, name)
    assert re.search(rf"Examples:\n +uplift {name} ", command.help)


@pytest.mark.parametrize("line", list(command_lines()))
def test_every_command_line_parses(line):
    name, *arguments = shlex.split(line)[1:]
    with click.Context(main, **main.context_settings) as context:
        command = main.get_command(context, name)
        command.make_context(name, arguments, parent=context)


def test_there_are_command_lines_to_parse():
    assert len(list(command_lines())) >= 8


def test_a_line_with_an_option_that_does_not_exist_would_not_parse():
    with click.Context(main, **main.context_settings) as context, pytest.raises(click.NoSuchOption):
        main.get_command(context, "build").make_context("build", ["--dimension", "3"], parent=context)


def test_the_readme_s_python_runs(tmp_path, monkeypatch):
    (tmp_path / "atlases").symlink_to(ROOT / "atlases")
    monkeypatch.chdir(tmp_path)
    (code,) = re.findall(r"```python\n(.*?)```", README, re.DOTALL)
    with pytest.warns(UserWarning, match="cyan"):
        exec(compile(code, "README.md", "exec"), {})


def test_links_lead_somewhere():
    for page in PAGES:
        for target in re.findall(r"\]\((?!http)([^)#]+)\)", page.read_text(encoding="utf-8")):
            assert (page.parent / target).exists(), f"{page.name}: {target}"


def test_make_targets_that_the_pages_name_exist():
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    for page in PAGES:
        for target in re.findall(r"`make ([\w-]+)`", " ".join(page.read_text(encoding="utf-8").split())):
            assert re.search(rf"^{target}:", makefile, re.MULTILINE), target
