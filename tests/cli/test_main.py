"""Behaviour that all commands share: help, completion, numbers, errors and warnings,
tables and progress.
"""

import ast
import errno
import json
import re
import sys
import time
import warnings
from importlib import metadata
from itertools import chain

import click
import pytest
from click.testing import CliRunner
from rich.cells import cell_len
from uplift_cli.command import HELP_ALL
from uplift_cli.commands.help import GAMUT_MEANINGS, MODE_MEANINGS, TOPICS
from uplift_cli.commands.lab import SUMMARIES
from uplift_cli.main import COMMANDS, main
from uplift_cli.option_types import Number
from uplift_cli.output import progress as progress_module
from uplift_cli.output.diagnostics import HINTS, hint_for
from uplift_cli.output.progress import progress_bar
from uplift_cli.output.table import Table
from uplift_cli.startup import _respell

import uplift
from tests.conftest import ROOT
from tests.helpers import output_of
from uplift.colorimetry.gamut import METHODS
from uplift.common.errors import UpliftError, UpliftWarning
from uplift.common.progress import Progress
from uplift.common.text import printable
from uplift.lookup.interpolate import MODES
from uplift.samples import sample_path

from .conftest import commands


def test_help_lists_what_is_used_every_week_on_one_screen(run, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    lines = run("--help").stdout.splitlines()
    assert len(lines) <= 24
    assert [line.split()[0] for line in lines[4:]] == list(COMMANDS)
    below = run("lab").stdout
    for name in SUMMARIES:
        assert below.count(f"\n  {name} ") == 1
    assert run("--version").stdout == f"uplift {uplift.__version__}\n"


@pytest.mark.parametrize("command", ["build", "export"])
def test_help_shows_the_options_of_every_day_and_help_all_shows_all(run, command):
    short, full = (
        set(re.findall(r"(?<!\S)--\S+", run(f"{command} {option}").stdout))
        for option in ("--help", "--help-all")
    )
    assert {"--output", "--force", "--help", "--help-all"} <= short
    assert short < full


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        ("uplift tex", "texture"),
        ("uplift build --observer Nik", "Nikon 5100 (NPL)"),
        ("uplift info sr", "srgb"),
    ],
)
def test_shells_complete_names(run, monkeypatch, words, expected):
    monkeypatch.setenv("COMP_WORDS", words)
    monkeypatch.setenv("COMP_CWORD", str(len(words.split()) - 1))
    result = run(env={"_MAIN_COMPLETE": "bash_complete"}, prog_name="main")
    assert f"plain,{expected}" in result.stdout.splitlines()


@pytest.fixture
def failing(monkeypatch):
    """Make ``uplift info x`` raise an error."""

    def failing(error):
        def fail(path):
            raise error

        monkeypatch.setattr("uplift.lookup.cube.load", fail)

    return failing


def test_errors_are_one_line_with_the_hint_of_the_command_line(failing, run):
    error = UpliftError(
        "exists already", code="file-exists", path="x", line=3, hint="pass force=True"
    )
    failing(error)
    result = run("info x", code=2)
    assert result.stdout == ""
    assert result.stderr == "error: x:3: exists already; pass --force\n"
    result = run("info x --format json", code=2)
    assert result.stdout == ""
    assert json.loads(result.stderr)["error"] == {
        "code": "file-exists",
        "where": "x:3",
        "problem": "exists already",
        "hint": "pass --force",
    }


@pytest.mark.parametrize(
    "bug",
    [
        RuntimeError("a bug\nof two lines\x1b[2J"),
        UnicodeEncodeError("utf-8", "\udcff", 0, 1, "x"),
    ],
)
def test_internal_errors_are_one_line_with_exit_code_70(failing, run, monkeypatch, bug):
    monkeypatch.delenv("UPLIFT_TRACEBACK")
    failing(bug)
    message = run("info x", code=70).stderr
    assert f"please report it: {type(bug).__name__} in test_main.py:" in message
    assert message == printable(message[:-1]) + "\n"
    result = run("info x --format json", code=70)
    assert json.loads(result.stderr)["error"]["code"] == "internal-error"
    assert CliRunner().invoke(main, ["--traceback", "info", "x"]).exception is bug


def test_packages_that_are_too_old_are_named(failing, refuse, monkeypatch):
    monkeypatch.setattr(metadata, "version", lambda name: "0.9.9")
    failing(AttributeError("a name of later versions"))
    assert refuse("info x").code == "package-too-old"


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (MemoryError(), "out-of-memory"),
        (RuntimeError("RESOURCE_EXHAUSTED: Out of memory"), "out-of-memory"),
        (OSError(errno.ENOSPC, "No space left on device"), "output"),
    ],
)
def test_failures_of_the_system_are_errors(failing, refuse, error, code):
    failing(error)
    assert refuse("info x").code == code


def test_warnings_of_the_library_are_one_line_each_and_others_are_ignored(
    monkeypatch, run
):
    cube = uplift.load()

    def load(path):
        skipped = UpliftWarning("is left out", code="entry-skipped", entry="a")
        warnings.warn(skipped, stacklevel=2)
        with warnings.catch_warnings():
            warnings.simplefilter("always")
            warnings.warn("internal", RuntimeWarning, stacklevel=2)
        return cube

    monkeypatch.setattr("uplift.lookup.cube.load", load)
    before = warnings.showwarning
    warning = f"warning: entry 'a': is left out; {HINTS['entry-skipped']}\n"
    assert run("info").stderr == warning
    assert warnings.showwarning is before


COMMANDS_BY_PATH = commands(main)


def test_help_of_a_command_is_that_of_its_option_and_of_a_group_alone(run):
    for path, command in COMMANDS_BY_PATH.items():
        shown = run(f"{path} --help").stdout
        assert shown.startswith("Usage: ")
        assert run(f"help {path}").stdout == shown, path
        if isinstance(command, click.Group):
            assert run(path).stdout == shown


def test_topics_have_text_and_names_that_no_command_has(run):
    assert not TOPICS.keys() & set(COMMANDS)
    for topic in TOPICS:
        assert len(run("help", topic).stdout) > 100
    assert MODE_MEANINGS.keys() == MODES.keys()
    assert tuple(GAMUT_MEANINGS) == METHODS


HELP_OF_ALL = """
import json, click
from uplift_cli.commands.help import TOPICS
from uplift_cli.main import main
from tests.cli.conftest import commands
every = (main, *commands(main).values())
texts = [command.get_help(click.Context(command)) for command in every]
print(json.dumps([texts, [str(parts()) for _, parts in TOPICS.values()]]))
"""


def test_help_does_not_depend_on_docstrings():
    plain, optimised = (
        output_of(sys.executable, *flags, "-c", HELP_OF_ALL, cwd=ROOT)
        for flags in ([], ["-OO"])
    )
    assert optimised == plain


def test_help_fits_80_columns(monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    for command in (main, *COMMANDS_BY_PATH.values()):
        with click.Context(command, info_name="uplift lights texture") as context:
            context.meta[HELP_ALL] = True
            assert max(map(len, command.get_help(context).splitlines())) <= 80, (
                command.name
            )


OPTIONS = []
for command in COMMANDS_BY_PATH.values():
    OPTIONS += [(command, option) for option in command.params]
KNOWN = set(chain.from_iterable(option.opts for _, option in OPTIONS))
SOURCES = {path: path.read_text("utf-8") for path in (ROOT / "uplift").rglob("*.py")}


def test_hints_name_options_and_codes_that_exist():
    for code, hint in HINTS.items():
        assert any(f'"{code}"' in source for source in SOURCES.values()), code
        assert KNOWN.issuperset(re.findall(r"(?<!\S)--[a-z-]+", hint)), hint


def test_texts_of_the_library_name_parameters_that_are_options_and_no_options():
    in_hints = {"measured", "outside"}  # of errors with a hint in `HINTS`
    for path, source in SOURCES.items():
        # Rooms and files that have programs.
        if {"lab", "pages", "timing.py"} & set(path.parts):
            continue
        for text in prose(source):
            assert text.startswith("uplift ") or not re.search(" --[a-z]", text), path
            names = re.findall(r"""(?<![\w'"-])([a-z_]+)=(?=$|['"\w])""", text)
            for name in set(names) - in_hints:
                assert f"--{name.replace('_', '-')}" in KNOWN, f"{path}: {text}"


def prose(source):
    """Texts with blanks of a module, without its docstrings."""
    nodes = list(ast.walk(ast.parse(source)))
    docs = {node.value for node in nodes if isinstance(node, ast.Expr)}
    for node in nodes:
        text = getattr(node, "value", None)
        if isinstance(text, str) and " " in text and node not in docs:
            yield text


@pytest.mark.parametrize(
    ("hint", "shown"),
    [
        ("use dim=8 or less", "use --dim 8 or less"),
        ("use out_of_gamut='clip'", "use --out-of-gamut clip"),
        ("tables.names('illuminant') lists all", "'uplift help illuminants' lists all"),
        ("did you mean 'a=b'?", "did you mean 'a=b'?"),
    ],
)
def test_hints_of_the_library_name_options_on_the_command_line(hint, shown):
    assert hint_for(UpliftError("is bad", hint=hint)) == shown


def test_invalid_numbers_are_refused_on_one_line():
    numeric = (Number, click.types.IntParamType, click.types.FloatParamType)
    for _, option in OPTIONS:
        if not isinstance(option.type, numeric):
            continue
        for number in ("nan", "inf", "1e999", "1_0", "٣", "9" * 5000, "", "0x10"):
            with pytest.raises(click.BadParameter) as caught:
                option.type.convert(number, option, None)
            assert caught.value.message.isprintable()
            assert len(caught.value.message) < 200


def test_tables_wrap_texts_and_show_them_as_they_are(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "60")
    row = {
        "name": "[r]\x1b[2J",
        "first": 1234567.25,
        "rgb": [0.25, -0.5],
        "text": "some words of text, and more",
    }
    Table(
        [row], dict(zip(row, row, strict=True)), formats={"first": ".1f"}
    ).print_text()
    *_, first, second = capsys.readouterr().out.splitlines()
    assert max(cell_len(first), cell_len(second)) <= 60
    assert first.startswith("[r]\\x1b[2J  1234567.2  0.250 -0.500  some words")


def test_rows_are_csv_with_a_column_for_each_number(capsys):
    rows = [{"rgb": [0.1, 0.2, 0.3], "ok": True, "notes": ["a", "b"], "none": None}]
    Table(rows).print_csv()
    assert capsys.readouterr().out == "r,g,b,ok,notes,none\n0.1,0.2,0.3,true,a; b,\n"


@pytest.mark.parametrize(
    "command",
    [
        "atlas macbeth",
        "lab bounds #8a2a20",
        "info {}/moments-8-macbeth.uplift",
        "lights info",
        "query #da7b2a --light A",
    ],
)
def test_no_line_breaks_inside_a_word_at_80_columns(run, monkeypatch, cubes, command):
    printed = []
    for columns in ("500", "80"):
        monkeypatch.setenv("COLUMNS", columns)
        text = run(command.replace("{}", str(cubes))).stdout
        printed.append(re.sub("[─▁-█]+", "", text))  # rules and sparklines
    wide, narrow = printed
    assert max(map(cell_len, narrow.splitlines())) <= 80
    assert set(narrow.split()) <= set(wide.split())


def test_progress_off_terminals_is_a_line_now_and_then(monkeypatch, capsys):
    clock = iter(range(0, 100, 4))
    monkeypatch.setattr(time, "monotonic", lambda: float(next(clock)))
    monkeypatch.setattr(progress_module, "INTERVAL", 10.0)
    with progress_bar() as report:
        for _ in range(4):
            report(Progress("fit", 3, 8, detail="round 2"))
    assert capsys.readouterr().err == "fitting: 3 of 8, round 2\n"


@pytest.mark.parametrize(
    ("command", "words"),
    [
        ("info wood.png", "must be an uplift cube, got an image"),
        ("build --atlas {}", "must be a file of spectra, got a cube"),
        ("plan wood.png", "not UTF-8, but an image"),
        ("query --check wood.png", "not UTF-8, but an image"),
        ("query --input .", "error: ."),
        ("atlas macbet.txt", "'macbeth'"),
        ("build --space nosuch", "; 'uplift help spaces' lists all"),
        ("query 0.1 0.1 0.1 --light 2700", "did you mean '2700K'?"),
        ("build --observer paints.csv", "use --space camera"),
        (
            "lights build --atlas macbeth",
            "macbeth: the file states reflectance ('reflectance spectrum')",
        ),
        (
            "build --atlas macbeth --atlas paints.csv",
            "first used at macbeth:7; leave out one of the two files",
        ),
    ],
)
def test_errors_name_what_was_given_and_what_to_do(
    run, monkeypatch, cubes, command, words
):
    monkeypatch.chdir(sample_path("."))
    assert words in run(command.format(cubes / "moments-8.uplift"), code=2).stderr


def test_texts_without_unicode_are_spelt_in_ascii():
    spelt = "ΔE00 0–1, 16³ × ▁▄█".encode("ascii", _respell.__name__)
    assert spelt == b"dE00 0-1, 16^3 x _:#"
