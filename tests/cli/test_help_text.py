"""Help texts fit their windows, and examples stay the same commands when they are folded."""

from __future__ import annotations

import shlex

import pytest
from rich.cells import cell_len
from uplift_cli.main import COMMANDS
from uplift_cli.output.help_text import fold_choices, fold_example

from tests.examples.collect import examples

WIDTHS = (60, 80)
LINES = sorted({example.line for example in examples() if example.line.startswith("uplift ")})


@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("name", ["", *COMMANDS])
def test_nothing_is_wider_than_the_window(run, name, width):
    shown = run(*name.split(), "--help", terminal_width=width).stdout
    assert max(map(cell_len, shown.splitlines())) <= width


@pytest.mark.parametrize("width", WIDTHS)
def test_folded_examples_are_the_same_commands(width):
    for line in LINES:
        rows = list(fold_example(f"  {line}", width))
        assert shlex.split("\n".join(rows).replace("\\\n", "")) == shlex.split(line)
        assert max(map(len, rows)) <= width or len(max(line.split(), key=len)) > width - 10
        assert all(row.endswith(" \\") for row in rows[:-1])


def test_options_stay_with_their_values():
    line = "uplift build --atlas macbeth --observer 'Nikon 5100 (NPL)' --dim 16 > log.txt"
    assert list(fold_example(line, 40)) == [
        "uplift build --atlas macbeth \\",
        "  --observer 'Nikon 5100 (NPL)' \\",
        "  --dim 16 > log.txt",
    ]


def test_other_lines_stay():
    assert list(fold_example("  a line of text that is long", 10)) == ["  a line of text that is long"]


def test_choices_are_broken_between_names():
    assert fold_choices("--to [one|two|three]", 14) == "--to [one|two|\n      three]"
    assert fold_choices("--to [one|two|three]", 40) == "--to [one|two|three]"


def test_the_help_shows_ranges_but_not_the_default_limit(run, misuse):
    assert "x<=" not in run("build", "--help").stdout
    assert "2<=x<=1000" in run("mix", "--help").stdout
    assert "greater than" in misuse("build", "--dim", "8", "--coefficients", "2000000000")


def test_subcommands_fold_as_well(run):
    shown = run("study", "moments", "--help", terminal_width=60).stdout
    assert max(map(cell_len, shown.splitlines())) <= 60
