"""``uplift chart``."""

import os
import re
from dataclasses import replace

import pytest
from click.testing import CliRunner
from uplift_cli.main import main

from tests.lab.chart import faulty
from uplift.extras.timing import ONE_THREAD
from uplift.lab.chart import selection, task
from uplift.lab.chart.results import read_chart


@pytest.fixture(scope="module")
def quick(repository, tmp_path_factory):
    """A quick chart of the ColorChecker with short timings, with a method that crashes
    and one that is missing: its folder and the result of the command.
    """
    folder = tmp_path_factory.mktemp("quick")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        haste = {"seconds_per_error": 0.1, "longest": 0.02, "batches": (1, 1000)}
        patch.setattr(task, "QUICK", replace(task.QUICK, colours=300, **haste))
        patch.setattr(selection, "METHODS", (*selection.METHODS, *faulty.METHODS))
        for name, value in ONE_THREAD.items():
            patch.setenv(name, value)
        atlas = str(repository / "atlases" / "macbeth.txt")
        words = ["chart", "--quick", "--atlas", atlas, "-o", "out"]
        words += ["--method", "mallett2019", "--method", "moments9-16*-spectra"]
        words += ["--method", "faulty-*"]
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
    assert set(os.listdir(folder)) == {"chart.csv", "chart.html", "chart.png"}
    assert "moments9-16-atlas-spectra" in result.stdout
    for found in numbers.values():
        assert found["time_ns"] > 0
        assert found["bytes"] > 0


def test_an_atlas_improves_its_own_materials(numbers):
    plain = numbers["moments9-16-spectra"]["own_lights_mean"]
    assert numbers["moments9-16-atlas-spectra"]["own_lights_mean"] < plain / 2


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
def test_methods_that_crash_or_are_missing_have_rows(quick):
    folder, result = quick
    *_, aborted, lacking = read_chart(folder / "chart.csv").results
    reason = f"crashed: signal 6; it needs {faulty.NEEDS}"
    assert (aborted.state, aborted.why) == ("broken", reason)
    reason = f"needs {faulty.NEEDS}"
    assert (lacking.state, lacking.why) == ("not installed", reason)
    for row in (aborted, lacking):
        assert f"{row.method}: {row.state}, not drawn: {row.why}" in result.stdout


def test_chart_can_be_redrawn_from_its_table(quick, run):
    table = quick[0] / "chart.csv"
    assert run("chart -o again --from", table).stdout == quick[1].stdout


def test_page_and_command_recommend_the_same_cubes(run, repository):
    page = (repository / "docs" / "choosing.md").read_text("utf-8")
    printed = re.findall(r"^  (.+)\n  (.+)$", run("chart --recommend").stdout, re.M)
    assert len(printed) > 2
    for build, call in printed:
        assert f"`{build.strip()}`, then\n  `{call.strip()}`" in page


def test_recommendations(quick, run, refuse):
    table = quick[0] / "chart.csv"
    result = run("chart --recommend --tolerance 0.05 --light D65 --from", table)
    assert "\n  uplift build " in result.stdout
    error = refuse("chart --recommend --time-ns 0.5 --from", table)
    assert error.code == "requirements-not-met"
    result = run("chart --recommend --tolerance 1 --light FL11 --atlas-materials")
    assert "--atlas FILE" in result.stdout
