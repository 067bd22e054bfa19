"""The documentation is valid: its commands and options exist, its Python runs, its links resolve."""

from __future__ import annotations

import re
import shlex

import click
import pytest
from uplift_cli.main import COMMANDS, main

from tests.conftest import ROOT
from tests.examples.collect import examples
from tests.helpers import warns

PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
REFERENCE = (ROOT / "docs" / "commands.md").read_text(encoding="utf-8")
PYTHON = (ROOT / "docs" / "python.md").read_text(encoding="utf-8")


LINES = [each.line.split(" > ")[0].split(" | ")[0] for each in examples() if each.line.startswith("uplift ")]


@pytest.mark.parametrize("name", COMMANDS)
def test_the_page_of_commands_has_every_command_and_help_has_examples(name):
    assert f"**`uplift {name}`**" in REFERENCE
    with click.Context(main, **main.context_settings) as context:
        command = main.get_command(context, name)
    assert re.search(rf"Examples:\n +uplift {name}\b", command.help)


@pytest.mark.parametrize("line", LINES)
def test_command_lines_parse(line):
    name, *arguments = shlex.split(line)[1:]
    with click.Context(main, **main.context_settings) as context:
        command = main.get_command(context, name)
        command.make_context(name, arguments, parent=context)


def test_the_python_page_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (code,) = re.findall(r"```python\n(.*?)```", PYTHON, re.DOTALL)
    with warns("entry-out-of-gamut"):
        exec(compile(code, "python.md", "exec"), {})


def test_links_resolve():
    for page in PAGES:
        for target in re.findall(r"\]\((?!http)([^)#]+)\)", page.read_text(encoding="utf-8")):
            assert (page.parent / target).exists(), f"{page.name}: {target}"


def test_make_targets_exist():
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    for page in PAGES:
        for target in re.findall(r"`make ([\w-]+)`", " ".join(page.read_text(encoding="utf-8").split())):
            assert re.search(rf"^{target}:", makefile, re.MULTILINE), target


def test_files_that_the_pages_name_exist():
    for page in [*PAGES, ROOT / "CONTRIBUTING.md"]:
        named = re.findall(r"`((?:uplift|cli|tests|benchmarks|tools|docs|atlases)/[\w./-]+)`", page.read_text("utf-8"))
        missing = [name for name in named if "NAME" not in name and not (ROOT / name).exists()]
        assert missing == [], page.name
