"""The documentation is valid: its commands and options exist, its Python runs, its
links resolve.
"""

import contextlib
import fnmatch
import itertools
import re
import shlex
import sys
from itertools import chain
from types import ModuleType

import click
import pytest
from uplift_cli.main import COMMANDS, main

import uplift
from benchmarks.__main__ import pages
from tests.conftest import ROOT
from tests.examples import BLOCKS, CUBE, examples, examples_by_page, page_examples
from tests.helpers import warns
from tests.parts import MITSUBA, need
from uplift.atlas import Format
from uplift.extras import formats
from uplift.samples import sample_path

PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
REFERENCE = (ROOT / "docs" / "commands.md").read_text("utf-8")
COVERAGE = (ROOT / "docs" / "coverage.md").read_text("utf-8")
CONTRIBUTING = (ROOT / "CONTRIBUTING.md").read_text("utf-8")
TUTORIAL = (ROOT / "docs" / "tutorial.md").read_text("utf-8")
PYTHON = (ROOT / "docs" / "reference" / "python.md").read_text("utf-8")
CODE = ("uplift", "cli", "benchmarks", "tools")
LINES = [
    each.split(" > ")[0].split(" | ")[0]
    for each in examples()
    if each.startswith("uplift ")
]


OUTPUTS = ("-o", "--output", "--plot", "--plot-spectra", "--html", ">")
"""Options whose value is a file that is written."""


@pytest.mark.parametrize("name", COMMANDS)
def test_the_page_of_commands_has_every_command_and_help_has_examples(name):
    assert f"**`uplift {name}`**" in REFERENCE
    with click.Context(main, **main.context_settings) as context:
        command = main.get_command(context, name)
    assert re.search(rf"Examples:\n +uplift {name}\b", command.help)


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


@pytest.mark.parametrize(("name", "lines"), examples_by_page().items())
def test_a_page_makes_the_cubes_and_plans_that_it_uses(name, lines):
    """Help texts may use the cube of README. No file is written twice
    without --force.
    """
    written = set()
    made = [CUBE] if name.endswith("--help") else []
    for line in lines:
        words = shlex.split(line)
        outputs = {
            word for before, word in itertools.pairwise(words) if before in OUTPUTS
        }
        used = {
            word for word in words if word.endswith((".uplift", ".plan.json"))
        } - outputs
        unnamed = {
            "uplift plan" if word.endswith(".json") else "uplift build"
            for word in used - written
        }
        assert all(
            any(earlier.startswith(command) for earlier in made) for command in unnamed
        ), line
        assert not outputs & written or "--force" in words or "--resume" in words, line
        written |= outputs
        made += [line] if "-o" not in words else []


def test_the_python_page_runs(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (code,) = re.findall(r"```python\n(.*?)```", PYTHON, re.DOTALL)
    with warns():
        exec(compile(code, "python.md", "exec"), {})


def test_the_skeleton_of_a_reader_and_its_test_run(tmp_path, monkeypatch):
    reader, registration, test = re.findall(
        r"```python\n(.*?)```", CONTRIBUTING, re.DOTALL
    )
    module = ModuleType("uplift.extras.formats.spectrograph")
    exec(compile(reader, "reader", "exec"), module.__dict__)
    monkeypatch.setitem(sys.modules, module.__name__, module)
    spectrograph = eval(registration, {"Format": Format})
    monkeypatch.setattr(formats, "FORMATS", (*formats.FORMATS, spectrograph))
    tests: dict = {}
    exec(compile(test, "test", "exec"), tests)
    functions = [value for name, value in tests.items() if name.startswith("test_")]
    assert len(functions) > 1
    for function in functions:
        function(tmp_path)


def test_links_resolve():
    for page in PAGES:
        for target in re.findall(r"\]\((?!http)([^)#]+)\)", page.read_text("utf-8")):
            assert (page.parent / target).exists(), f"{page.name}: {target}"


def test_a_block_has_one_way_to_install():
    for page in PAGES:
        for _, block in BLOCKS.findall(page.read_text("utf-8")):
            assert block.count("pip install") <= 1, page.name


def test_pages_whose_examples_use_sample_files_say_so():
    samples = [path.name for path in sample_path(".").iterdir()]
    for page in PAGES:
        text = page.read_text("utf-8")
        lines = page_examples(text)
        if any(name in line.split() for name in samples for line in lines):
            assert "uplift samples" in text, page.name


def test_no_two_pages_have_one_title():
    pages = [
        *PAGES[1:],
        ROOT / "CHANGELOG.md",
        ROOT / "CONTRIBUTING.md",
        ROOT / "atlases" / "README.md",
    ]
    headings = [
        re.search("^# .+", page.read_text("utf-8"), re.MULTILINE) for page in pages
    ]
    titles = [heading[0] for heading in headings if heading]
    for module in (ROOT / "uplift").rglob("*.py"):
        source = module.read_text("utf-8")
        for template, title in re.findall(
            r'render\(\s+"(.+\.j2)",\s+title=(.+),\n', source
        ):
            constant = re.search(rf"^{re.escape(title)} = .+", source, re.MULTILINE)
            suffix = re.search(
                "block title %}.+",
                (ROOT / "uplift" / template).read_text("utf-8"),
            )
            titles.append(
                (constant[0] if constant else title) + (suffix[0] if suffix else "")
            )
    assert len(set(titles)) == len(titles) > 40


def test_make_targets_exist():
    makefile = (ROOT / "Makefile").read_text("utf-8")
    for page in PAGES:
        for target in re.findall(
            r"`make ([\w-]+)`", " ".join(page.read_text("utf-8").split())
        ):
            assert re.search(rf"^{target}:", makefile, re.MULTILINE), target


FILE = r"(?:uplift|cli|tests|benchmarks|tools|docs|atlases)/[\w./-]*\w"


def missing(names):
    """Files that are neither in the repository nor in the package; NAME and PAGE in a
    name stand for any.
    """
    names = [name for name in names if not re.search("NAME|PAGE", name)]
    return [
        name
        for name in names
        if not (ROOT / name).exists() and not (ROOT / "uplift" / name).exists()
    ]


def test_files_that_the_pages_name_exist():
    for page in [*PAGES, ROOT / "CONTRIBUTING.md"]:
        assert (
            missing(
                re.findall(
                    rf"`({FILE}|[\w-]+/[\w./-]+\.py)/?`", page.read_text("utf-8")
                )
            )
            == []
        ), page.name


def test_files_and_names_in_docstrings_exist():
    """A name in backticks also stands somewhere outside of them."""
    texts = {
        path: path.read_text("utf-8")
        for folder in CODE
        for path in (ROOT / folder).rglob("*.py")
    }
    words = {path.stem for path in texts}
    words |= set(
        chain.from_iterable(
            re.findall(r"\w+", re.sub("`[^`]*`", "", text)) for text in texts.values()
        )
    )
    for path, text in texts.items():
        names = re.findall(r"(?<!`)`([A-Za-z_][\w.]*?(?<!\.py)(?<!\.toml))`(?!`)", text)
        assert [
            each for each in names if not words.issuperset(each.split("."))
        ] == [], path
        assert missing(re.findall(rf"\b{FILE}", text)) == [], path


REASONS = ("background", "not done", "not offered", "cannot be repeated")


def test_the_page_of_coverage_has_no_empty_row_and_names_what_exists():
    lines = [
        line.strip("|").split("|")
        for line in COVERAGE.splitlines()
        if line.startswith("| ")
    ]
    table = [[cell.strip() for cell in row] for row in lines]
    assert len(table) > 80
    assert [row for row in table if len(row) != 4 or not all(row)] == []
    shown = [row for row in table if row[3] not in ("—", "shown by")]
    assert [
        row for row in table if row[3] == "—" and not row[2].startswith(REASONS)
    ] == []
    assert [
        row
        for row in shown
        if (code := re.findall("`([^`]+)`", row[3])) == []
        or not all(map(is_real, code))
    ] == []


def is_real(code):
    """Whether a test of this path and name, a page that can be measured, or a command
    of this line exists.
    """
    path, _, name = code.partition("::")
    if path.startswith("tests/"):
        return (ROOT / path).is_file() and (
            not name or f"def {name}(" in (ROOT / path).read_text("utf-8")
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
    blocks = re.findall(r"```(\w*)\n(.*?)```", TUTORIAL, re.DOTALL)
    assert [language for language, _ in blocks].count("python") == 2
    for language, block in blocks:
        if language == "python":
            exec(compile(block, "tutorial.md", "exec"), names)
        else:
            for line in block.splitlines():
                assert main.main(args=shlex.split(line)[1:], standalone_mode=False) in (
                    None,
                    0,
                ), line
    written = {path.name for path in tmp_path.iterdir()}
    assert written >= {
        "orange.png",
        "macbeth-32.html",
        "chart.exr",
        "chart-moments.exr",
        "fl11.png",
    }
    assert uplift.load("macbeth-32.uplift").dim == 32


def test_pages_that_use_a_sample_file_say_where_it_comes_from():
    samples = {path.name for path in sample_path(".").iterdir()}
    for name, lines in examples_by_page().items():
        words = set(
            chain.from_iterable(re.split(r"[\s='\":]+", line) for line in lines)
        )
        used = set(chain.from_iterable(fnmatch.filter(samples, word) for word in words))
        if name.endswith(".md") and used:
            assert "uplift samples" in (ROOT / name).read_text("utf-8"), (
                f"{name}: {used}"
            )
