"""``uplift chart``."""

import os
import re
from dataclasses import replace

import matplotlib.image
import pytest
from click.testing import CliRunner
from uplift_cli.main import main

from tests.lab.chart import faulty
from uplift.extras.timing import ONE_THREAD
from uplift.lab.chart import selection, task
from uplift.lab.chart.results import read_chart

FILES = ["chart.csv", "chart.html", "chart.png"]
FOREIGN = {each.method for each in selection.METHODS if each.needs}
"""Methods that a machine may lack."""


@pytest.fixture(scope="module")
def quick(repository, tmp_path_factory):
    """A quick chart of the ColorChecker with short timings: its folder and the result
    of the command.
    """
    folder = tmp_path_factory.mktemp("quick")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        patch.setattr(
            task,
            "QUICK",
            replace(task.QUICK, colours=300, seconds_per_error=0.1, longest=0.02),
        )
        for name, value in ONE_THREAD.items():
            patch.setenv(name, value)
        atlas = str(repository / "atlases" / "macbeth.txt")
        words = ["chart", "--quick", "--atlas", atlas, "-o", "out"]
        words += [
            f"--method={name}"
            for name in ("mallett2019", "moments9-16*-spectra", "sigmoid-32-moments")
        ]
        result = CliRunner().invoke(main, words, catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return folder / "out", result


@pytest.fixture(scope="module")
def numbers(quick):
    """Numbers of the measured methods by name."""
    return {
        row.method: row.numbers for row in read_chart(quick[0] / "chart.csv").measured
    }


def test_all_files_are_written_and_fronts_printed(quick, numbers):
    folder, result = quick
    assert sorted(os.listdir(folder)) == FILES
    assert matplotlib.image.imread(folder / "chart.png").std() > 0.05
    assert re.search(r"marker-0-\d", (folder / "chart.html").read_text("utf-8"))
    assert sum(name in result.stdout for name in numbers) >= 2
    assert result.stderr == "out: chart.csv, chart.png, chart.html\n"
    assert all(
        found["time_ns"] > 0 and found["bytes"] > 0 for found in numbers.values()
    )
    assert {row.method for row in read_chart(folder / "chart.csv").results} - set(
        numbers
    ) <= FOREIGN


def test_an_atlas_improves_its_own_materials(numbers):
    own = {
        name: numbers[f"moments9-16{name}-spectra"]["own_lights_mean"]
        for name in ("", "-atlas")
    }
    assert own["-atlas"] < own[""] / 2


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
@pytest.mark.parametrize(
    ("name", "limit", "state", "why"),
    [
        ("abort", task.QUICK.limit, "broken", "crashed: signal 6; it needs "),
        ("hang", 1.0, "broken", "no answer within 1 s; it needs "),
        ("lack", task.QUICK.limit, "not installed", "needs "),
    ],
)
def test_methods_that_crash_hang_or_are_missing_have_rows(
    run, macbeth, monkeypatch, name, limit, state, why
):
    monkeypatch.setattr(task, "QUICK", replace(task.QUICK, limit=limit))
    monkeypatch.setattr(selection, "METHODS", (*selection.METHODS, *faulty.METHODS))
    methods = f"--method mallett2019 --method faulty-{name}"
    result = run("chart --quick -o out --atlas", macbeth, *methods.split())
    other, row = read_chart("out/chart.csv").results
    assert (other.state, other.why) == ("measured", "")
    assert (row.state, row.why) == (state, why + faulty.NEEDS)
    assert f"faulty-{name}: {state}, not drawn: {row.why}" in result.stdout


def test_chart_can_be_redrawn_from_its_table(quick, run, refuse):
    table = quick[0] / "chart.csv"
    result = run("chart -o again --from", table)
    assert result.stdout == quick[1].stdout
    error = refuse("chart -o again --from", table)
    assert (error.code, error.path.name) == ("file-exists", "chart.csv")


def test_page_and_command_recommend_the_same_cubes(run, repository):
    page = (repository / "docs" / "choosing.md").read_text("utf-8")
    printed = [
        line.strip()
        for line in run("chart --recommend").stdout.splitlines()
        if line.startswith("  ")
    ]
    pairs = [
        f"`{build}`, then\n  `{call}`"
        for build, call in zip(printed[::2], printed[1::2], strict=True)
    ]
    assert len(pairs) > 2
    assert [pair for pair in pairs if pair not in page] == []


def test_recommendations(quick, run, refuse):
    table = quick[0] / "chart.csv"
    result = run("chart --recommend --tolerance 0.05 --light D65 --from", table)
    assert re.search(r"\n  uplift build (--atlas FILE )?--dim \d+ ", result.stdout)
    assert (
        refuse("chart --recommend --time-ns 0.5 --from", table).code
        == "requirements-not-met"
    )
    result = run("chart --recommend --tolerance 1 --light FL11 --atlas-materials")
    assert "--atlas FILE" in result.stdout
