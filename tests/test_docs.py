"""The documentation is valid: its commands and options exist, its Python runs, its
links resolve.
"""

import contextlib
import re
import shlex
import sys
from types import ModuleType

import click
import numpy as np
import pytest
from uplift_cli.commands.lab import SUMMARIES
from uplift_cli.main import COMMANDS, main

from benchmarks.__main__ import pages
from tests.cli.conftest import commands
from tests.conftest import ROOT
from tests.examples import examples
from tests.helpers import output_of, warns
from tests.parts import MITSUBA, need
from uplift.atlas.formats import Format
from uplift.atlas.sources import read_atlas
from uplift.extras import formats
from uplift.lab.runner import divided
from uplift.samples import sample_path

PAGES = {
    page: page.read_text("utf-8")
    for page in (ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md")))
}
REFERENCE = PAGES[ROOT / "docs" / "commands.md"]
COVERAGE = PAGES[ROOT / "docs" / "coverage.md"]
TUTORIAL = PAGES[ROOT / "docs" / "tutorial.md"]
PYTHON = PAGES[ROOT / "docs" / "reference" / "python.md"]
GRADIENTS = PAGES[ROOT / "docs" / "guides" / "gradients.md"]
CONTRIBUTING = (ROOT / "CONTRIBUTING.md").read_text("utf-8")


def python_blocks(text):
    """The blocks of Python of a page."""
    return re.findall(r"```python\n(.*?)```", text, re.DOTALL)


SKELETONS = python_blocks(CONTRIBUTING)
CODE = ("uplift", "cli", "benchmarks", "tools")
LINES = [
    line.split(" > ")[0].split(" | ")[0]
    for line in examples()
    if line.startswith("uplift ")
]


@pytest.mark.parametrize(
    "name", [*COMMANDS, *map("lab {}".format, SUMMARIES), "paints mix"]
)
def test_the_page_of_commands_has_every_command_and_help_has_examples(name):
    assert f"**`uplift {name}`**" in REFERENCE
    text = commands(main)[name].help
    assert re.search(rf"Examples:\n +uplift {name}\b", text)


@pytest.mark.parametrize("line", LINES)
def test_command_lines_parse(line):
    name, *arguments = shlex.split(line)[1:]
    # Files of lamps are read.
    with (
        click.Context(main, **main.context_settings) as context,
        contextlib.chdir(sample_path("lamp.spd").parent),
    ):
        command = main.get_command(context, name)
        command.make_context(name, arguments, parent=context)


def run_blocks(*blocks):
    """Run blocks of Python, and return the names that they define."""
    names: dict = {}
    for block in blocks:
        exec(compile(block, "block", "exec"), names)
    return names


def test_the_python_page_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, processes = python_blocks(PYTHON)
    with warns():
        run_blocks(code)
    (tmp_path / "processes.py").write_text(processes)
    printed = output_of(sys.executable, "processes.py", timeout=100)
    assert printed.count(",") == 2


def test_the_page_of_gradients_runs():
    with warns():
        names = run_blocks(*python_blocks(GRADIENTS))
    assert np.shape(names["spectra"]) == (24, 81)
    assert np.shape(names["batch"]) == (1000, 1, 81)


def test_a_look_into_a_build_prints_what_made_a_node(capsys):
    run_blocks(SKELETONS[0])
    assert "length" in capsys.readouterr().out


def test_the_skeleton_of_an_export_writes_a_file(tmp_path, small_cube):
    path = tmp_path / "names.txt"
    run_blocks(SKELETONS[1])["export"](small_cube, path, "names", force=False)
    assert path.read_text().splitlines() == list(small_cube.atlas_names)


def test_the_skeleton_of_a_reader_and_its_test_run(tmp_path, monkeypatch):
    reader, registration, test = SKELETONS[2:5]
    module = ModuleType("uplift.extras.formats.spectrograph")
    exec(compile(reader, "reader", "exec"), module.__dict__)
    monkeypatch.setitem(sys.modules, module.__name__, module)
    spectrograph = eval(registration, {"Format": Format})
    monkeypatch.setattr(formats, "FORMATS", (*formats.FORMATS, spectrograph))
    tests = run_blocks(test)
    functions = [value for name, value in tests.items() if name.startswith("test_")]
    assert len(functions) > 1
    for function in functions:
        function(tmp_path)


def test_the_skeleton_of_a_method_returns_known_spectra(sensor):
    (method,) = run_blocks(SKELETONS[5])["METHODS"]
    task = next(divided(read_atlas("tcs"), (), sensor))
    known = task.known_spectra
    uplift = method.prepare(task).uplift
    assert (uplift(sensor.rgb(known), sensor.wavelengths) == known).all()


def test_the_skeleton_of_a_page_of_measurements_runs():
    page = run_blocks(SKELETONS[6])
    assert next(page["errors"]())["light"] == "A"
    assert next(page["times"]())["cpu_s"].min > 0


def test_links_resolve():
    for page, text in PAGES.items():
        for target in re.findall(r"\]\((?!http)([^)#]+)\)", text):
            assert (page.parent / target).exists(), f"{page.name}: {target}"


def test_make_targets_exist():
    makefile = (ROOT / "Makefile").read_text("utf-8")
    for text in PAGES.values():
        for target in re.findall(r"`make ([\w-]+)`", " ".join(text.split())):
            assert re.search(rf"^{target}:", makefile, re.MULTILINE), target


FILE = r"(?:uplift|cli|tests|benchmarks|tools|docs|atlases)/[\w./-]*\w"


def missing(names):
    """Files that are neither in the repository nor in the package; NAME and PAGE in a
    name stand for any.
    """
    return [
        name
        for name in names
        if not re.search("NAME|PAGE", name)
        and not (ROOT / name).exists()
        and not (ROOT / "uplift" / name).exists()
    ]


def test_files_that_the_pages_name_exist():
    for text in (*PAGES.values(), CONTRIBUTING):
        names = re.findall(rf"`({FILE}|[\w-]+/[\w./-]+\.py)/?`", text)
        assert missing(names) == []


def test_files_and_names_in_docstrings_exist():
    """A name in backticks also stands somewhere outside of them."""
    texts = {}
    words = set()
    for folder in CODE:
        for path in (ROOT / folder).rglob("*.py"):
            text = texts[path] = path.read_text("utf-8")
            words.add(path.stem)
            words.update(re.findall(r"\w+", re.sub("`[^`]*`", "", text)))
    for path, text in texts.items():
        for name in re.findall(
            r"(?<!`)`([A-Za-z_][\w.]*?(?<!\.py)(?<!\.toml))`(?!`)", text
        ):
            assert words.issuperset(name.split(".")), f"{path}: {name}"
        assert missing(re.findall(rf"\b{FILE}", text)) == [], path


REASONS = ("background", "not done", "not offered", "cannot be repeated")


def test_the_page_of_coverage_has_no_empty_row_and_names_what_exists():
    table = [line for line in COVERAGE.splitlines() if line.startswith("| ")]
    assert len(table) > 80
    for line in table:
        row = [cell.strip() for cell in line.strip("|").split("|")]
        assert len(row) == 4, line
        assert all(row), line
        _, _, status, shown_by = row
        if shown_by == "—":
            assert status.startswith(REASONS), line
        elif shown_by != "shown by":
            code = re.findall("`([^`]+)`", shown_by)
            assert code, line
            assert all(map(is_real, code)), line


def is_real(code):
    """Whether a test of this path and name, a page that can be measured, or a command
    of this line exists.
    """
    path, _, name = code.partition("::")
    if path.startswith("tests/"):
        file = ROOT / path
        return file.is_file() and (
            not name or f"def {name}(" in file.read_text("utf-8")
        )
    if code.startswith("make measure PAGE="):
        return code.removeprefix("make measure PAGE=") in pages()
    if code.startswith("uplift "):
        test_command_lines_parse(code)
        return True
    return code == "make site"


@pytest.mark.filterwarnings("ignore::uplift.UpliftWarning")
def test_the_tutorial_runs(tmp_path, monkeypatch):
    need(MITSUBA)
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    for language, block in re.findall(r"```(\w*)\n(.*?)```", TUTORIAL, re.DOTALL):
        if language == "python":
            exec(compile(block, "tutorial.md", "exec"), names)
        else:
            for line in block.splitlines():
                code = main.main(shlex.split(line)[1:], standalone_mode=False)
                assert not code, line
    for name in ("orange.png", "macbeth-32.html", "chart-moments.exr", "fl11.png"):
        assert (tmp_path / name).is_file()
